# Several files in one picture: columns of the same names over one another, from the beginning of the first on.
printf '# stickslip signal 1\n# rate: 10\n# start: 5\n# columns: t/s x/mm y/mm\n5\t1\t7\n5.1\t2\t8\n5.2\t3\t10\n' > one.tsv
printf '# stickslip signal 1\n# rate: 5\n# start: 0\n# columns: t/s y/mm z/mm\n0\t4\t0\n0.2\t5\t0\n' > two.tsv
printf '# stickslip signal 1\n# rate: 20\n# start: 0\n# columns: t/s q/mm\n0\t0\n0.05\t9\n0.1\t1\n0.15\t9\n0.2\t1\n' > three.tsv
ss-plot one.tsv two.tsv three.tsv > all.gp
sed -n '/^\$over/,/^EOD/p; /^plot /p; /^over/p; /^name/p' all.gp
# what the first has beyond the others, by lines between their samples; a sample behind the end of one is left out
echo '-- differences'
ss-plot -c y --difference one.tsv two.tsv three.tsv | sed -n '/^\$difference/,/^EOD/p; /^plot /p'
awk 'NR < 7' one.tsv > short.tsv
ss-plot --over short.tsv --difference one.tsv | sed -n '/^\$difference/,/^EOD/p; /^plot /p'
# a sine and itself at half the rate: lines miss the samples between by 1 - cos(omega h) of these, which are at most
# cos(pi/10)
ss-signal sine --frequency 50 --rate 1000 -o fine.tsv
ss-signal sine --frequency 50 --rate 500 -o half.tsv
ss-plot --difference fine.tsv half.tsv | awk '/set label 1 .*10/ { unit = 1e-3 } /^\$difference/ { on = 1; next } /^EOD/ { on = 0 }
    on && NF { most = $2 > most ? $2 : most }
    END { pi = atan2(0, -1); print (most * (unit ? unit : 1) / (cos(pi / 10) * (1 - cos(pi / 10))) - 1) ^ 2 < 1e-6 }'
echo '-- loops and spectra'
ss-plot --xy x,y one.tsv one.tsv | sed -n '/^\$over/,/^EOD/p; /^plot /p'
ss-signal sine --frequency 50 -o sine.tsv
ss-signal noise --rate 500 -o noise.tsv
ss-plot --spectrum sine.tsv noise.tsv > spectra.gp
grep -e '^plot' -e '^from' -e '^to' spectra.gp
awk '/^\$over_panel1/ { on = 1; next } /^EOD/ { on = 0 } on { n++; sum += $2 } END { print (n > 100), (sum / n > 1e-3 && sum / n < 1e-2) }' spectra.gp
ss-sim coulomb --set duration=1 -o run.tsv
for options in '' '--difference' '--spectrum' '--xy x,v'; do
    # shellcheck disable=SC2086  # two words
    ss-plot $options run.tsv run.tsv -o picture.png && head -c 4 picture.png | tail -c 3 && echo
    rm picture.png
done
echo '-- a title that all share, above a legend whose rows are those that gnuplot makes: 11 letters are 2.6 cm of 6.7'
for damping in 5 25; do ss-sim compliant-light --set duration=1 --set contact_damping=$damping -o damping$damping.tsv; done
for files in 'damping5.tsv damping25.tsv' 'damping5.tsv damping5.tsv' 'run.tsv run.tsv'; do
    # shellcheck disable=SC2086  # two words
    ss-plot -c x $files | grep -e '^set title ["'\'']' -e maxcols
done
ss-plot -c x damping25.tsv damping5.tsv damping5.tsv -o rows.svg
awk '/translate/ { split($0, place, /[(,)]/) } /<text>damping/ && !(place[3] in seen) { seen[place[3]]; rows++ }
    END { print rows " rows" }' rows.svg
echo '-- other units'
printf '# stickslip signal 1\n# rate: 10\n# start: 5\n# columns: t/s y/m q/N\n5\t1\t7\n5.1\t2\t8\n' > metres.tsv
ss-plot one.tsv metres.tsv -o units.gp 2>&1
ss-plot -c y one.tsv three.tsv -o units.gp 2>&1
ss-plot -c y metres.tsv --over three.tsv -o units.gp 2>&1
echo '-- refused'
refused() { ss-plot "$@" > out || echo $?; }
refused --over two.tsv one.tsv two.tsv
refused one.tsv two.tsv two.tsv two.tsv two.tsv two.tsv two.tsv two.tsv
refused --difference one.tsv
refused --spectrum --difference one.tsv two.tsv
refused --spectrum --format tsv one.tsv one.tsv
refused --xy x,y one.tsv three.tsv
refused - - < one.tsv
