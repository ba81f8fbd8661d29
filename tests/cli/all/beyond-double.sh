# Values that no double holds end a run with their reason.
try() {
    "$@" > out 2> err || echo "exit $?"
    sed 's/t = [^ ]* s/t = T s/; s/about .* s: /about ? s: /' err
    grep -v '^#' out | grep -i -e nan -e inf || :
}
try ss-sim -s base_amplitude=1e305 -s duration=0.5 -s rate=100 compliant-light
try ss-sim -s x0=1e300 -s duration=0.5 -s rate=100 state-variable
try ss-sim -e -s x0=1e305 -s duration=0.5 -s rate=100 compliant-light
try ss-sim -m exact -s v0=1e307 -s duration=0.5 -s rate=100 coulomb
try ss-sim -a 1e-6 -s friction=1e300 -s duration=0.5 -s rate=100 state-variable
try ss-signal noise --amplitude 1e308
ss-signal sine --amplitude 1e308 > huge.tsv
try ss-noise --snr 10 huge.tsv
try ss-noise --rms 1e308 huge.tsv
try ss-noise --rms 1e308 --band 1:1000 -o x.h5 huge.tsv
try ss-signal chirp --to 1e100 --rate 1e300 --duration 2e-300
awk 'BEGIN { print "# stickslip signal 1\n# rate: 10\n# columns: t/s a"
    for (i = 0; i < 20; i++) print i / 10 "\t" (i % 2 ? "" : "-") "1.7e308" }' > jumps.tsv
try ss-cat --resample 20 jumps.tsv

echo "noise is in proportion to its signal, however large"
for amplitude in 1e-300 1 1e300; do
    ss-signal sine --amplitude $amplitude | ss-noise --snr 10 | tail -n 1 | awk '{ printf "%.9f\n", $2 / '$amplitude' }'
done
echo "an axis may reach from end to end of a double"
ss-sweep coulomb --vary friction=1e-300:1e300:3:log --measure amplitude | grep -v '^#' | cut -f 1,2,4
echo "the run of reference has a budget too"
try ss-trade -q --budget 1e-6 -s alpha=1e9 state-variable
echo "a stick that no pull ends, a cycle that no clock measures"
ss-sweep pulled-slider --vary base_velocity=1e-320:1:2 | grep -v '^#' | cut -f 1,2,10
ss-sweep coulomb --vary base_frequency=1e-320:2.5:2 | grep -v '^#' | cut -f 1,2,10
echo "an error that is no number of the scene's largest value is left out"
ss-trade -q --models -s mass=1e300 -s settle=0 -s duration=0.5 -s rate=100 state-variable | grep '^coulomb' | cut -f 1,9
