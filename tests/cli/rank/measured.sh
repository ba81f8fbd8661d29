# The band damper is none of the rigs, as ss-rank(1) says, whatever its column is taken for.
m=$SRC/../shared/data/measured/band_friction_damper_1hz_20lb.csv
[ -f "$m" ] || { echo "no measured data"; exit 77; }
ss-rank --long -c friction_force_kip "$m" > rows
grep '^# quantity\|^# answer' rows | cut -d : -f 1,2
# no rig of ours: no scene in SI units comes of it
ss-rank --fit -c friction_force_kip -a f "$m" > /dev/null 2> err || echo $?
wc -l < err
ss-rank -c friction_force_kip -a a "$m" | sed -n '/^# answer/s/:.*/&/p' | cut -d : -f 1,2
