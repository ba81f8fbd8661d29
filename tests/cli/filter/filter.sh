# ss-filter: the EXAMPLES of its manual, its units, notes and ends; the same bytes however a pipe delivers them.
ss-sim -c t,x compliant-light | ss-filter --derivative 1 --low-pass 100 > v.tsv
sed -n '/filter/p;/start/p;/columns/p' v.tsv
ss-sim -c t,a compliant-light --set duration=30 | ss-noise --snr 40 > a.tsv
ss-filter --integral 2 --high-pass 1 a.tsv > x.tsv
sed -n '/filter/p;/start/p;/columns/p' x.tsv
ss-filter --high-pass 5 --low-pass 400 a.tsv | ss-features -q |
    awk '/^# transition_frequency:/ { d = $3 - 47.1226; print "contact", d * d < .01 }'
ss-filter --low-pass 200 a.tsv | ss-plot --spectrum -o spectrum.gp

# The velocity and the displacement of a simulation are the derivative and the integral of its other columns.
compare() { awk -v most="$1" '!/^#/ { if (FNR == NR) v[sprintf("%.6f", $1)] = $2
    else if (sprintf("%.6f", $1) in v) { d = $2 - v[sprintf("%.6f", $1)]; n++; if (d * d > e) e = d * d
        s = $2 * $2 > s ? $2 * $2 : s } } END { print (n > 1000), (sqrt(e / s) < most) }' "$2" "$3"; }
ss-sim -c t,x,v state-variable --set duration=12 > run.tsv
ss-filter -c v --low-pass 100 run.tsv > low.tsv
ss-filter -c x --derivative 1 --low-pass 100 run.tsv > v.tsv
compare 2e-4 v.tsv low.tsv
ss-filter -c x --high-pass 2 run.tsv > high.tsv
ss-filter -c v --integral 1 --high-pass 2 run.tsv > x.tsv
compare 5e-4 x.tsv high.tsv

echo "-- units, notes, gaps"
rows() { awk -v unit="$1" 'BEGIN { print "# stickslip signal 1\n# rate: 100\n# start: 0\n# columns: t/s x/" unit
    for (i = 0; i < 900; i++) print i / 100 "\t" i % 10 }'; }
for unit in m m/s 'm/s^2' '(N m)' '(m s)' '(m s^2)' s; do
    for order in --integral=2 --integral=1 --derivative=1 --derivative=2; do
        rows "$unit" | ss-filter -q $order | sed -n 's/^# columns: t.s //p'
    done | tr '\n' ' '
    echo
done
rows m | ss-filter --high-pass 2 | ss-filter --low-pass 20 | ss-filter --derivative 1 | sed -n '/^# filter/p'
rows m | ss-cat --format csv | sed '400,420d' | ss-filter --gaps=split --low-pass 20 | sed -n '/^# gaps/p'
rows m | ss-filter --integral 1 | sed -n '/^# filter/p'

echo "-- the same bytes"
ss-signal noise --duration 3 > noise.tsv
for options in '--low-pass 100' '--high-pass 10 --integral 1' '--derivative 2'; do
    # shellcheck disable=SC2086  # options
    ss-filter -q $options noise.tsv > whole.tsv
    # shellcheck disable=SC2086
    awk '{ print; fflush() } NR % 500 == 0 { system("sleep .05") }' noise.tsv | ss-filter -q $options | cmp - whole.tsv
    # shellcheck disable=SC2086
    ss-filter -q $options -o whole.au noise.tsv && ss-cat whole.au | grep -v '^#' > one
    grep -v '^#' whole.tsv | cmp - one
done

echo "-- refused"
refused() { "$@" > out || echo "exit $?"; }
refused ss-filter a.tsv
refused ss-filter --derivative 1 --integral 1 a.tsv
refused ss-filter --derivative 5 a.tsv
refused ss-filter --stop 200 --low-pass 20 a.tsv
refused ss-filter --low-pass 1000 a.tsv
refused ss-filter --low-pass 20 --high-pass 15 a.tsv
refused ss-filter --high-pass .1 noise.tsv
refused ss-filter --low-pass 20 < /dev/null
