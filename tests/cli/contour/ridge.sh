# The ridge as rows: of a sine its frequency and its amplitude, whatever the frequency, the norm and the number of
# voices, and the ridge of the picture.  ln |W| is -(a w - c)^2/2, a parabola in the scale a, which three rows give
# exactly, and with the norm l2 ln a / 2, whose cubic part u^3/6 in u = ln a moves the top by h^2/6/c^2 and raises it
# by h^3/16 at most, where scales differ by the factor exp(h); a^1/2 then moves the amplitude by half as much.
for voices in 4 16; do for norm in l1 l2; do for f in 17.24 20 31; do
    ss-signal sine --frequency $f --amplitude 3 --duration 8 \
        | ss-morlet --norm $norm --voices $voices --fmin 10 --fmax 80 --exact-bits -o map.h5
    ss-contour --ridge map.h5 -o ridge.tsv
    awk -v f=$f -v voices=$voices -v l2="$([ $norm = l1 ] || echo 1)" '
        BEGIN { h = l2 * log(2) / voices; of_f = h ^ 2 / 200 + 1e-9; of_a = h ^ 2 / 400 + h ^ 3 / 15 + 1e-9 }
        !/^#/ && $1 > 2 && $1 < 6 { n++
        if (($2 / f - 1) ^ 2 > of_f ^ 2 || ($3 / 3 - 1) ^ 2 > of_a ^ 2) print "off:", $0 } END { print n }' ridge.tsv
done; done; done | sort | uniq -c
grep -e '^# stickslip' -e '^# columns' ridge.tsv
ss-contour --ridge map.h5 | sed -n '/^\$ridge/,/^EOD/p' | grep -c '^[0-9]'
grep -vc '^#' ridge.tsv
ss-contour map.h5 -o ridge.tsv 2> said || { echo $?; sed 's/;.*//' said; }
