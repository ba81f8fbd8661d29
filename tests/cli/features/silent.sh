# Cases that once gave a wrong number: it is - now, or right within three of its standard errors.
none() { awk -v key="$1:" '$2 == key { print key, $3 }'; }
covers() { awk -v key="$1:" -v truth="$2" '$2 == key { off = $3 - truth; if (off < 0) off = -off
    print key, ($3 != "-" && off <= 3 * $4 && $4 < 0.1 * truth ? "covered" : $3 " " $4) }'; }
rig='--mass 2.42 --stiffness 2310'
# sticks of .4 to .9 periods, separated by micro-slips; the last in noise that hides these
for scene in '-s friction=1.1 compliant-light' '-s friction=1.1 compliant-heavy'; do
    # shellcheck disable=SC2086  # words of an option
    ss-sim $scene | ss-features $rig > found
    for key in transition_frequency contact_stiffness damping_ratio contact_damping; do none $key < found; done
    grep '^# about_ringing' found
    covers slip_rate 5 < found
done
for seed in 1 2 3; do
    # shellcheck disable=SC2086
    ss-sim -s friction=1.2 -s settle=10 -s duration=6 compliant-light | ss-noise --snr 20 --seed $seed |
        ss-features $rig > found
    none contact_stiffness < found
    none damping_ratio < found
done
# micro-slips once a period of the contact, seen in noise by the steps in its decay alone
ss-sim -s mass=35.2046 -s stiffness=1107.58 -s contact_stiffness=3.83901e+06 -s contact_damping=105.777 \
    -s base_frequency=0.557594 -s base_amplitude=0.000465925 -s friction=0.433949 -s rate=1682.06 \
    -s duration=16.1408 -s settle=53.8026 compliant-light | ss-noise --snr 20 |
    ss-features --mass 35.2046 > found
none total_stiffness < found
none damping_ratio < found
grep '^# about_ringing:' found
# one stick of 16 periods behind a train of short ones: right by that stick
ss-sim -s mass=0.0404804 -s stiffness=2430.98 -s friction=0.10326 -s base_amplitude=6.61617e-05 \
    -s base_frequency=6.00594 -s contact_stiffness=174128 -s contact_damping=0.809964 -s settle=0.868401 \
    -s duration=1.66502 -s rate=3832.29 compliant-light | ss-features --mass 0.0404804 > found
covers total_stiffness 176558.98 < found
covers damping_ratio 0.00479036 < found
# a period of many oscillations, which ring on from cycle to cycle
ss-sim -s mass=0.0183769 -s stiffness=436.161 -s contact_stiffness=1.10340e+07 -s contact_damping=6.98938 \
    -s friction=0.0116451 -s base_amplitude=2.75508e-05 -s base_frequency=13.00775 -s settle=2.30632 \
    -s duration=0.691895 -s rate=62399 compliant-light | ss-features --mass 0.0183769 > found
covers repetition_frequency 13.00775 < found
covers total_stiffness 11034436.16 < found
# nothing hums in a simulated signal, however little it has between its harmonics
ss-sim -s mass=155.296578 -s stiffness=20186805 -s contact_stiffness=2.4542848e+09 -s contact_damping=13182.508 \
    -s friction=122.18115 -s base_amplitude=1.3615457e-05 -s base_frequency=12.29883 -s settle=2.43925636 \
    -s duration=0.73177691 -s rate=20329.673 compliant-light | ss-features --mass 155.296578 > found
covers total_stiffness 2474471605 < found
# a train of micro-slips before a stick, in noise of a displacement: right by the stick
ss-sim -s mass=103.576 -s stiffness=12013.1 -s contact_stiffness=2.97592e+06 -s contact_damping=227.569 \
    -s friction=0.405635 -s base_amplitude=6.21477e-05 -s base_frequency=0.433794 -s settle=69.1572 \
    -s duration=20.7472 -s rate=865.017 compliant-light | ss-noise --snr 80 --seed 65 > noisy
ss-features --column x --mass 103.576 noisy > found
covers damping_ratio 0.00646812 < found
# the rig's own mass and spring, which ring while it slips
ss-sim -m exact -s mass=0.922770650151 -s stiffness=184384.238385 -s friction=0.732958942546 -s damping=36.4123861351 \
    -s base_amplitude=1.40632942711e-05 -s base_frequency=1.13580545156 -s phase=5.76807674471 \
    -s contact_stiffness=1207545.42582 -s contact_damping=14.5892465523 -s settle=0 -s duration=4.72024993039 \
    -s rate=8474.12755466 compliant-light | ss-features --mass 0.922771 --stiffness 184384 > found
