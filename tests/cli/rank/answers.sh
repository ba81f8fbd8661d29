# What is told and what is not; columns are as many as their names.
answer() {
    ss-rank --long "$@" > rows && sed -n 's/^# answer: //p' rows | sed 's/[0-9.e+]* \(times\|%\)/N \1/g'
    ! grep '#.*#' rows           # each note is a line
    awk -F '\t' '/^# columns:/ { n = split($0, name, " ") - 2 }
                 !/^#/ { rows++; if (NF != n) print "columns", NF, n }
                 END { if (rows != 4) print "rows", rows + 0 }' rows
}
ss-signal sine -f 2.5 -d 4 | answer
ss-signal noise -d 4 | answer
ss-signal step -d 4 --at 2 | answer
ss-signal sine -d 0 | answer
ss-signal sine -d 4 --amplitude 0 | answer
ss-sim state-variable | ss-noise --snr 20 | answer
cut -f 1,2 rows | grep -v '^#' | head -n 1
awk '/^# noise:/ { print ($3 / (100 / 101) - 1) ^ 2 < 0.01 }' rows      # of 20 dB
# a force, by its column; another rig by its mass
ss-sim compliant-light | answer -c f
# not in SI units, and named otherwise
ss-sim coulomb --columns a | awk 'BEGIN { print "g" } !/^#/ { print $1 * 0.1 + 3 }' > g.csv
ss-cat --rate 2000 g.csv | answer -c g
# the quantity by name, by unit, by the unit a name ends in; V may be volts: nothing tells
for name in F displacement_in Friction-Force_kip slip_velocity_mm_s acc_raw slip_mm 'load (kN)' \
            load_kN table_mm_s2 V stress_MPa; do
    printf '%s\n' "$name" 0 1 2 3 4 5 6 7 | ss-cat --rate 1 - | ss-rank --long 2> err |
        sed -n 's/^# quantity: //p'
    sed 's/^ss-rank: /    /' err
done
# the per cents of a refusal are those of the row that leaves least, but for the samples at events
ss-sim state-variable --columns v | ss-rank --long --as a > rows
grep -o 'none of these: each leaves at least' rows
awk -F '\t' '/^# answer/ { left = $0; sub(/.*at least /, "", left); part = $0; sub(/.*most, /, "", part) }
    !/^#/ { power = 100 * 10^($4 / 10); least = least == "" || power < least ? power : least }
    END { print (left - least)^2 < 1e-2, (100 - part - least)^2 < 1 }' rows
# columns of one recording that two models made: whichever is asked, the other contradicts it
ss-sim state-variable > s.tsv; ss-sim coulomb --columns x > c.tsv
{ printf 'x\ta\n'; grep -v '^#' c.tsv | cut -f 2 > x; grep -v '^#' s.tsv | cut -f 4 | paste x -; } > mixed.tsv
ss-cat --rate 2000 mixed.tsv | ss-noise --snr 40 > mixed
ss-rank mixed | sed -n '/^# answer/s/: it leaves.*//p'
ss-rank -c x mixed | sed -n '/^# answer/s/: it leaves.*//p'
# -v tells of the work, also where there is no answer
ss-sim state-variable --columns v | ss-rank -v --as a 2>&1 > /dev/null |
    grep -c 'taken as a, by --as$\|4 scenes adjusted\|: total .* leaves .* %\|ahead of .*, but each leaves'
ss-signal noise -d 4 | ss-rank -v 2>&1 > /dev/null | grep 'adjusted'
