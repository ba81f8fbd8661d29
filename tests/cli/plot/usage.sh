# Wrong usage is exit 2, wrong data exit 1, each with a line.
ss-sim -o run.tsv coulomb
ss-morlet --dyadic run.tsv -o run.h5
for options in '-o a.gif' '--xy x' '--xy x,' '--xy x,f -c a' '--from x' '--map a,b one two' '--nonsense' '--db' \
    '--spectrum --xy x,f' '--resolution 0 --spectrum'; do
    # shellcheck disable=SC2086  # several words
    ss-plot $options > /dev/null || echo $?
done
for options in '--levels 0' '--levels 101' '--span 0' '--palette jet' '--fmin 0' '--fmin 9 --fmax 9' \
    '-o a.tsv' '--signal -' '--from 2 --to 1'; do
    # shellcheck disable=SC2086
    ss-contour $options < /dev/null || echo $?
done
ss-contour -c a - < /dev/null || echo $?
ss-plot -c force run.tsv || echo $?
ss-plot --from 0 --xy t,a run.tsv || echo $?
ss-plot -c t run.tsv || echo $?
ss-plot absent.tsv || echo $?
ss-contour --signal run.tsv run.tsv || echo $?
ss-plot --spectrum --resolution 1e-9 run.tsv || echo $?
ss-contour --signal run.tsv --column force run.h5 || echo $?
printf '# stickslip events 1\nsoon\n' | ss-contour --events - run.h5 || echo $?
ss-contour --events run.tsv run.h5 || echo $?
ss-contour --events - run.h5 < /dev/null || echo $?
ss-contour < run.h5 || echo $?
echo 'not HDF5' > text.h5
ss-contour text.h5 || echo $?
ss-plot run.h5:/wavelet || echo $?
ls
