# Of the files that a pattern names, recordings have pages; results of ours are left out; what can be read only once, or
# has no end, is refused before anything is read.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim --set duration=1 --columns t,a compliant-light > run.tsv
ss-sim --set duration=1 --columns t,a -o run.csv compliant-light
ss-sim --set duration=1 --columns t,a -o run.h5 compliant-light
mkdir results
for form in tsv csv; do
    ss-features -o results/features.$form run.tsv
    ss-features --summary -o results/summary.$form run.tsv
    ss-sweep --vary friction=1:2:2 -o results/sweep.$form coulomb
    ss-sweep -m amplitude --vary friction=1:2:2 -o results/short.$form coulomb
    ss-rank -q -o results/ranking.$form run.tsv compliant-light
    ss-morlet --fmin 50 -o results/coefficients.$form run.tsv
    ss-sim -e --set duration=1 -o results/events.$form compliant-light
    ss-trade -q --models -o results/models.$form compliant-light
done
ss-report -o pages run.tsv results/* run.csv run.h5 2> said || echo "status $?"
sed '/left out$/!d' said
ls pages
cmp pages/summaries.tsv - << END || :
$(ss-features --summary run.tsv run.csv run.h5)
END
ss-report -q -o again run.tsv results/* run.csv run.h5
diff -r pages again
ss-report -o none results/* 2> said || echo "status $?"
sed '/left out$/d' said
mkfifo fifo
ln -s /dev/zero evil.csv
ln -s run.csv link.csv
for file in fifo evil.csv /dev/null fifo:/x; do
    ss-report -o none run.csv "$file" || echo "status $?"
done
ss-report -q -o linked link.csv run.h5:/signal/a 2> /dev/null || echo "status $?"
ls linked
ls -d none* 2> /dev/null || echo "nothing left"
