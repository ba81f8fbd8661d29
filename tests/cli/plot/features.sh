# Transitions of ss-features are shaded in every panel, behind the line.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
printf '# stickslip signal 1\n# rate: 10\n# columns: t/s x/mm f/N\n0\t1\t7\n0.1\t2\t8\n0.2\t3\t9\n0.3\t1\t7\n' > run.tsv
printf '# stickslip features 1\n# columns: onset/s end/s spikes time/s frequency/Hz prominence/dB\n' > none.tsv
(cat none.tsv; printf '0.1\t0.15\t1\t-\t-\t-\n0.25\t0.9\t1\t-\t-\t-\n0.6\t0.7\t1\t-\t-\t-\n') > found.tsv
ss-plot --features found.tsv run.tsv > shaded.gp
sed -n '/^\$spans/,/^EOD/p; /y2range/p; /^plot /p' shaded.gp
# without one nothing changes
ss-plot run.tsv > bare.gp
sed '/^\$spans/,/^EOD/d; /y2range/d; s/\$spans.*feature_colour, //' shaded.gp | cmp - bare.gp
ss-plot --features none.tsv run.tsv | sed '/^\$spans/,/^EOD/d' | cmp - bare.gp
ss-plot --features - run.tsv < found.tsv | cmp - shaded.gp
# as many bands in the picture as transitions that are seen, in each panel
ss-plot --features found.tsv run.tsv -o shaded.svg
grep -ciE '<polygon.*(f2ccc4|242, *204, *196)' shaded.svg
for options in '--xy x,f run.tsv' '--spectrum run.tsv' '--map x,f run.tsv' '-' 'run.tsv --features run.tsv' \
    'run.tsv --features absent.tsv'; do
    # shellcheck disable=SC2086  # several words
    ss-plot --features - $options > /dev/null < found.tsv || echo $?
done
