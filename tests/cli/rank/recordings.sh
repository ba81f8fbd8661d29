# Recordings as they come: in coarse steps, in other units, of rigs that the scene is not.
answer() {
    ss-rank "$@" | sed -n '/^# answer/s/[0-9][0-9.]* %/N %/gp'
}
# a converter's steps are no friction, and a column that shows nothing contradicts nothing
ss-sim compliant-heavy | ss-noise --bits=12 --range=2 | answer
for bits in 6 8; do
    ss-sim -c a state-variable | ss-noise --bits=$bits --range=1 | answer
done
ss-sim -c a coulomb | ss-noise --snr 40 | ss-noise --bits=8 --range=1 | answer
# two scenes that are as near to the signal, and one twice
ss-sim -c a coulomb | ss-noise --snr 40 > a.tsv
answer a.tsv coulomb coulomb
ss-sim -l coulomb -s mass=2.43 > twin.scene
answer a.tsv twin.scene coulomb
answer -p 0 a.tsv coulomb coulomb
# a rig far from the scene, within a wide spread
ss-sim -c a coulomb -s mass=1.96 -s stiffness=2541 -s base_frequency=4.25 -s friction=0.732 | ss-noise --snr 40 |
    answer -p 55
# a scene is in SI units
ss-sim -c a compliant-light | ss-noise --snr 40 > g.tsv
ss-cat --scale a=1000 --unit a=mm/s^2 g.tsv > mm.tsv
ss-rank --fit mm.tsv || echo $?
ss-rank --fit mm.tsv --scale a=0.001 --unit a=m/s^2 | grep '^friction' | cut -c 1-15
answer mm.tsv
pull='-s base_amplitude=0 -s base_velocity=1e-3 -s static_friction=1.5'
# shellcheck disable=SC2086  # several words
ss-sim -c s $pull coulomb | ss-cat --scale s=0.001 --unit s=kN > kN.tsv
# shellcheck disable=SC2086
ss-rank $pull kN.tsv coulomb || echo $?
# what a fit holds: damping and static friction that are not the rig's, as they would shift the rest
ss-sim -c a -s damping=0.7 compliant-light | ss-noise --snr 40 > damped.tsv
ss-rank --fit damped.tsv || echo $?
ss-rank --fit damped.tsv compliant-light -s damping=0.7 | awk '$1 == "friction" { print ($3 - 1.28)^2 < 1e-6 }'
ss-sim -c a -s static_friction=1.31 compliant-light | ss-noise --snr 40 | ss-rank --fit || echo $?
