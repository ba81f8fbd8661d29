# A million forcing cycles of the state-variable model: its last cycles are those of the first minute.
[ -z "$SAN" ] || { echo "the same as without sanitizers, for hours"; exit 77; }
last() {
    ss-sim -t 1e-9 -s settle="$1" -s duration=4 -s rate=25 -c x state-variable | grep -v '^#'
}
last 60 > early
last 399996 | paste early - | awk '{ d = $1 - $2; d = d < 0 ? -d : d; e = d > e ? d : e
    m = $1 > m ? $1 : m } END { if (e > 1e-8 * m) print "differ by " e / m }'
