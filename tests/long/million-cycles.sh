# A million forcing cycles of each model with events: the count known from the first thousand seconds
# and the period, by the closed form and by rk8pd; x by one against x by the other; no drift of phase.
[ -z "$SAN" ] || { echo "the same as without sanitizers, for hours"; exit 77; }
for scene in coulomb compliant-heavy compliant-light; do
    for method in exact rk8pd; do
        ss-sim -v -s settle=0 -s duration=400000 -s rate=0.137 -c x -m $method $scene \
            > $method.tsv 2> log
        echo "$scene $method $(sed -n 's/.*, \([0-9]*\) events/\1/p' log)"
    done
    grep -v '^#' rk8pd.tsv > b
    grep -v '^#' exact.tsv | paste - b | awk '{ d = $1 - $2; d = d < 0 ? -d : d; e = d > e ? d : e
        m = $1 > m ? $1 : m } END { print (e <= 1e-10 * m ? "agree" : "differ by " e / m) }'
done
