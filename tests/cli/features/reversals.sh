# Friction and stiffness of a force that goes to and fro: a slider on a spring that is moved to and fro, with
# a constant beside the force, has those of its scene, within three standard errors of at most 6 %.
slider() {      # STIFFNESS: 8 s of it
    ss-sim -s mass=1 -s stiffness=1e8 -s damping=2e4 -s friction=4000 -s contact_stiffness="$1" \
        -s contact_damping=0 -s base_amplitude=0.02 -s base_frequency=1 -s settle=0 -s duration=8 -s rate=1000 \
        -c t,x,f compliant-light | without_scene | awk 'BEGIN { OFS = "\t" } !/^#/ { $3 += 500 } { print }'
}
without_scene() { grep -E '^[^#]|^# (stickslip|rate|start|columns)'; }
covers() { awk -v key="$1:" -v truth="$2" '$2 == key { off = $3 - truth; if (off < 0) off = -off
    print key, ($3 != "-" && $4 != "-" && off <= 3 * $4 + 1e-5 * truth && $4 < 0.06 * truth ? "covered" : $3 " " $4) }'; }
none() { awk -v key="$1:" '$2 == key { print key, $3 }'; }
for contact in 5e5 1e6 3e6 1e7; do
    slider $contact > clean.tsv
    ss-features -c f clean.tsv > found
    covers friction 4000 < found
    covers loading_stiffness $contact < found
done
for seed in 1 2 3; do
    slider 1e6 | ss-noise --snr 40 --seed $seed | ss-features -c f > found
    covers friction 4000 < found
    covers loading_stiffness 1e6 < found
done
# against the paper's contact, by its force alone
ss-sim compliant-light | without_scene | ss-features -c f | covers loading_stiffness 209900
# a Coulomb slider does not move in the stick; without a displacement there is nothing to hold the force against
ss-sim coulomb | without_scene | ss-features -c f > found
covers friction 1.28 < found
none loading_stiffness < found
ss-sim -c t,f coulomb | ss-features -c f | grep -c '^# loading_stiffness' || true
# so has one whose levels grow, so that nothing but a jump leaves them
awk 'BEGIN { print "t,f (N)"; for (i = 0; i < 9999; i++) print i / 1000 "," (i % 200 < 90 ? 1 : -1) * (5 + i / 1e5) }' > jumps.csv
ss-features -c f jumps.csv | covers friction 5.05
# forces of a damper and of a spring have reversals but neither slips nor friction
for law in 'cos(w * t)' 'sin(w * t)' 'sin(w * t) + cos(w * t)'; do
    awk "BEGIN { w = 8 * atan2(1, 1); print \"t,x (m),f (N)\"; for (i = 0; i < 8000; i++) { t = i / 1000
        print t \",\" .02 * sin(w * t) \",\" $law } }" > law.csv
    ss-features -c f law.csv > found
    none slips < found
    none friction < found
    none loading_stiffness < found
done
# coarse converters and friction that changes along the way: the errors have them, or there is no number
honest() { awk -v key="$1:" -v truth="$2" '$2 == key { off = $3 - truth; if (off < 0) off = -off
    print key, ($3 == "-" || ($4 > 0 && off <= 3 * $4) ? "honest" : $3 " " $4) }'; }
for change in '$2 = 3e-3 * int($2 / 3e-3 + 99.5) - .297' '$3 = 300 * int($3 / 300 + 99.5) - 29700'; do
    slider 1e6 | awk 'BEGIN { OFS = "\t" } !/^#/ { '"$change"' } { print }' | ss-features -c f > found
    honest friction 4000 < found
    honest loading_stiffness 1e6 < found
done
for phase in 0 2 4; do
    awk -v phase=$phase 'BEGIN { print "t,x (mm),f (N)"; for (i = 0; i < 8000; i++) { u = i % 1000 / 1000
        x = u < .5 ? 4 * u - 1 : 3 - 4 * u; f += 200 * (i > 0 ? x - was : 0); was = x
        limit = 5 * (1 + .12 * cos(32 * atan2(1, 1) * u + phase)); f = f > limit ? limit : f < -limit ? -limit : f
        print i / 1000 "," x "," f } }' | ss-features -q -c f - | honest loading_stiffness 200
done
# a hum is there before the reversals, too: nothing rings behind them
for f in 50 71.3; do
    slider 1e6 | awk -v f=$f 'BEGIN { OFS = "\t" } !/^#/ { $3 += 400 * sin(6.283185307179586 * f * $1) } { print }' |
        ss-features -c f | none transition_frequency
done
# a torque is read as a force; its slips are the sides that it goes to
slider 1e6 | sed '/^# col/s,f/N,torque/(N m),' > torque.tsv
ss-features -c torque torque.tsv > found
covers friction 4000 < found
awk '!/^#/ { side = $3 > 2500 ? 1 : $3 < -1500 ? -1 : side; n += side != last; last = side } END { print n }' torque.tsv > sides
sed -n 's/^# slips: \([0-9]*\).*/\1/p' found | cmp - sides
# a gap: what it reaches is left out
slider 1e6 | awk 'BEGIN { print "t,x (m),f (N)"; OFS = "," } !/^#/ { if ($1 > 3.2 && $1 < 3.6) $3 = ""
    print $1, $2, $3 }' > gap.csv
ss-features -q --gaps split -c f gap.csv > found
covers friction 4000 < found
covers loading_stiffness 1e6 < found
# one table of files has them, too
ss-features -c f --summary clean.tsv | awk -F '\t' '/^# columns/ { sub("# columns: ", ""); n = split($0, name, "\t") }
    !/^#/ { for (i = 1; i <= n; i++) if (name[i] == "friction" || name[i] == "drop") print name[i], $i }'
# of a displacement that is named another tool knows more
ss-features -c f --displacement x clean.tsv 2>&1 | grep '^ss-features'
