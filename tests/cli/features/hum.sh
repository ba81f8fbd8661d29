# A steady hum near the contact's frequency is subtracted if it is no harmonic of what repeats; if it
# nearly is one, the ringing is -.
covers() { awk -v key="$1:" -v truth="$2" '$2 == key { off = $3 - truth; if (off < 0) off = -off
    print key, ($3 != "-" && off <= 3 * $4 && $4 < 0.01 * truth ? "covered" : $3 " " $4) }'; }
hum() { awk -v f="$1" -v a="$2" 'BEGIN { OFS = "\t" } !/^#/ { $4 += a * sin(6.283185307179586 * f * $1) } { print }'; }
# 20 and 30 dB below the signal, from 7 % below to 9 % above the oscillation
for f in 43.7 46.2 51.2; do
    for amplitude in .025 .008; do
        ss-sim -s settle=10 -s duration=4 compliant-light | ss-noise --snr 40 | hum $f $amplitude |
            ss-features --mass 2.42 > found
        covers total_stiffness 212210 < found
        grep '^# about_ringing' found
    done
done
ss-sim -s settle=10 -s duration=4 compliant-light | ss-noise --snr 40 | hum 45.07 .025 | ss-features --mass 2.42 > found
awk '$2 == "total_stiffness:" || $2 == "damping_ratio:" { print $2, $3 } $2 == "about_ringing:"' found
# a true stick does not ring: what hums in it neither decays nor starts anew with the slips
ss-sim coulomb | ss-noise --snr 50 --seed 3 | hum 55 .3 | ss-features |
    awk '$2 == "transition_frequency:" { print $2, $3 } $2 == "about_ringing:"'
