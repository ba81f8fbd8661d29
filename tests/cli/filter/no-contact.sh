# The edge of a filter is no contact: not of white noise, not of Coulomb friction, whose contact is rigid, and not of
# a contact at 47 Hz that a low-pass at 45 Hz, flat to 36 Hz, has bent.  Without the note that says so, ringing cut by
# the edge is taken for transitions; a filter that leaves the contact as it is does not hide it.
count() { ss-features -q | awk -v what="$1" '/^# transitions:/ { n = $3 } /^# transition_frequency:/ { f = $3 }
    END { print what, n, f == "-" ? f : int(f + .5) }'; }
for seed in 1 2 3; do
    ss-signal noise --rate 2000 --duration 10 --seed $seed > noise.tsv
    ss-sim -c t,a coulomb --set duration=10 | ss-noise --snr 40 --seed $seed > coulomb.tsv
    ss-sim -c t,a compliant-light --set duration=10 | ss-noise --snr 40 --seed $seed > contact.tsv
    for signal in noise coulomb contact; do
        ss-filter -q --low-pass 45 $signal.tsv | count "$signal"
    done
    ss-filter -q --low-pass 45 contact.tsv | sed '/^# filter/d' | count 'without a note' |
        awk '{ print $1, $2, $3, ($4 > 0) }'
    ss-filter -q --high-pass 5 --low-pass 400 contact.tsv | count 'passed'
done
