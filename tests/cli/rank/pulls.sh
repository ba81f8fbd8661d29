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
# friction that falls with speed puts k/m off, as stickslip-rank(7) says; what the slips leave shows it
ss-sim -c t,s -s model=stribeck -s stribeck_velocity=3e-3 pull.scene | ss-noise --snr 40 > falling.tsv
ss-rank --fit falling.tsv pull.scene 2> err | awk '$1 == "#" && $2 == "k/m" { print "given:", $10, $11 }'
sed 's/leave [0-9.]* times/leave ... times/' err
# that law explains them; its numbers are found from others
ss-rank --fit -s stribeck_velocity=5e-3 -s mass=0.04 -s friction=0.04 -s static_friction=0.05 \
    -s model=stribeck falling.tsv pull.scene > law 2> err
cat err
near mass 0.0307 < law
near base_velocity 42e-6 < law
near stribeck_velocity 3e-3 < law
near static_friction 0.0602 < law
near friction 0.0452 < law
# a mass with a damper on a belt
belt='-s base_velocity=0 -s surface_velocity=-42e-6'
# shellcheck disable=SC2086
ss-sim -c t,s $belt -s damping=0.5 -s v0=-42e-6 pull.scene | ss-noise --snr 40 > belt.tsv
# shellcheck disable=SC2086
ss-rank --fit $belt -s damping=0.8 belt.tsv pull.scene > law 2> err
sed 's/is [0-9.]* times/is ... times/' err
near mass 0.0307 < law
near surface_velocity -42e-6 < law
near damping 0.5 < law
near friction 0.0452 < law
# it slips when the record does
ss-sim -e pull.scene | awk '$2 == "slip" { print $1; exit }' > truth
ss-sim -e fitted | awk '$2 == "slip" { print $1; exit }' | paste truth - | awk '{ print ($1 - $2)^2 < 1e-6 }'
# only the force of the spring; no law that does not slip, or whose numbers the falls do not tell; no noise
ss-rank --fit -a f pull.tsv pull.scene || echo $?
ss-rank --fit pull.tsv pull.scene -s model=stribeck -s stribeck_velocity=1 || echo $?
ss-rank --fit -s damping=1 pull.tsv pull.scene 2> err || echo $?
sed 's/= .*:/= ...:/' err
ss-noise --rms 1 pull.tsv | ss-rank --fit - pull.scene || echo $?
awk '!/^#/ { $2 = -$2 } { print }' OFS='\t' pull.tsv | ss-rank --fit - pull.scene || echo $?
# a force that does not slip by itself, and the level of friction, which slips but is no spring's
ss-sim compliant-light -c t,s | ss-rank --fit - pull.scene || echo $?
ss-sim coulomb -c t,f | ss-rank --fit -a s - pull.scene || echo $?
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
other friction 0 > smooth.scene         # no factor of 0 makes it what it is
answer pull.tsv smooth.scene
answer pull.tsv smooth.scene own.scene
answer falling.tsv own.scene
# of other laws, and beside scenes that are forced
{ sed s/coulomb/stribeck/ own.scene; echo stribeck_velocity = 3.3e-3; } > law.scene
answer falling.tsv own.scene law.scene compliant-light
answer pull.tsv own.scene law.scene
ss-sim coulomb -c t,s | answer - own.scene coulomb
ss-rank falling.tsv own.scene coulomb law.scene | sed -n '/^# does not fit/p; /^[1-9-]/p' | cut -f 1,2
answer pull.tsv own.scene own.scene
ss-rank pull.tsv stiff.scene own.scene | tail -n 2 | cut -f 1,2
ss-rank -v pull.tsv own.scene 2>&1 > /dev/null | grep -c 'own.scene: total .* leaves .* power, [01][.0-9]* times the noise$'
# with so much damping it slides on when f_s is a little less: its own scene is fitted all the same, from either side
cat > hardly.scene <<'EOF'
model = coulomb
mass = 0.1178
stiffness = 2898
static_friction = 1.339e-3
friction = 8.59e-4
surface_velocity = -1.665e-5
v0 = -1.665e-5
settle = 0.1
duration = 0.47
rate = 2182
EOF
ss-sim -c t,s -s damping=3.3 hardly.scene | ss-noise --snr 20 > hardly.tsv
for damping in 3.1 3.3 3.7; do
    { cat hardly.scene; echo damping = $damping; } > own.scene
    answer hardly.tsv own.scene hardly.scene
done
# and with forces a millionth as large
for scene in own hardly; do
    awk '/^(mass|stiffness|static_friction|friction|damping)/ { $3 *= 1e-6 } { print }' $scene.scene > small
    mv small $scene.scene
done
ss-sim -c t,s -s damping=3.3e-6 hardly.scene | ss-noise --snr 20 > hardly.tsv
answer hardly.tsv own.scene hardly.scene
