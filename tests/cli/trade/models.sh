# ss-trade --models: the scene beside simpler ones, rows that awk can use, and a sentence.
set -- --set settle=20 --set contact_stiffness=2.099e7 compliant-light
ss-trade --need x=1e-2,a=0.1 "$@"
ss-trade --need x=1e-2,v=1e-3,microslips -o rows.tsv "$@"
grep '^# \(stickslip\|scene\|compared\|answer\|columns\)' rows.tsv
awk -F '\t' '!/^#/ { print $1, $2, $4, $6, $12, $13, $(NF - 1), $NF, NF }' rows.tsv
# The numbers of features are those of ss-features, in its order.
ss-sim compliant-light | ss-features --mass 2.42 --stiffness 2310 | sed -n 's/^# \([a-z_]*\): [-0-9].*/\1/p' |
    grep -v transitions | tr '\n' ' ' > names
ss-trade --models compliant-light | sed -n 's/^# columns:.* microslips \(slips.*\) time state$/\1 /p' > columns
tr ' ' '\n' < columns | grep -v '^$' | while read -r name; do grep -qw -e "$name" names || echo "no $name"; done
# Nothing moves without a forcing cycle to settle to.
ss-trade --models --set base_frequency=0 --set base_amplitude=0 --set x0=0.01 coulomb | awk -F '\t' '!/^#/ { print $1, $NF }'
# A contact of Bouc and Wen, z' = 1 - z^n, becomes the elastic one as its exponent grows: the difference is of 1 / n.
for exponent in 64 256; do
    ss-trade --models --set duration=1 --set settle=1 --set exponent=$exponent dahl | awk '$1 == "compliant" { print $2 }'
done | awk '{ x[NR] = $1 } END { print "bouc-wen:", NR, (x[1] < 0.02 && x[1] / x[2] > 3.5 && x[1] / x[2] < 4.5) }'
try() {
    status=0
    ss-trade "$@" || status=$?
    echo "exit $status"
}
try --need x compliant-light
try --need speed=1 compliant-light
try --need microslips state-variable
try --models --target 1e-3 compliant-light
try --models --dense compliant-light
try --need x=1 -o a.png compliant-light
try --models --set duration=0 compliant-light
if command -v gnuplot > /dev/null; then
    ss-trade --models -o a.gp compliant-heavy
    gnuplot -e 'set terminal svg; set output "a.svg"' a.gp 2> log || cat log
    test -s a.svg
    ss-trade --models -o b.pdf state-variable && test -s b.pdf
fi
