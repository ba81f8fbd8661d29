# A clock that no double can count by is refused, with its reason, wherever it comes from.
refused() { "$@" || echo $?; }
csv() { printf 't,x\n'; awk -v step="$1" 'BEGIN { for (i = 0; i < 4; i++) print i step "," i }'; }
csv e-309 | refused ss-cat
csv e-320 | refused ss-features
csv e-323 | refused ss-morlet
csv e300 | refused ss-cat --time-unit s
csv e307 | refused ss-cat --time-unit s
printf 't,x\n-1e308,1\n0,2\n1e308,3\n' | refused ss-cat
printf 't,x\n1e301,1\n2e301,2\n3e301,3\n' | refused ss-plot
printf 'x\n1\n2\n3\n' > column
for rate in 2e-301 1e301; do refused ss-cat --rate $rate column; done
for rate in 2e-301 1e301; do
    printf '# stickslip signal 1\n# rate: %s\n# columns: x\n1\n2\n' $rate | refused ss-cat
    csv e0 | refused ss-cat --time-unit s --resample $rate
done
printf '# stickslip signal 1\n# rate: 1\n# start: 1e305\n# columns: x\n1\n2\n' | refused ss-noise --rms 1
# What is just within them is read.
csv e-299 | ss-cat --time-unit s
csv e298 | ss-cat --time-unit s
# An array in HDF5 too.
ss-signal sine --duration 0.01 -o run.h5
refused ss-cat --rate 2e-301 run.h5:/signal/t
