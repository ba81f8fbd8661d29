# The numbers of a spectrum: a sine of amplitude 2 at 250 Hz has the mean square 2, and its Hann window has 2/3 of
# that over 1.5 steps at its own frequency; noise of rms 0.5 has 0.25 over all frequencies.
sum() { awk '/^#/ || /^frequency/ { next } { n = NR; sum += $2; f[NR] = $1; if ($2 > most) { most = $2; at = $1 } }
    END { step = f[n] - f[n - 1]; printf "%.3f at %g Hz, %.4f there\n", sum * step, at, most * step }'; }
ss-signal sine --amplitude 2 --frequency 250 -o sine.tsv
ss-plot --spectrum --format tsv sine.tsv | sum
ss-signal noise --amplitude 0.5 --duration 100 | ss-plot --spectrum -o noise.tsv && sum < noise.tsv | cut -c1-4
# notes, names and units; the same numbers in every form
printf 't,x (m),a (m/s^2)\n' > two.csv
awk 'BEGIN { for (i = 0; i < 64; i++) print i / 100 "," (i % 4) "," 3 }' >> two.csv
ss-plot -q --spectrum --resolution 5 -o two.tsv two.csv && sed '/^# columns/q' two.tsv
ss-plot -q --spectrum --resolution 5 --format csv two.csv > form.csv && head -n 1 form.csv
sed 1d form.csv | tr , '\t' > rows && grep -v '^#' two.tsv | cmp - rows
ss-plot -q --spectrum --resolution 5 --db --format tsv two.csv > db.tsv && grep '^# columns' db.tsv
grep -v '^#' two.tsv | awk '{ printf "%s %.12g\n", $1, 10 * log($2) / log(10) }' > expected
grep -v '^#' db.tsv | awk '{ print $1, $2 }' | paste -d ' ' expected - |
    awk '{ d = $2 - $4 } $1 != $3 || d * d > 1e-10 { print "not", $0 } END { print NR " rows" }'
grep -v '^#' db.tsv | cut -f 3 | sort -u
for options in '--format tsv' '-o x.csv' '--spectrum --format au' '--spectrum -o x.au'; do
    # shellcheck disable=SC2086  # several words
    ss-plot $options sine.tsv || echo $?
done
