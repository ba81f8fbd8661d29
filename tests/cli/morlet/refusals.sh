# Scales that the record does not resolve are refused with the usable range, unless --force.
ss-signal sine --duration 3 -o s.tsv
for options in "--fmax 1000" "--fmin 0.1" "--fmin 900" "--fmax 0.2" "--octaves -12:0" \
        "--fmin 100 --fmax 100.1" "--accuracy 1e-13 --fmax 500"; do
    # shellcheck disable=SC2086  # options are a list
    ss-morlet $options s.tsv -o c.tsv 2>&1 || echo "exit $?"
done
[ ! -e c.tsv ]
ss-morlet --force --fmin 0.1 --fmax 2000 s.tsv | tail -n 1 | cut -f 1
ss-signal sine --duration 0 | ss-morlet 2>&1 || echo "exit $?"
ss-signal sine --duration 0.0005 | ss-morlet 2>&1 || echo "exit $?"
ss-signal sine --duration 0.001 | ss-morlet --force --fmin 100 --fmax 200 | grep -vc '^#'
ss-signal sine --duration 0.001 | ss-morlet --force --fmin 100 2>&1 || echo "exit $?"
ss-morlet --voices 1 --center 20 s.tsv | ss-morlet --inverse 2> said || echo "exit $?"
sed 's/factor of [^ ]*/factor of N/' said
ss-features --fmin 900 s.tsv 2>&1 || echo "exit $?"
# what lies beyond the scales comes slowly in the inverse; the accuracy offered is taken
ss-sim --set duration=1 --set rate=500 compliant-light | ss-morlet --fmin 20 -o q.tsv
ss-morlet --inverse --accuracy 1e-9 q.tsv 2> said || echo "exit $?"
sed 's/[0-9.]*e*[-0-9]* \(of the coeff\)/N \1/; s/\(accuracy of\) [^ ]*/\1 N/; s/some [^ ]* passes/some N passes/' said
takes=$(sed 's/.*accuracy of \([^ ]*\) can.*/\1/' said)
ss-morlet --inverse --accuracy "$takes" q.tsv | grep -vc '^#'
# nothing is left, and no header written
for output in '' '-o c.tsv' '-o c.h5'; do
    # shellcheck disable=SC2086  # options
    ss-morlet --stream --fmin 20 --from 7 $output s.tsv 2>&1 || echo "exit $?"
done
[ ! -e c.tsv ] && [ ! -e c.h5 ]
