# The EXAMPLES of ss-plot(1), ss-contour(1) and stickslip-hdf5(5).
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim compliant-light -o run.tsv
ss-plot run.tsv -o figure1.pdf
ss-plot --xy x,f run.tsv -o loop.png
ss-plot -c a --from 1 --to 2 run.tsv > a.gp
ss-plot -c a --title '' run.tsv > a.gp
gnuplot -e "set terminal cairolatex pdf size 8.5cm,4cm" -e "set output 'a.tex'" a.gp 2> warnings
grep -c 'includegraphics.*{a}' a.tex
head -c 4 a.pdf; echo; rm a.tex a.pdf warnings
mkdir squeal
for f in 1200 2345; do
    ss-signal sine --frequency $f --rate 25600 --duration 1 | ss-noise --snr 20 |
        awk '/^#/ { next } !n++ { print "t_s,a (g)" } { print $1 "," $2 }' > squeal/$f.csv
done
cd squeal
for f in *.csv; do
    ss-plot --spectrum --resolution 10 --format tsv -c a $f |
        awk -v file=$f '!/^#/ && $1 > 900 && $2 > most { most = $2; f = $1 }
            END { print file, f, most }'
    ss-contour -c a --fmin 900 --ridge $f -o ${f%.csv}.png
done | awk '{ printf "%s %g %.4f\n", $1, $2, $3 }'
ls; cd ..
ss-sweep --shoot --vary mass=1:9:41 \
    --vary friction=0.1:1.3:49 coulomb > map.tsv
ss-plot --map mass,friction,stops,amplitude map.tsv -o map.png
ss-sim -c t,x,f compliant-light | ss-noise --snr 40 -o rig.tsv
ss-rank --fit -c x rig.tsv > mine.scene
ss-sim -c t,x,f mine.scene -o mine.tsv
ss-plot --xy x,f --over mine.tsv rig.tsv -o loop.png
ss-sim -c t,x,f compliant-heavy -o driven.tsv
ss-features -c f driven.tsv | grep -E 'friction|loading' | awk '{ printf "%s %.3g\n", $2, $3 }'
ss-sim --base driven.tsv:x -s mass=1 -s stiffness=1e8 \
    -s damping=2e4 -s contact_damping=0 -s friction=1.28 \
    -s contact_stiffness=208543 -s settle=0 -s duration=2.9 \
    -c t,x,f compliant-heavy -o moved.tsv
ss-plot --xy x,f --over moved.tsv driven.tsv -o driven.png
# what the scene leaves of the force, after the first slips: 4 %
for side in driven moved; do grep -v '^#' $side.tsv | head -n 5800 > $side.rows; done
paste driven.rows moved.rows | awk '$1 > 0.5 { power += $3 ^ 2; left += ($3 - $6) ^ 2 }
    END { printf "%.2f\n", sqrt(left / power) }'
rm driven.* moved.*
ss-sim compliant-light | ss-morlet -o run.h5
ss-contour run.h5 -o figure6.pdf
ss-sim --events compliant-light > events
ss-contour --events events --from 1 --to 1.2 run.h5 > transition.gp
{ echo 'set terminal dumb'; cat transition.gp; } | gnuplot 2> /dev/null | grep -c ' 1\.1 '
ss-sim compliant-light | ss-morlet --dense -o run.h5
ss-cat run.h5:/signal/a > a.tsv
sed -n 's/^# columns: //p' a.tsv
ls
