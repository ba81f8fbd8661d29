# Fits that once ended in another hollow: K_y 3.4 % and c 52 % off with errors of .04 and .35 %.
cat > deep.scene <<'EOF'
model = compliant
mass = 1.2740777738628528
stiffness = 387.34649519432122
friction = 0.89179050796253667
base_amplitude = 0.0030833516737146975
base_frequency = 1.6827507243133653
settle = 3.6876092621347283
duration = 11.291036589957683
rate = 1346.2005794506922
contact_stiffness = 147300.9437701547
contact_damping = 25.121354335744474
EOF
rig='-s mass=1.2740777738628528 -s stiffness=387.34649519432122'
# shellcheck disable=SC2086  # several words
ss-sim deep.scene | ss-rank --fit $rig > fitted
awk '$1 == "contact_stiffness" { print ($3 / 147300.9437701547 - 1)^2 < 1e-12 }
     $1 == "contact_damping" { print ($3 / 25.121354335744474 - 1)^2 < 1e-12 }' fitted
# sticks of an eighth of a period of the contact give no stiffness, settled or not, and that is said in time
rig='-s mass=1.8 -s stiffness=900'
for settle in 2 20; do
    # shellcheck disable=SC2086
    ss-sim $rig -s friction=0.4 -s contact_stiffness=80000 -s contact_damping=15 -s base_frequency=3 \
        -s base_amplitude=0.001 -s settle=$settle compliant-light | ss-noise --snr 30 --seed 2 > short.tsv
    # shellcheck disable=SC2086
    ss-rank --fit $rig short.tsv || echo $?
done
# 6 % less friction: sticks of half a period beside longer ones, and still the right contact or none
for scene in compliant-light compliant-heavy; do
    ss-sim -s friction=1.1 $scene | ss-noise --snr 40 | ss-rank --fit - $scene > fitted 2> err || true
    awk '/contact_stiffness +[0-9.e-]+ %/ { error = $3 } $1 == "contact_stiffness" { off = 100 * ($3 / 209900 - 1) }
         END { print error == "" || off^2 < 9 * error^2 }' fitted
done
# a sensor of 300 Hz shows a contact of 47 Hz with other numbers, or none
ss-sim -s rate=16000 -c t,a compliant-light | awk -v OFS='\t' '
    /^# rate/ { print "# rate: 2000"; next }
    /^#/ { print; next }
    n++ % 8 == 0 { print $1, y + 0 }
    { y += ($2 - y) * (1 - exp(-2 * 3.14159265 * 300 / 16000)) }' | ss-noise --snr 40 | ss-rank --fit || echo $?
# a fit finds friction where the scene that it starts from has none
ss-sim -c t,a -s settle=4 -s duration=4 compliant-light > start.tsv
for friction in 0 1e-9; do
    ss-rank --fit -c a -s friction=$friction start.tsv compliant-light > from.$friction
done
cmp from.0 from.1e-9
