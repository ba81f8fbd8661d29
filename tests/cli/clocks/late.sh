# Where a clock starts so late that its time stamps would be equal, it is refused, in every form of a signal.
refused() { "$@" || echo "exit $?"; }
tsv() { printf '# stickslip signal 1\n# rate: %s\n# start: %s\n# columns: x\n1\n2\n3\n' "$1" "$2"; }
tsv 100 1e17 | refused ss-cat
tsv 100 -1e17 | refused ss-features
tsv 100 1e15 | refused ss-morlet
tsv 100 7e13 | ss-cat
tsv 1e-17 1e17 | ss-cat
printf '# stickslip coefficients 1\n# rate: 100\n# start: 1e17\n# columns: x\n1\n' | refused ss-contour
tsv 1000 1e9 | refused ss-cat --resample 1e8
printf 't,x\n1000000000,1\n1000000000.001,2\n1000000000.002,3\n' > run.csv
refused ss-cat --time-unit s --resample 1e8 run.csv
tsv 1000 1e9 | refused ss-noise --rms 1 --resample 1e8
tsv 1000 0 > run.tsv
ss-cat -o run.au run.tsv
sed 's/start: 0/start: 1e17/' run.au > late.au
refused ss-cat late.au
