# SoX reads the WAV that we write, from a file and from a pipe: rate, channels, length and, within 2^-31, the samples.
command -v sox > /dev/null || { echo "no sox"; exit 77; }
ss-signal sine --frequency 441 --rate 44100 --duration 1 --amplitude 0.5 -o sine.tsv
ss-cat sine.tsv -o sine.wav
for what in r c s e b; do sox --i -$what sine.wav; done
awk '!/^#/ { print $2 }' sine.tsv > one
for source in 'cat sine.wav' 'ss-cat sine.tsv --format wav'; do
    $source | sox -t wav - -t f64 -L - 2> /dev/null | od -An -v -t f8 -w8 > two
    paste one two | awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > e) e = d } END { print NR, NF, e <= 2 ^ -31 }'
done
