# A number that is not known has a line that says why, whatever is recorded: chirps, sums of sines that never meet again,
# noise, silence, a ramp, few samples, one transition, slips, a force.
wave() { awk -v n="$1" "BEGIN { srand(3); print \"t_s,$2\"; for (i = 0; i < n; i++) { t = i / 1000; p = 6.283185307179586 * t
    printf \"%.3f,%.9g\\n\", t, $3 } }"; }
wave 8000 a 'sin(10 * p + 2 * sin(.7 * t) * sin(.31 * t) * t)' > wandering
wave 8000 a 'sin(10 * p + 3 * t * t)' > chirp
wave 8000 a 'sin(10 * p) + sin(14.142 * p) + sin(23.7 * p)' > sum
wave 8000 a 'rand() - .5' > noise
wave 3000 a 0 > silence
wave 3000 force t > ramp
wave 9 a 'sin(100 * p)' > short
wave 3000 a '(t > 1) * exp(-9 * (t - 1)) * cos(40 * (p - 6.283185307179586))' > one
wave 8000 force_N '3 * t - int(3 * t)' > saw
ss-sim coulomb > slips
ss-sim compliant-light | ss-noise --snr 20 --seed 1 > contact
abouts=$(sed -n 's/.*number(SS_[A-Z_]*, "\([a-z_]*\)", [^,]*, "\([a-z]*\)".*/\1 \2/p' "$SRC/include/stickslip/features.h")
[ "$(echo "$abouts" | wc -l)" -ge 20 ]
for of in wandering chirp sum noise silence ramp short one saw slips contact; do
    ss-features "$of" > "$of.txt" 2> err || { echo "$of: $(cat err)"; continue; }
    echo "$abouts" | while read -r key about; do
        ! grep -q "^# $key: - " "$of.txt" || grep -q "^# about_$about: ." "$of.txt" || echo "$of: no reason for $key"
    done
done
grep -h '^# about_repetition' wandering.txt chirp.txt sum.txt short.txt
# the first spike has its line, too: a jump half way between two samples
sed -n 's/^# spike: \([0-9.]*\) jump .*/\1/p' one.txt
