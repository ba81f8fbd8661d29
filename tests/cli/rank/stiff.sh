# A scene that takes millions of steps a cycle is not adjusted for minutes: one line, in time.
ss-sim compliant-light > sig.tsv
# shellcheck disable=SC3045  # POSIX has only ulimit -f, but every sh here limits CPU time
(ulimit -t "${SAN:+10}60"; exec ss-rank -q -s friction=1e12 sig.tsv state-variable) > out 2> err && echo "an answer"
[ ! -s out ] && [ "$(wc -l < err)" = 1 ] && grep -q 'integration steps' err || cat err
