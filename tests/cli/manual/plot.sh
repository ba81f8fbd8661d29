# The EXAMPLES of ss-plot(1), ss-contour(1) and stickslip-hdf5(5).
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim compliant-light -o run.tsv
ss-plot run.tsv -o figure1.pdf
ss-plot --xy x,f run.tsv -o loop.png
ss-plot -c a --from 1 --to 2 run.tsv > a.gp
ss-sweep --shoot --vary mass=1:9:41 \
    --vary friction=0.1:1.3:49 coulomb > map.tsv
ss-plot --map mass,friction,stops,amplitude map.tsv -o map.png
ss-sim -c t,x,f compliant-light | ss-noise --snr 40 -o rig.tsv
ss-rank --fit -c x rig.tsv > mine.scene
ss-sim -c t,x,f mine.scene -o mine.tsv
ss-plot --xy x,f --over mine.tsv rig.tsv -o loop.png
ss-sim compliant-light | ss-morlet -o run.h5
ss-contour run.h5 -o figure6.pdf
ss-sim --events compliant-light > events
ss-contour --events events --from 1 --to 1.2 run.h5 > transition.gp
{ echo 'set terminal dumb'; cat transition.gp; } | gnuplot 2> /dev/null | grep -c ' 1\.1 '
ss-sim compliant-light | ss-morlet --dense -o run.h5
ss-cat run.h5:/signal/a > a.tsv
sed -n 's/^# columns: //p' a.tsv
ls
