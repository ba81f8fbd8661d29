# Scripts and pictures of every form, drawn by gnuplot without a word.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim -o run.tsv compliant-light
ss-sim --events compliant-light > events
ss-morlet run.tsv -o run.h5
ss-morlet run.tsv > run.coef
for form in png svg pdf eps; do
    ss-plot run.tsv -o panels.$form
    ss-plot --spectrum -c a -c x run.tsv -o spectrum.$form
    ss-contour --from 0.2 --fmin 5 run.tsv -o recording.$form
    ss-plot --xy x,f --from 1 run.h5 -o loop.$form
    ss-contour run.h5 --events events -o contour.$form
    ss-contour --signal run.tsv --column v --from 1 --to 1.5 - < run.coef -o zoom.$form
    ss-contour --fill --palette magma --ridge --fmin 9 --fmax 99 --from 1 --to 4 --events events run.h5 -o fill.$form
done
ls
head -c 4 panels.png | tail -c 3
grep -c '<svg' contour.svg
head -c 4 loop.pdf
echo
head -c 4 loop.eps
echo
ss-plot run.tsv -o capitals.PNG && cmp capitals.PNG panels.png
ss-plot run.tsv -o /dev/null && ss-cat run.tsv -o /dev/null && ss-contour run.h5 -o /dev/null && [ -c /dev/null ]

# The script draws by itself, on any terminal, and the tool draws nothing else.
ss-contour run.h5 > contour.gp
grep -c '^set terminal\|^set output' contour.gp || :
{ echo 'set terminal dumb 79,24'; cat contour.gp; } | gnuplot > dumb 2> /dev/null
grep -c 'time / s' dumb
ss-contour run.h5 -o again.gp
cmp contour.gp again.gp

# Times are told apart and stand apart: tics of spans short and late, with their letters; 34 fit.  Late ones count from
# a round one.
while read -r from to; do
    printf 'time (s),x\n%s,1\n%s,2\n' "$from" "$to" > span.csv
    ss-plot --from "$from" --to "$to" span.csv | sed -n 's/^tics = \([^ ]*\).*/\1/p' |
        awk -v to="$to" '{ to -= to > 1e5 ? 1e6 : 0; for (k = int(to / $1 + 1e-6) - 1; k <= to / $1 + 1e-6; k++)
                if (length(sprintf("%.12g", $1 * k)) > n) n = length(sprintf("%.12g", $1 * k)); print $1, n }'
done <<'SPANS'
0 3
0 10
91.1813 91.38128
1 1.0001
1000000 1000000.01
SPANS
