# The EXAMPLES of the same that need other programs.
for p in sox gnuplot python3; do
    command -v $p > /dev/null || { echo "no $p"; exit 77; }
done
python3 -c 'import numpy' 2> /dev/null || { echo "no numpy"; exit 77; }
ss-signal chirp -r 44100 -d 3 -f 50 --to 5000 --format au | sox -t au - chirp.wav 2> /dev/null
sox chirp.wav -t au - 2> /dev/null | ss-cat | tail -n 1 | cut -f 1
awk 'BEGIN { print "t,x"; for (i = 0; i < 500; i++) print i / 100 "," i }' > run.csv
gnuplot -e "set terminal dumb; set output 'plot'; plot '< ss-cat run.csv' using 1:2 with lines"
grep -c '\*' plot > /dev/null
ss-cat run.csv > run.tsv
python3 -c 'import numpy; print(numpy.loadtxt("run.tsv").shape)'
