# Recordings of a band damper with play, and of a tribometer.
data=$SRC/../shared/data
[ -f "$data/motion/tribometer.txt" ] || { echo "no measured recordings"; exit 77; }
explained() {
    ss-rank "$@" > rows
    sed -n 's/^# answer: \([a-z ]*\).*/\1/p; s/^# explained: \([^ ]*\).*/\1/p' rows | paste -s -d ' ' -
}
for f in 1hz_20lb:.966 1hz_80lb:.983 0p5hz_36lb_1in:.973 0p25hz_36lb_0p5in:.990; do
    explained --motion displacement_in --column friction_force_kip "$data/measured/band_friction_damper_${f%:*}.csv" |
        awk -v least="${f#*:}" '{ print ($NF >= least), /coulomb|stribeck/ }'
done
explained --motion Position --column Friction --from 10 --to 205 "$data/motion/tribometer.txt" | awk '{ print ($NF >= .998) }'
# A scene of a law with two unlike sides says what its model cannot hold.
ss-rank --fit -s mass=10 -s stiffness=1e6 -m displacement_in -c friction_force_kip \
    "$data/measured/band_friction_damper_1hz_80lb.csv" 2> said | grep '^model'
cat said
