# With -v every tool says what was done, and in its last line what it cost.
ss-sim compliant-light -o run.h5
ss-morlet --octaves=-5:-4 run.h5 -o w.h5
for command in 'ss-cat run.h5' 'ss-backbone -c a run.h5' 'ss-filter --low-pass 100 run.h5' 'ss-contour w.h5' 'ss-features run.h5' 'ss-morlet run.h5' \
        'ss-noise --snr 20 run.h5' 'ss-plot run.h5' 'ss-rank run.h5' 'ss-signal sine' \
        'ss-sim coulomb' 'ss-sweep --vary mass=1:2:3 coulomb' 'ss-trade --budget 0.01 coulomb'; do
    tool=${command%% *}
    $tool -v ${command#* } 2> err > out
    [ "$(wc -l < err)" -ge 2 ] || echo "$command: says nothing"
    tail -n 1 err | grep -qxE "$tool: [0-9.e-]+ s of CPU, [1-9][0-9]* MB of memory" || echo "$command: no cost"
    $tool -q ${command#* } 2> err > out
    [ ! -s err ] || cat err
done
for tool in "$SRC"/tools/ss-*.c; do
    grep -q "$(basename "$tool" .c) " "$SRC/tests/cli/all/verbose-cost.sh" || echo "not here: $tool"
done
ss-sim -v --version 2>&1 | wc -l
