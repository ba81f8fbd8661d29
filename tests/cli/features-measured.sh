# What is known of the measured recordings (their README), from the defaults.
data=$SRC/../shared/data/measured
[ -d "$data" ] || { echo "no measured recordings"; exit 77; }
ss-features --column friction_force_kip "$data/band_friction_damper_1hz_20lb.csv" > damper
awk '!/^#/ && $7 >= 45 && $7 <= 55 { n++ } END { print (n >= 10 ? "rings" : "does not ring: " n) }' damper
grep -v '^#' damper | cut -f 7 | grep -v -- - | sort -g |
    awk '{ f[NR] = $1 } END { m = f[int((NR + 1) / 2)]; print (m >= 47 && m <= 53 ? "near 50 Hz" : m) }'
ss-features --column slip_velocity_mm_s "$data/rock_labquake_fb03-087_event043.csv" | grep -E '^# (transitions|slips):'
for drop in 0.012 0.02 0.03; do
    ss-features --column F_norm --drop $drop "$data/paper_friction_k168_v42.csv" | grep '^# slips:'
done
