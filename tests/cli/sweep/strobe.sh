# A row for each cycle of the period, with the exponent of the motion; a sweep cut anywhere goes on.
set -- --simulate --max-cycles 300 -m period,x_phase,v_phase,lyapunov --strobe 5 --vary base_frequency=0.52:0.7:4 chaos
ss-sweep "$@" -o whole.tsv
awk -F '\t' -v OFS='\t' '/^# (strobe|columns)/ || !/^#/ {
    for (i = 4; i < NF && !/^#/; i++) $i = $3 == "aperiodic" && i < 6 ? "." : sprintf("%.1f", $i)
    print }' whole.tsv
for bytes in 0 600 700 900 1100 1400 100000; do
    head -c $bytes whole.tsv > cut.tsv
    ss-sweep --resume cut.tsv "$@"
    cmp cut.tsv whole.tsv
done
for shard in 1 2; do ss-sweep --shard $shard/2 "$@"; done | grep -v '^#' | sort -s -n -k 1,1 > joined
grep -v '^#' whole.tsv | cmp - joined
echo "--- what has no exponent"
ss-sweep -m lyapunov --vary base_velocity=1e-5:1e-4:2 pulled-slider | grep -v '^#'
ss-sweep -m lyapunov --vary surface_velocity=0.1:0.2:2 leine | grep -v '^#'
ss-sweep --strobe 0 --vary mass=1:2:2 coulomb || echo "exit $?"
ss-sweep --strobe 1001 --vary mass=1:2:2 coulomb || echo "exit $?"
