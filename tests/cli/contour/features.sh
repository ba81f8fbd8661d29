# What was read from a signal is drawn: transitions, spikes and maxima, or none of them.
ss-signal ringdown --duration 1 | ss-morlet --dyadic -o run.h5
{
    echo '# stickslip features 1'
    echo '# columns: onset/s end/s spikes time/s frequency/Hz prominence/dB'
    printf '%s\t%s\t%s\t%s\t%s\t%s\n' 0.1 0.2 3 0.15 45.3 9.5 0.3 0.4 1 - - - - - 0 0.5 20 5
    echo '# spike: 0.125 kink -3 8.5'
    echo '# spike: 7 jump 0 2'
    echo '# spike: 0.2 bend -9 40'
    echo '# spikes: counted'
} > features
echo '# stickslip features 1' > nothing
ss-contour -v --features features run.h5 -o all.gp 2>&1 | sed -e 's/.*events: [0-9]*, //' -e '/of CPU/d'
awk '/^\$(spans|spikes|maxima) <</, /^EOD/' all.gp
grep -c 'feature_colour' all.gp
ss-contour --features nothing run.h5 -o none.gp
grep -c '\$spans using\|\$spikes using\|\$maxima using' none.gp || true
if command -v gnuplot > /dev/null; then
    for plot in all none; do
        gnuplot -e 'set terminal dumb' $plot.gp > picture 2> complaints
        grep valid complaints || true      # an empty block would be complained of
    done
fi
for text in '# stickslip events 1' '0.1 0.2 3' '0.1 x'; do
    { [ "${text#\#}" != "$text" ] || echo '# stickslip features 1'; echo "$text"; } > wrong
    ss-contour --features wrong run.h5 -o wrong.gp || echo $?
done
ss-contour --features - run.h5 -o piped.gp < features
cmp all.gp piped.gp
