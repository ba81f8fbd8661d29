# Scripts and pictures of every form, drawn by gnuplot without a word.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim -o run.tsv compliant-light
ss-sim --events compliant-light > events
ss-morlet run.tsv -o run.h5
ss-morlet run.tsv > run.coef
for form in png svg pdf; do
    ss-plot run.tsv -o panels.$form
    ss-plot --xy x,f --from 1 run.h5 -o loop.$form
    ss-contour run.h5 --events events -o contour.$form
    ss-contour --signal run.tsv --column v --from 1 --to 1.5 - < run.coef -o zoom.$form
done
ls
head -c 4 panels.png | tail -c 3
grep -c '<svg' contour.svg
head -c 4 loop.pdf
echo

# The script draws by itself, on any terminal, and the tool draws nothing else.
ss-contour run.h5 > contour.gp
grep -c '^set terminal\|^set output' contour.gp || :
{ echo 'set terminal dumb 79,24'; cat contour.gp; } | gnuplot > dumb 2> /dev/null
grep -c 'time / s' dumb
ss-contour run.h5 -o again.gp
cmp contour.gp again.gp