none transition_frequency < found
none contact_stiffness < found
none contact_damping < found
# what repeats, with the drift of a start that has not settled, and exactly
ss-sim compliant-light | ss-features | covers repetition_frequency 2.5
ss-signal sine | ss-features | covers repetition_frequency 10
ss-signal sine --frequency 9.7 | ss-features | covers repetition_frequency 9.7
# what rings once, is modulated, or is noise whose power repeats, does not repeat itself
ss-signal ringdown | ss-features | none repetition_frequency
for wave in '(1 + .8 * cos(18.8496 * t)) * cos(316 * t)' '(1 + cos(18.8496 * t)) * (rand() + rand() - 1)'; do
    awk "BEGIN { srand(1); print \"t,a\"; for (i = 0; i < 16000; i++) { t = i / 1000; print t \",\" $wave } }" |
        ss-features > found
    none repetition_frequency < found
    none slip_rate < found
    none transition_frequency < found
done
# noise beside the jumps of a sawtooth does not ring
for seed in 1 3 4; do
    awk -v seed=$seed 'BEGIN { srand(seed); print "t,a"; for (i = 0; i < 20000; i++) { t = i / 1000
        printf "%.17g,%.17g\n", t, 2 * (t + t * t / 800) % 1 - .5 + .02 * (rand() - .5) } }' | ss-features > found
    none transition_frequency < found
done
# a hum repeats sooner than the cycles that it hums in, and a begin and an end of each stick are no two slips
ss-sim -s mass=0.0550638246 -s stiffness=0.496744497 -s contact_stiffness=794.950988 \
    -s contact_damping=0.0271379499 -s friction=6.64303949e-06 -s base_amplitude=2.12359434e-05 \
    -s base_frequency=0.128661453 -s settle=233.17007 -s duration=69.9510211 -s rate=153.032177 compliant-light |
    awk '/^#/ { next } { x[n++] = $4; s += $4 * $4 } END { print "t,a"; for (i = 0; i < n; i++)
        printf "%.17g,%.17g\n", i / 153.032177, x[i] + .1 * sqrt(2 * s / n) * sin(122.845 * i / 153.032177) }' |
    ss-features | none repetition_frequency
ss-sim -s mass=101.60294 -s stiffness=174571.499 -s contact_stiffness=5779049.89 -s contact_damping=8526.60509 \
    -s friction=13.1001425 -s base_amplitude=9.9181572e-05 -s base_frequency=1.65960559 -s settle=18.0765841 \
    -s duration=5.42297524 -s rate=616.421225 compliant-light | ss-features > found
covers slip_rate 3.31921118 < found
grep '^# slips:' found
# jumps between samples: twelve cycles repeat better than one, but are not the shortest time after which it does
awk 'BEGIN { print "t,a"; for (i = 0; i < 12000; i++) { u = i * .01103947; print i / 1000 "," u - int(u) } }' |
    ss-features | covers repetition_frequency 11.03947
# a rate that a strong hum pulls towards itself, over one cycle and over two by other amounts
awk 'BEGIN { print "t,a"; for (i = 0; i < 17463; i++) { t = i / 5000; x = sin(222.761 * t)
    print t "," (x > 0 ? x : 0) + .28 * sin(4600.85 * t) } }' | ss-features > found
awk '$2 == "repetition_frequency:" { print ($3 == "-" || ($3 - 35.4534) ^ 2 <= 9 * $4 ^ 2 ? "covered" : $0) }' found
# a motion that is not mirrored: as many slips as begin from rest, 1 of 3 reversals a cycle in noise
awk 'BEGIN { print "t\tz"; w = 15.70796327; for (i = 0; i <= 12000; i++) { t = i / 1000
    printf "%.9f\t%.12g\n", t, .0008 * (sin(w * t) + .6 * sin(2 * w * t + 1)) } }' > uneven.tsv
ss-sim --events -b uneven.tsv:z -s settle=4 -s duration=6 coulomb | awk '$2 == "slip"' | wc -l > begun
ss-sim -b uneven.tsv:z -s settle=4 -s duration=6 coulomb | ss-noise --snr 60 | ss-features -c a > found
covers slip_rate 2.5 < found
awk -v n="$(cat begun)" '$2 == "slips:" { print "slips:", ($3 >= n - 1 && $3 <= n + 1 ? "as many" : $3 " of " n) }' found
# a force under a name that says nothing, which stays at two levels: it leaves each of them once a cycle
ss-sim coulomb | ss-noise --snr 60 --seed 3 |
    awk '/^#/ { next } !n++ { print "t,Kraft" } { print $1 "," $5 }' | ss-features | covers slip_rate 5
