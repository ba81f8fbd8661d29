# A square wave of 2399 jumps that set off ringing of 125.4 Hz beside a steady hum of 110.6 Hz: the band is
# looked for behind some of the jumps, and the hum in some parts of the record at first.
covers() { awk -v key="$1:" -v truth="$2" '$2 == key { off = $3 - truth; if (off < 0) off = -off
    print key, ($3 != "-" && off <= 3 * $4 && $4 < 0.001 * truth ? "covered" : $3 " " $4) }' found; }
awk 'BEGIN { OFMT = "%.9g"; pi = 3.141592653589793; w = 2 * pi * 125.4; print "t,a"
    for (i = 0; i < 288000; i++) {
        t = i / 1000; k = int(i / 120); u = (i - 120 * k + .4) / 1000
        a = (k % 2 ? 1 : -1) * (1 - .3 * exp(-.04 * w * u) * cos(w * u)) + .005 * sin(2 * pi * 110.6 * t)
        print t "," a
    } }' | ss-cat | ss-noise --snr 54 | ss-features > found
covers transition_frequency 125.4
covers damping_ratio 0.03996804
covers repetition_frequency 4.1666666667
grep -e '^# about_ringing' -e '^# transitions' found
