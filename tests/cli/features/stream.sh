# A stream of features: the rows of the whole recording, each at most two periods of --fmin and .2 s late.
ss-sim -c t,a compliant-light --set duration=8 --set rate=1000 | ss-noise --snr 40 -o run.tsv
ss-features --fmin 5 run.tsv > whole.tsv
ss-features --fmin 5 --stream run.tsv > stream.tsv
both() {        # rows of either, and of these whose onsets are the same within 20 ms
    awk '/^[0-9]/ { if (FNR == NR) t[++n] = $1; else { m++; for (i = 1; i <= n; i++) if (($1 - t[i]) ^ 2 < 4e-4) k++ } }
        END { print n, (m > n - 3 && m < n + 3), (k > n - 3) }' whole.tsv stream.tsv; }
both
awk '/^# transition_frequency:/ { print ($3 - 47.1226) ^ 2 < 9 * $4 ^ 2, $4 < .02 }
    /^# transitions:/ { print ($3 > 36) }' stream.tsv
awk '/^[0-9]/ && $7 != "-"' stream.tsv | wc -l | awk '{ print ($1 > 20) }'

echo "-- as they come, and stopped"
mkfifo in
last() { awk -v by="$1" '/^[0-9]/ && $2 < by - .6 { t = $2 } END { print t + 0 }' "$2"; }
stopped() {     # what ends .6 s before now is there, while the pipe is open, and the numbers, once nothing comes
    tool=$!
    exec 3> in
    from=-1
    for now in 3.4 3.7 4.1 4.35 4.6 4.95; do
        awk -v from=$from -v now=$now '/^#/ { if (from < 0) print; next } $1 >= from && $1 < now' run.tsv >&3
        until [ "$(last $now out)" = "$(last $now stream.tsv)" ]; do sleep 0.1; done
        from=$now
    done
    awk -v from=$from '/^[^#]/ && $1 >= from && $1 < 5' run.tsv >&3
    printf '5\t1' >&3           # the last row may be of more digits
    echo there
    kill -TERM "$tool"
    wait "$tool" 2> /dev/null || echo "a signal: $(($? > 128))"
    exec 3>&-
    grep -c '^# transitions:' out; }
: > out
ss-features --fmin 5 --stream < in > out &
stopped
: > out
ss-features --fmin 5 --stream in > out &
stopped

echo "-- the same bytes"
awk '{ print; fflush() } NR % 2000 == 0 { system("sleep .1") }' run.tsv | ss-features --fmin 5 --stream | cmp - stream.tsv
# the numbers of the whole stand in every row, in those of parts as the last whole window has them
ss-sim --set duration=8 compliant-heavy | ss-features --fmin 5 -c a --mass 2.42 --stiffness 2310 --stream --format csv |
    awk -F , 'NR == 1 { for (c = 1; c <= NF; c++) is[$c] = c; next }
        $is["all_slips"] < 14 || ($is["all_contact_stiffness"] - 209900) ^ 2 > 100 { print "off:", $0 } END { print (NR > 30) }'
ss-features --fmin 5 --stream --format json run.tsv | head -n 1 | tr ',' '\n' | sed -n '2p;4p;s/^{//p'

echo "-- refused"
refused() { "$@" > out || echo "exit $?"; }
refused ss-features --stream run.tsv
refused ss-features --stream --fmin 5 run.tsv run.tsv
refused ss-features --stream --fmin 600 run.tsv
refused ss-features --stream --fmin .001 run.tsv
