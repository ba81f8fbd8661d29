# The band damper's ranking, as ss-rank(1) quotes it: the light compliant contact, by what the
# transitions show; the mean cycle tells nothing.
m=$SRC/../shared/data/measured/band_friction_damper_1hz_20lb.csv
[ -f "$m" ] || { echo "no measured data"; exit 77; }
ss-rank -c friction_force_kip "$m" > rows
grep '^# quantity\|^# answer' rows
grep -v '^#' rows | cut -f 2
# no rig of ours: no scene in SI units comes of it
ss-rank --fit -c friction_force_kip -a f "$m" > /dev/null 2> err || echo $?
wc -l < err
# taken for what it is not: the first by total leaves most of the cycle, another hardly any of it
ss-rank -c friction_force_kip -a a "$m" > rows
sed -n '/^# answer/s/[0-9.]* %/N %/gp' rows
awk -F '\t' '/^# answer/ { split($0, part, "leaves "); first = part[2] + 0; best = part[3] + 0 }
    !/^#/ { left = 100 * 10^($4 / 10); least = least == "" || left < least ? left : least
            top = top == "" ? left : top }
    END { print ((first - top)^2 < 0.01 && (best - least)^2 < 1e-4) }' rows
