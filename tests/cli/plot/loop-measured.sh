# The friction loop of man/figures/README by its own commands, and what it says of the other recordings.
data=$SRC/../shared/data/measured
[ -d "$data" ] || { echo "no measured recordings"; exit 77; }
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
sed -n '/^loop.png,/,/^made smaller/s/^    //p' "$SRC/man/figures/README" > walk
sed 1d walk > others
cp "$data"/band_friction_damper_*.csv .
sh -eu walk
awk '/^# (friction|loading_stiffness):/ { printf "%s %.3g\n", $2, $3 }' damper.features
grep -v '^#' scene.tsv | paste damper.rows scene.rows | awk '{ d = ($2 - $5) ^ 2; far = d > far ? d : far }
    END { printf "%.2f mm\n", 1000 * sqrt(far) }'
for other in '1hz_80lb 10 0 10' '1hz_20lb 10 1 7' '1hz_20lb 10 0 10' '0p5hz_36lb_1in 14 4 11' \
        '0p5hz_36lb_1in 14 0 14' '0p25hz_36lb_0p5in 28 8 20' '0p25hz_36lb_0p5in 28 0 28'; do
    # shellcheck disable=SC2086  # four words
    set -- $other
    recording=band_friction_damper_$1.csv duration=$2 from=$3 to=$4 sh -eu others
done
