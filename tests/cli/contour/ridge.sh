# The ridge as rows: of a sine its frequency and its amplitude, with both norms, and the ridge of the picture.
for norm in l1 l2; do
    ss-signal sine --frequency 20 --amplitude 3 --duration 8 | ss-morlet --norm $norm --fmin 10 --fmax 80 -o map.h5
    ss-contour --ridge map.h5 -o ridge.tsv
    grep -e '^# stickslip' -e '^# columns' ridge.tsv
    awk -v f="$([ $norm = l1 ] && echo 20 || echo 19.744)" '!/^#/ && $1 > 2 && $1 < 6 { n++
        if (($2 / f - 1) ^ 2 > 1e-6 || ($3 / 3 - 1) ^ 2 > 25e-6) print "off:", $0 } END { print n }' ridge.tsv
done
ss-contour --ridge map.h5 | sed -n '/^\$ridge/,/^EOD/p' | grep -c '^[0-9]'
grep -vc '^#' ridge.tsv
ss-contour map.h5 -o ridge.tsv 2> said || { echo $?; sed 's/;.*//' said; }
