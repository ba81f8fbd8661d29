# A pull of a slider, of which mass and speed are not well known: its scene is found by its spring's force.
cat > pull.scene <<'EOF'
model = coulomb
mass = 0.0307
stiffness = 168
static_friction = 0.0602
friction = 0.0452
base_velocity = 42e-6
settle = 3
duration = 60
EOF
ss-sim -c t,s pull.scene | ss-noise --snr 40 > pull.tsv
# within 3 of the errors that stand in its comments
near() {
    awk -v key="$1" -v truth="$2" '$1 == "#" && $2 == key { off = ($3 - truth) / $5; print key, off^2 < 9 }'
}
ss-rank --fit -s mass=0.04 -s base_velocity=5e-5 -s friction=0 -s static_friction=0 pull.tsv pull.scene > fitted 2> err
near static_friction 0.0602 < fitted
near friction 0.0452 < fitted
near k/m 5472.3127 < fitted
near loading 0.007056 < fitted
near drop 0.03 < fitted
sed 's/is [0-9.]* times/is ... times/' err
# friction that falls with speed puts k/m off, as ss-rank(1) says; what the slips leave shows it
ss-sim -c t,s -s model=stribeck -s stribeck_velocity=3e-3 pull.scene | ss-noise --snr 40 > falling.tsv
ss-rank --fit falling.tsv pull.scene 2> err | awk '$1 == "#" && $2 == "k/m" { print "given:", $10, $11 }'
sed 's/leave [0-9.]* times/leave ... times/' err
# it slips when the record does
ss-sim -e pull.scene | awk '$2 == "slip" { print $1; exit }' > truth
ss-sim -e fitted | awk '$2 == "slip" { print $1; exit }' | paste truth - | awk '{ print ($1 - $2)^2 < 1e-6 }'
# only the force of the spring, only Coulomb friction, no noise
ss-rank --fit -a f pull.tsv pull.scene || echo $?
ss-rank --fit pull.tsv pull.scene -s model=stribeck -s stribeck_velocity=1 || echo $?
ss-rank --fit -s damping=1 pull.tsv pull.scene || echo $?
ss-rank pull.tsv pull.scene coulomb || echo $?
ss-rank pull.tsv coulomb pull.scene || echo $?
ss-noise --rms 1 pull.tsv | ss-rank --fit - pull.scene || echo $?
awk '!/^#/ { $2 = -$2 } { print }' OFS='\t' pull.tsv | ss-rank --fit - pull.scene || echo $?
# ranked among themselves: the own scene, some per cent off, before other rigs
other() {
    sed "s/^$1 = .*/$1 = $2/" pull.scene
}
other mass 0.034 > own.scene; other stiffness 1002 > stiff.scene; other base_velocity 1100e-6 > fast.scene
answer() {
    ss-rank "$@" | sed -n '/^# answer/s/[0-9][0-9.]* \(times\|%\)/N \1/gp'
}
answer pull.tsv stiff.scene own.scene fast.scene
answer pull.tsv stiff.scene fast.scene
answer falling.tsv own.scene
answer pull.tsv own.scene own.scene
ss-rank pull.tsv stiff.scene own.scene | tail -n 2 | cut -f 1,2
ss-rank -v pull.tsv own.scene 2>&1 > /dev/null | grep -c 'own.scene: total .* leaves .* power, [01][.0-9]* times the noise$'