# no error is 0, however little noise there is
ss-sim -m exact compliant-light | ss-features | awk '!/^#/ && !($8 > 0 && $10 > 0)'
# 12 motions between rests of uneven length, and glitches in three rests
awk 'BEGIN { print "t,v [m/s]"; for (k = 0; k < 12; k++) from[k] = 1 + k + .2 * sin(3 * k); k = 0
    for (i = 0; i < 14000; i++) { t = i / 1000; if (k < 11 && t > from[k] + .4) k++
        x = t >= from[k] && t < from[k] + .3 ? 1 - cos(20.94395102 * (t - from[k])) : 0
        print t "," x + (i % 4001 == 700 ? 3 : 0) + 1e-4 * sin(i * i) } }' | ss-features | grep '^# slips:'
# two sticks in each half of a cycle, of which a low-pass or a hum leaves one: half of the slips; a hum decays not
slider='-s mass=.526514301 -s stiffness=2205.70533 -s friction=.120784707 -s base_amplitude=.00010915256
    -s base_frequency=1.1732508 -s settle=34 -s duration=8 -s rate=2633'
# shellcheck disable=SC2086
ss-sim $slider coulomb | awk '/^#/ { next } { x[n++] = $4 } END { print "t,a"; for (i = 0; i < n; i++) {
    y += .25 * (x[i] - y); z += .25 * (y - z); printf "%.17g,%.6g\n", i / 2633, z } }' | ss-features | none slips
hum() { awk -v by="$1" -v f="$2" -v rate="$3" '/^#/ { next } { x[n++] = $4; s += $4 * $4 }
    END { print "t,a"; for (i = 0; i < n; i++)
        printf "%.17g,%.9g\n", i / rate, x[i] + by * sqrt(2 * s / n) * sin(6.28318530718 * f * i / rate) }'; }
ss-sim -s mass=3.05502173 -s stiffness=36.0695481 -s damping=.0627733794 -s friction=.0058492632 \
    -s base_amplitude=.000337120418 -s base_frequency=.0635527247 -s settle=630 -s duration=158 -s rate=240 coulomb |
    hum .1 50 240 | ss-features > found
none slips < found
none slip_rate < found
ss-sim -s mass=.180759816 -s stiffness=5.95226974 -s friction=.000405116891 -s base_amplitude=9.02294357e-05 \
    -s base_frequency=.139321594 -s settle=287 -s duration=153 -s rate=309.448 coulomb |
    hum .316 60 309.448 | ss-features | none transition_frequency
# a soft contact, whose spectrum falls as a filter's does: it rings until slips begin
ss-sim -m exact -s mass=.0111292031 -s stiffness=25.2913284 -s damping=.0308119451 -s friction=.000515777248 \
    -s static_friction=.000634744162 -s contact_stiffness=91.899806 -s contact_damping=.00952717075 \
    -s base_amplitude=3.6019947e-05 -s base_frequency=1.88042809 -s settle=21.271752 -s duration=9.8 \
    -s rate=243.593217 compliant-light | ss-features > found
covers transition_frequency "$(awk 'BEGIN { s = (.0308119451 + .00952717075) / .0111292031 / 2
    printf "%.12g", sqrt((25.2913284 + 91.899806) / .0111292031 - s * s) / 6.283185307179586 }')" < found
# a contact not much stiffer than the rig, whose swells are those of the rig while it slips
ss-sim -m exact -s mass=.0786843356 -s stiffness=3.22513284 -s friction=.000315501227 -s static_friction=.000335430235 \
    -s contact_stiffness=16.297428 -s contact_damping=.0126690803 -s base_amplitude=.000275565047 \
    -s base_frequency=.116037665 -s settle=345 -s duration=150 -s rate=80.65 compliant-light |
    ss-features --mass .0786843356 > found
covers total_stiffness 19.52256084 < found
# a hum as strong as the motion keeps all lags at multiples of its own period, and what is slow tells
ss-sim -s duration=8 --columns t,x,a,v coulomb | hum 1 33.33 2000 | ss-features | none repetition_frequency
