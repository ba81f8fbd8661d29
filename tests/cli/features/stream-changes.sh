# A stream searches for what rings in it already; it finds what comes then, too: rest, another ringing, and a louder one.
awk 'BEGIN {
    print "# stickslip signal 1\n# rate: 1000\n# columns: t/s a/(m/s^2)"
    split("0 80 100 130 160", from); split("100 0 170 100", hertz); split("1 0 .6 6", height)
    for (n = 0; n < 160000; n++) {
        k = n < 80000 ? 1 : n < 100000 ? 2 : n < 130000 ? 3 : 4
        if (n % 500 == 100) since = n
        t = (n - since) / 1000
        x = n < 100 ? 0 : height[k] * exp(-2 * 3.14159265 * hertz[k] * .03 * t) * cos(2 * 3.14159265 * hertz[k] * t)
        print n / 1000 "\t" x } }' | ss-noise --rms .003 --seed 8 > run.tsv
ss-features --stream --fmin 20 run.tsv > rows.tsv
awk '/^[0-9]/ { k = $1 < 80 ? 1 : $1 < 100 ? 2 : $1 < 130 ? 3 : 4; n[k]++; off = ($1 - .1) * 2; off -= int(off + .5)
        wrong += (off / 2) ^ 2 > 4e-6; near[k] += ($7 - (k == 3 ? 170 : 100)) ^ 2 < 1 }
    END { print (n[1] > 157 && n[1] < 163), (n[2] < 2), (n[3] > 57 && n[3] < 63), (n[4] > 57 && n[4] < 63),
        (near[1] > 154), (near[3] > 55), (near[4] > 55), (wrong < 6) }' rows.tsv
# The numbers of the first windows are those of all, not of the first alone: 100 Hz in one half, 103 Hz in the other.
awk 'BEGIN {
    print "# stickslip signal 1\n# rate: 1000\n# columns: t/s a/(m/s^2)"
    for (n = 0; n < 40000; n++) {
        if (n % 500 == 100) since = n
        w = 2 * 3.14159265 * (n < 20100 ? 100 : 103); t = (n - since) / 1000
        print n / 1000 "\t" (n < 100 ? 0 : exp(-.03 * w * t) * cos(w * t)) } }' | ss-noise --rms .003 --seed 8 |
    ss-features --stream --fmin 20 | awk '/^# transition_frequency:/ { print ($3 > 101 && $3 < 102), ($4 < 1) }'
