# Axes that can be read: of values far from 0, of a constant, of microseconds; without what was not measured.
awk 'BEGIN { print "time (s),p (Pa)"; for (i = 0; i < 40; i++) printf "%.3f,%.3f\n", i/1000, 101325 + i%5/1000 }' > far.csv
ss-plot far.csv | grep '^set ytics\|label 1 "'
ss-plot --xy p,p far.csv | grep '^set xlabel'
ss-contour --fmin 200 far.csv | grep 'label 2 "p'
awk 'BEGIN { print "time (s),x (m)"; for (i = 0; i < 40; i++) printf "%.3f,3.7\n", i/1000 }' > constant.csv
ss-plot constant.csv | grep '^set ytics'
ss-plot --spectrum constant.csv | grep '^set label 2'

# A gap is drawn as a gap, by a line over time and by a path.
printf 'time (s),x (m),y\n0,1,1\n1,2,4\n2,,\n3,,\n4,3,5\n5,4,6\n' > gap.csv
for how in split interpolate; do
    ss-plot -c x --gaps $how gap.csv | sed -n '/^\$panel1 /,/^EOD/p'
done
ss-plot --xy x,y --gaps split gap.csv | sed -n '/^\$path /,/^EOD/p'
# A path needs no clock: stamps may have any spacing.
printf 't (s),x (m),y\n0,1,1\n.1,2,4\n.35,3,5\n.4,4,6\n.9,5,6\n' > uneven.csv
ss-plot --xy x,y uneven.csv | sed -n '/^\$path/,/^EOD/p'
ss-plot --gaps split --from 2.1 --to 2.9 gap.csv > none.gp || echo $?

# Contours end with the record.
ss-signal sine --duration 1 --rate 500 > sine.tsv
ss-contour --from -1 --to 3 sine.tsv | awk '/^\$contour/ { on = 1; next } /^EOD/ { on = 0 }
    on && NF { if ($1 < 0 || $1 > 1) n++; m++ } END { print n + 0, (m > 100) }'

# A long title and a long name are broken near their middle; high frequencies have a power of ten.
title='Measured at the second bearing of the left machine before and after the lubrication of its shaft'
ss-plot --title "$title" far.csv | grep '^set title'
printf 'time (s),acceleration of the left bearing radial (m/s^2)\n0,1\n1,2\n' > name.csv
ss-plot name.csv | grep -o 'label 1 "[^"]*"'
ss-signal sine --rate 2e6 --duration 1e-4 --frequency 1e5 > fast.tsv
ss-contour -o fast.gp fast.tsv
grep -o 'label 2 "freq[^"]*"' fast.gp

ss-plot --spectrum fast.tsv | grep -o "^set xtics ('[^']*' [^,]*"

# Zeros that stand for missing samples do not choose the scale; one sample is a point.
awk 'BEGIN { print "time (s),F (N)"; for (i = 0; i < 99; i++) print i/1000 "," (i % 9 ? 1000 + i%7/100 : "") }' > holes.csv
ss-plot --gaps split holes.csv | grep -o 'label 1 "[^"]*"'
ss-signal sine --duration 0.0005 | ss-plot | grep '^plot'

# An offset that leaves a label no room makes its letters smaller.
printf 'time (s),big\n0,100000001\n1,100000003\n' > big.csv
ss-plot big.csv | grep -o 'label 1 "[^"]*".*'

# Times far from 0 count from a round one.
for step in 0.1 0.001; do
    awk -v step=$step 'BEGIN { print "time (s),x"
        for (i = 0; i < 40; i++) printf "%.6f,%d\n", 1795764879.124 + i * step, i % 7 }' > epoch.csv
    ss-plot epoch.csv | grep -e '^set xtics add' -e '^set xlabel'
done

# The axes of a map and of a diagram have short tics where a parameter varies little: what is drawn, plus the
# offset, is what was varied.
ss-sweep coulomb --vary friction=1.28:1.2801:3 --vary base_frequency=3:3.00001:3 --measure stops -o map.tsv
ss-plot --map friction,base_frequency,stops map.tsv > map.gp
grep -o -e '^set [xy]range.*' -e 'set xlabel "[^"]*"' -e 'set label 1 "[^"]*"' map.gp
ss-sweep coulomb --vary friction=1.28:1.2801:3 --measure x_max -o diagram.tsv
ss-plot --map friction,x_max diagram.tsv > diagram.gp
grep -o -e '^set xrange [^;]*' -e 'set xlabel "[^"]*"' -e 'set label 1 "[^"]*"' diagram.gp
offset=$(sed -n 's/.*set label 1 .* \\342\\210\\222 \([0-9.]*\) m.*/\1/p' diagram.gp)
sed -n '/^\$panel1 /,/^EOD/p' diagram.gp | awk -v offset="$offset" 'NF == 2 { printf "%.7f %.9f\n", 1.28 + 1e-6 * $1, offset + 1e-6 * $2 }'
awk '!/^#/ && NF > 2 { printf "%.7f %.9f\n", $2, $3 }' diagram.tsv

# a title that would reach beyond the page stands in two lines
ss-sim -s damping=1 -s base_amplitude=0 -s x0=.01 -s duration=.1 -s settle=0 compliant-light | ss-plot | grep '^set title'
# microseconds, as gnuplot writes them
command -v gnuplot > /dev/null || exit 0
{ echo 'set terminal dumb 99,40'; cat fast.gp; } | gnuplot 2> /dev/null | grep -o 'time / .*s'
