# What is known of the measured recordings (their README), from the defaults; and of parts of them.
data=$SRC/../shared/data/measured
[ -d "$data" ] || { echo "no measured recordings"; exit 77; }
# within KEY LOW HIGH of the summary in standard input: "KEY ok", or what is there instead
within() { awk -v key="$1:" -v low="$2" -v high="$3" '$2 == key { print key, ($3 != "-" && $3 >= low && $3 <= high ? "ok" : $3) }'; }
none() { awk -v key="$1:" '$2 == key { print key, $3 }'; }
damper=$data/band_friction_damper_1hz_20lb.csv
ss-features --column friction_force_kip "$damper" > found
for row in 'slips 13 16' 'slip_rate 1.3 2.1' 'repetition_frequency 0.976 1.04' 'transition_frequency 45.5 56'; do
    # shellcheck disable=SC2086  # key, low and high
    within $row < found
done
# Cuts, an offset and a slope bring no other ringing.
for cut in '2 7' '1 6' '2 6'; do
    # shellcheck disable=SC2086  # from and to
    set -- $cut
    ss-cat --from "$1" --to "$2" --column friction_force_kip "$damper" |
        awk 'BEGIN { OFS = "\t" } !/^#/ { $2 += 1 - 0.1 * $1 } { print }' | ss-features > found
    within transition_frequency 45.5 56 < found
done
# Weak lines near 103, 168 and 212 Hz stand beside the ringing.
ss-features --column friction_force_kip "$data/band_friction_damper_1hz_80lb.csv" | within transition_frequency 49 62.5
ss-features --column friction_force_kip "$data/band_friction_damper_0p5hz_36lb_1in.csv" | within damping_ratio 0 0.04
ss-features --column displacement_in "$damper" | within repetition_frequency 0.995 1.014
# Fast slip from 91.296 s to before 91.34 s, seen by eye; the filter at 500 Hz makes 2 ms of an onset.
rock=$data/rock_labquake_fb03-087_event043.csv
ss-features --column slip_velocity_mm_s "$rock" > found
grep -E '^# (transitions|slips):' found
awk '!/^#/ && ($1 < 91.294 || $1 > 91.298 || $2 < 91.31 || $2 > 91.34)' found
# Clipped, it has a sharp begin and end: not two events.
ss-cat --column slip_velocity_mm_s "$rock" | awk '!/^#/ && $2 > 5 { $2 = 5 } { print }' OFS='\t' | ss-features > found
none slips < found
# Its first half is the noise of that filter.
ss-cat --column slip_velocity_mm_s --to 91.28 "$rock" | ss-features > found
for key in slip_rate repetition_frequency transition_frequency damping_ratio; do none $key < found; done
# Falls of a force, counted without a height: a cycle a slip; k V / (m g) is 2.40 /s.
ss-features --column F_norm "$data/paper_friction_k168_v4300.csv" > found
for row in 'slips 50 58' 'slip_rate 13.4 15.3' 'repetition_frequency 13.6 15.5' 'loading_slope 1.92 2.88'; do
    # shellcheck disable=SC2086
    within $row < found
done
none transition_frequency < found
for drop in 0.012 0.02 0.03; do
    ss-features --column F_norm --drop $drop "$data/paper_friction_k168_v42.csv" | grep '^# slips:'
done
ss-features --column F_norm "$data/paper_friction_k168_v42.csv" > found
within slips 28 38 < found
within loading_slope 0.0187 0.0281 < found
# Slips at the level of the noise are not counted.
ss-features --column F_norm "$data/paper_friction_k2254_v42.csv" > found
for key in slips slip_rate repetition_frequency transition_frequency; do none $key < found; done
