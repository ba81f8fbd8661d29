command -v sox > /dev/null || { echo "no sox"; exit 77; }
ss-signal sine --frequency 441 --rate 44100 --duration 1 --amplitude 0.5 --format au > sine.au
sox -t au sine.au -n stat 2>&1 | awk '/Samples read|Maximum amplitude/ { print $NF }'
sox -t au sine.au -t wav -e floating-point -b 64 sine.wav
sox sine.wav -t au - 2> /dev/null | ss-cat > back.tsv
grep '^# rate' back.tsv
ss-cat sine.au | grep -v '^#' > one
grep -v '^#' back.tsv > two
paste one two | awk '{ d = $2 - $4; if (d * d > e) e = d * d } END { print (e < 1e-18) }'
for bits in 8 16 24 32; do              # dither off; one step of the coarsest is 2^-7
    sox -D sine.wav -t au -e signed-integer -b "$bits" - 2> /dev/null | ss-cat | grep -v '^#' > two
    paste one two | awk -v b="$bits" '{ d = $2 - $4; if (d * d > e) e = d * d } END { print (e <= 4 ^ (1 - b)) }'
done
sox -t au sine.au -t au -r 22050 - 2> /dev/null | ss-cat | grep '^# rate'     # our annotation is out of date
