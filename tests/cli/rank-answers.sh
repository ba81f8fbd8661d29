# What is told and what is not; columns are as many as their names.
answer() {
    ss-rank "$@" > rows && sed -n 's/^# answer: //p' rows
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
cut -f 1,2 rows | grep -v '^#'
# a force, by its column; another rig by its mass
ss-sim compliant-light | answer -c f
# not in SI units, and named otherwise
ss-sim coulomb --columns a | awk 'BEGIN { print "g" } !/^#/ { print $1 * 0.1 + 3 }' > g.csv
ss-cat --rate 2000 g.csv | answer -c g
# the order under thresholds that move is said either way
grep -c '^# order' rows
