# The smallest and largest values and time steps: every command gives finite numbers, or refuses in one
# line.  (Warnings are off.)
signal() { awk -v rate="$1" -v x="$2" 'BEGIN {
    print "# stickslip signal 1\n# rate: " rate "\n# columns: x/m"
    for (i = 0; i < 40; i++) print i % 3 == 0 ? x : i % 3 == 1 ? "-" x : 0 }'; }
try() {
    rm -f picture.gp
    status=0
    "$@" -q in.tsv > out 2> err || status=$?
    [ ! -f picture.gp ] || cat picture.gp >> out
    ! grep -a -i -w -e nan -e inf out || echo "$*, $x at $rate Hz"
    case $status,$(wc -l < err | tr -d ' ') in
    0,0) numbers=$((numbers + 1)) ;;
    1,1) refusals=$((refusals + 1)) ;;
    *) echo "status $status: $*, $x at $rate Hz"; cat err ;;
    esac
}
for rate in 5e-324 1e-300 1 1e300 1e308; do
    for x in 5e-324 1e-310 2.3e-308 1e-300 1 1e300 1.7e308; do
        signal $rate $x > in.tsv
        numbers=0 refusals=0
        try ss-cat
        try ss-cat --format au -o copy.au
        try ss-cat -o copy.h5
        try ss-cat --resample 0.3
        try ss-cat --resample 1.3e300
        try ss-noise --snr 20
        try ss-noise --rms 1e-310
        try ss-noise --rms 1e308
        try ss-noise --bits 12 --range 1e-280
        try ss-plot -o picture.gp
        echo "$x at $rate Hz: $numbers times numbers, $refusals refusals"
    done
done

echo "uneven stamps"
for x in 5e-324 1 1e307 1.7e308; do
    printf 't_s,x\n0,%s\n0.9,-%s\n2.1,%s\n3,-%s\n4,%s\n' $x $x $x $x $x > uneven.csv
    ss-cat --resample 1 uneven.csv 2>&1 | grep -v '^#'
done
printf 't,x\n0,1\n1e-300,2\n2.1e-300,1e9\n3e-300,4\n4e-300,1\n' | ss-cat --time-unit s --resample 1e300 2>&1 || echo "exit $?"
