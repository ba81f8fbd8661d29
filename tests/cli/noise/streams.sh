# Added piece by piece or to the whole record, the noise is the same.
ss-signal sine > clean.tsv
ss-noise --rms 0.1 clean.tsv | grep -v '^#' > pieces
ss-noise --snr 16.98970004336019 clean.tsv | grep -v '^#' > whole
paste pieces whole | awk '{ d = $2 - $4; if (d * d > e) e = d * d } END { print (e < 1e-24) }'
ss-noise --snr 20 --seed 5 clean.tsv | head -n 2
printf 't,x,y\n0,1,2\n1,1,3\n' | ss-noise --snr 20 -c x

# The variance of a signal that comes but once: its rows are kept, in whatever form they are read.
ss-signal noise --rate 100 --duration 3 > n.tsv
ss-cat n.tsv -o n.h5
ss-cat n.tsv --format au > n.au
ss-cat n.tsv --format csv > n.csv
ss-cat n.tsv --format csv | awk 'NR % 50 != 7' > gaps.csv
ss-noise --snr 7 n.tsv > n.out
for file in n.au n.h5 n.csv; do ss-noise -q --snr 7 $file | cmp n.out -; done
ss-noise --snr 7 < n.tsv | cmp n.out -
for options in '--gaps=interpolate gaps.csv' '--gaps=split gaps.csv' '--resample 70 n.csv' '--resample 70 n.h5' \
        '--resample 70 n.tsv' '--from 1 --to 2 n.au' '--scale 3 n.csv'; do
    # shellcheck disable=SC2086  # options
    { ss-noise -q --snr 7 $options; ss-cat -q $options | ss-noise --snr 7; } | grep -v '^#' | awk '
        { row[NR] = $0 } END { for (i = 1; i <= NR / 2; i++) if (row[i] != row[i + NR / 2]) print i
            if (NR == 0) print "nothing" }'
done

# A band and a converter, whole and row by row; the band's rms is that of what was added.
ss-noise --snr 20 --band 100:200 clean.tsv -o band.tsv
grep -v '^#' clean.tsv > before
grep -v '^#' band.tsv | paste before - | awk '{ s += ($2 - $4) ^ 2; n++ } END { printf "%.9f\n", s / n }'
grep '^# noise' band.tsv
ss-noise --bits 3 --range 0.5 --column a clean.tsv | awk '!/^#/ { print $2 }' | sort -gu | tr '\n' ' '
echo
ss-noise --bits 3 --range 0.5 clean.tsv -o whole.h5
ss-noise --bits 3 --range 0.5 clean.tsv > rows.tsv
ss-cat whole.h5 | grep '^# clipped'
tail -n 1 rows.tsv
ss-cat whole.h5 | grep -v '^# clipped' > whole
grep -v '^# clipped' rows.tsv | cmp - whole
ss-noise -q --bits 3 --range 0.5 --format au clean.tsv | ss-cat | cmp - whole
ss-noise --rms 1 --seed 2 --bits 8 --range 3 clean.tsv -o whole.h5
ss-noise --rms 1 --seed 2 clean.tsv | ss-noise --bits 8 --range 3 > rows.tsv
ss-cat whole.h5 | grep -v '^# clipped' > whole
grep -v '^# clipped' rows.tsv | cmp - whole
for wrong in '' '--snr 1 --rms 1' '--band 1:2' '--bits 4' '--range 4 --rms 1' '--rms 1 --band 1' \
        '--bits 53 --range 1'; do
    # shellcheck disable=SC2086  # options
    ss-noise $wrong clean.tsv || echo $?
done
ss-noise --rms 1 --band 10:2000 clean.tsv || echo $?

# Into HDF5 a long signal goes in pieces: the same samples, and the note at its end.
ss-signal sine --rate 100000 --duration 12 --format au > long.au
ss-noise -q --rms 0.1 --bits 8 --range 1 -o long.h5 long.au
ss-noise -q --rms 0.1 --bits 8 --range 1 --format au long.au | ss-cat > rows.tsv
ss-cat long.h5 | grep -v '^# clipped' | cmp - rows.tsv
ss-cat long.h5 | sed -n '/^# clipped/p'
ss-noise --rms 0.1 --bits 8 --range 1 long.au 2> /dev/null | tail -n 1
ss-noise --snr 16.98970004336019 --format au long.au | ss-cat | grep -v '^#' > whole
ss-noise --rms 0.1 --format au long.au | ss-cat | grep -v '^#' | paste - whole |
    awk '{ d = $2 - $4; if (d * d > e) e = d * d } END { print NR, (e < 1e-24) }'
