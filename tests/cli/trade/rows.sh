# ss-trade writes a row a method and tolerance, the options that reach a target, and a diagram; a step takes
# a microsecond of this clock.
. "$SRC/tests/link.sh"
link_tool ss-trade "$BUILD/tests/clock.o"
PATH=$PWD:$PATH
ss-trade -b 0.02 --set duration=0.2 -o rows.tsv compliant-light
grep '^# \(stickslip\|scene\|reference\|columns\)' rows.tsv
grep -v '^#' rows.tsv | awk -F '\t' '{ n++; c[NF]++ } $1 == "exact" { print $1, $2, $6, $7, $11, $12 }
    $1 == "rk1imp" && $2 == "1e-13" { print $1, $3, $4, $5, $6, $12 } END { for (i in c) print i, c[i] }'
ss-trade --target 1e-9 --set duration=0.2 compliant-light
if command -v gnuplot > /dev/null; then
    ss-trade -b 0.01 --set duration=0.2 -o a.gp state-variable
    gnuplot -e 'set terminal svg; set output "a.svg"' a.gp 2> log || cat log
    test -s a.svg
    ss-trade -b 0.01 --set duration=0.2 -o b.png state-variable && test -s b.png
fi
