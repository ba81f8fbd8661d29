# The band damper's ranking, as ss-rank(1) quotes it: the light compliant contact, by what the
# transitions show; the mean cycle tells nothing.
m=$SRC/../shared/data/measured/band_friction_damper_1hz_20lb.csv
[ -f "$m" ] || { echo "no measured data"; exit 77; }
ss-rank -c friction_force_kip -a f "$m" > rows
grep '^# answer' rows
grep -v '^#' rows | cut -f 2
# no rig of ours: no scene in SI units comes of it
ss-rank --fit -c friction_force_kip -a f "$m" > /dev/null 2> err || echo $?
wc -l < err
