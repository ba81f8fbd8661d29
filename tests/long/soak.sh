# 10^9 samples of 1 MHz, a burst every 10 ms, as AU through a pipe of all tools that work on endless signals: in constant
# memory, with a row for every burst, at its time to the sample, and fewer than one in a thousand more.
[ "$(uname)" = Linux ] || { echo "other systems count memory in other units"; exit 77; }
[ -z "$SAN" ] || { echo "sanitizers need memory of their own"; exit 77; }
$CCLD -o high_water "$SRC/tests/stop/high_water.c"
millions=${MILLIONS:-1000}
ss-signal ringdown --rate 1e6 --duration .01 --frequency 1e5 --damping .02 --at .002 --format au \
    | tail -c 80000 > burst
for i in 0 1 2 3 4 5 6 7 8 9; do cat burst burst burst burst burst burst burst burst burst burst; done > million
signal() {      # AU of unknown length, in numbers of 64 bits
    printf '.snd\0\0\0\034\377\377\377\377\0\0\0\007\0\017\102\100\0\0\0\001\0\0\0\0'
    i=0
    while [ $((i += 1)) -le "$millions" ]; do cat million; done; }
mkfifo in
./high_water ss-morlet --stream --dyadic --fmin 5e4 --format au < in 2> morlet.kib | wc -c > bytes &
signal | ./high_water ss-cat --format au 2> cat.kib | ./high_water ss-filter --high-pass 1e3 --format au 2> filter.kib \
    | tee in | ./high_water ss-features --stream --fmin 5e4 2> features.kib > rows.tsv
wait
for tool in cat filter morlet features; do
    [ "$(cat $tool.kib)" -lt 100000 ] || echo "ss-$tool: $(cat $tool.kib) KiB"
done
awk -v all=$((millions * 100)) '/^[0-9]/ { n++; off = $1 / .01 - int($1 / .01 + .5)
        if (n == 1) first = off; else if ((off - first) ^ 2 > 4e-8 || $1 - before > .0101) wrong++
        before = $1; same += ($7 - 1e5) ^ 2 < 1 }
    /^# transition_frequency:/ { print ($3 - 1e5) ^ 2 < 1 }
    END { print (n > all - 5), (wrong < all / 1000), (same > all - 5) }' rows.tsv
awk -v all=$((millions * 1000000)) '{ print ($1 > 8 * 2 * all) }' bytes
