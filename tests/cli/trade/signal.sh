# ss-trade tells a signal from a scene, by its contents, and measures the transform.
ss-signal chirp --duration 0.2 --frequency 20 --to 200 > c.tsv
ss-trade c.tsv | awk -F '\t' '/^# (signal|reference|columns)/ { print; next } /^#/ { next }
    { print $1, $2 < 1e-13, $5 }'
ss-trade --budget 1e-6 - < c.tsv | grep -c estimated
ss-signal chirp --duration 0.2 --frequency 20 --to 200 --format au |
    ss-trade --dense --target 1e-6 - | sed 's/ [a-z]*$/ NAME/'
printf '\n# a comment\n' | cat - "$SRC/data/scenes/coulomb.scene" | ss-trade -b 0.01 --target 1e-3 - \
    | sed -E 's/^--method (exact|taylor --tol [0-9.e-]+)$/--method exact or taylor/'
if command -v gnuplot > /dev/null; then
    ss-trade -o c.png c.tsv && test -s c.png
fi
try() {
    status=0
    ss-trade "$@" || status=$?
    echo "exit $status"
}
try --set mass=1 c.tsv
try --dense coulomb
try --column b c.tsv
