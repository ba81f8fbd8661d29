# What is known of the measured recordings (their README), from the defaults.
data=$SRC/../shared/data/measured
[ -d "$data" ] || { echo "no measured recordings"; exit 77; }
ss-features --column friction_force_kip "$data/band_friction_damper_1hz_20lb.csv" > damper
awk '!/^#/ && $7 >= 45 && $7 <= 55 { n++ } END { print (n >= 10 ? "rings" : "does not ring: " n) }' damper
grep -v '^#' damper | cut -f 7 | grep -v -- - | sort -g |
    awk '{ f[NR] = $1 } END { m = f[int((NR + 1) / 2)]; print (m >= 47 && m <= 53 ? "near 50 Hz" : m) }'
# Cuts, an offset and a slope make no difference: most transitions ring near 50 Hz.
for cut in '2 7' '2 5' '1 6' '3 7' '2 6'; do
    # shellcheck disable=SC2086  # from and to
    set -- $cut
    ss-cat --from "$1" --to "$2" --column friction_force_kip "$data/band_friction_damper_1hz_20lb.csv" |
        awk 'BEGIN { OFS = "\t" } !/^#/ { $2 += 1 - 0.1 * $1 } { print }' | ss-features > damper
    awk -v cut="$cut" '!/^#/ { n++; near += $7 >= 45 && $7 <= 55 }
        $2 == "transition_frequency:" && ($3 < 47 || $3 > 53) { print cut ": " $0 }
        END { if (near < 0.7 * n) print cut ": " near " of " n " transitions near 50 Hz" }' damper
done
# Fast slip from 91.296 s to before 91.34 s, seen by eye; the filter at 500 Hz makes 2 ms of an onset.
ss-features --column slip_velocity_mm_s "$data/rock_labquake_fb03-087_event043.csv" > rock
grep -E '^# (transitions|slips|spikes):' rock
awk '!/^#/ && ($1 < 91.294 || $1 > 91.298 || $2 < 91.31 || $2 > 91.34)' rock
# Drops of 14 a second; half of them are found without their height, which is no rate.
ss-features --column F_norm "$data/paper_friction_k168_v4300.csv" | grep '^# slip_rate'
ss-features --column F_norm --drop 0.01 "$data/paper_friction_k168_v4300.csv" |
    awk '$2 == "slip_rate:" { print ($3 > 13.5 && $3 < 15 ? "14 a second" : $0) }'
for drop in 0.012 0.02 0.03; do
    ss-features --column F_norm --drop $drop "$data/paper_friction_k168_v42.csv" | grep '^# slips:'
done
