# A second signal over the first panel, from its beginning on, whatever its own clock and rate are.
printf '# stickslip signal 1\n# rate: 10\n# start: 5\n# columns: t/s x/mm y/mm\n5\t1\t7\n5.1\t2\t8\n5.2\t3\t9\n' > one.tsv
printf '# stickslip signal 1\n# rate: 5\n# start: 0\n# columns: t/s z/mm\n0\t4\n0.2\t5\n' > two.tsv
ss-plot --over two.tsv one.tsv > both.gp
sed -n '/^\$over/,/^EOD/p; /^plot /p' both.gp
# without it nothing changes, but for the curve, its colour, the tics, which have room for both, and the legend
# above them, which names the files
grep '^name = ' both.gp
ss-plot one.tsv > one.gp
grep '^set ytics' both.gp one.gp | head -n 3
common() { sed -e '/^set ytics/d; /^\$over/,/^EOD/d; /^over = /d; s/ title name, \$over using.*//; ' \
    -e '/^set title offset/d; /^name = /d; /^set tmargin/d; /^unset key$/d; /^if .*size/d; /set terminal/d; /centimetre\|height/d' "$@"; }
common one.gp > rest.gp
common both.gp | diff - rest.gp
mkdir folder
cp two.tsv folder/"it's.tsv"
ss-plot --over folder/"it's.tsv" one.tsv | grep '^name = '
# over a loop: the columns of the same names, else the first two
printf '# stickslip signal 1\n# rate: 5\n# start: 0\n# columns: t/s y/mm z/mm x/mm\n0\t4\t0\t1\n0.2\t5\t0\t2\n' > three.tsv
for pair in x,y z,y; do
    ss-plot --xy $pair --over three.tsv three.tsv | sed -n '/^\$over/,/^EOD/p; /^plot/p'
done
ss-plot --xy x,y --over three.tsv one.tsv | sed -n '/^\$over/,/^EOD/p'
# and as much of them as of the signal
ss-plot --xy x,y --from 5.1 --to 5.15 --over one.tsv one.tsv | sed -n '/ << EOD/,/^EOD/p'
ss-plot --over two.tsv --xy x,y one.tsv || echo $?
ss-plot --over two.tsv --over three.tsv one.tsv || echo $?
ss-plot --over absent.tsv one.tsv > /dev/null || echo $?
