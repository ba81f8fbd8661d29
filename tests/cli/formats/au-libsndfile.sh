# libsndfile reads what we write and writes what we read, lossless in 64 bits and within a step in PCM.
command -v sndfile-convert > /dev/null || { echo "no sndfile-convert"; exit 77; }
ss-signal sine --frequency 441 --rate 44100 --duration 1 --amplitude 0.5 --format au > sine.au
ss-cat sine.au | awk '!/^#/ { print $2 }' > one
sndfile-info sine.au | grep -E '^(Frames|Channels|Sample Rate)'
for form in float64 float32 pcm24 pcm16; do
    sndfile-convert -$form sine.au $form.au > log 2>&1 || cat log
    ss-cat $form.au | awk '!/^#/ { print $2 }' > two
    paste one two | awk -v form=$form '{ d = $1 - $2; if (d < 0) d = -d; if (d > e) e = d }
        END { step = form == "float64" ? 0 : form == "pcm16" ? 2 ^ -15 : 2 ^ -23
              print form, NR, e <= step }'
done
