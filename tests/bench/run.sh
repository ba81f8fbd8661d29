#!/bin/sh
# run.sh: what `make bench` does: see README.md.  LONG_RECORD=0 leaves out the records of 1000 s.
set -eu
cd "$(dirname "$0")/../.."
out=$BUILD/bench
mkdir -p "$out"
PATH=$(cd "$BUILD/bin" && pwd):$PATH
: "${PYTHON:=python3}" "${LONG_RECORD:=1}"

compile() {     # NAME LIBRARIES [ENDING]: is it there?
    # shellcheck disable=SC2086  # lists of flags
    $CCLD -o "$out/$1${3-}" "tests/bench/$1.c" "$BUILD/libstickslip.a" $2 $LIBS
}

# Ratios: CPU time over that of our fastest method by steps, and of the closed form, with no larger error.
table() {
    awk -F '\t' '
    /^#/ { print; next }
    { row[++n] = $0; ours[n] = $3 == "exact" || $3 !~ / / }
    function ratio(i, exact,    j, best, a, b) {
        split(row[i], a)
        for (j = 1; j <= n; j++) {
            split(row[j], b)
            if (ours[j] && a[1] == b[1] && a[2] == b[2] && (b[3] == "exact") == exact &&
                    b[5] + 0 <= a[5] + 0 && (best == "" || b[7] + 0 < best))
                best = b[7] + 0
        }
        return best == "" ? "-" : sprintf("%.1f", a[7] / best)
    }
    END {
        line = "%-16s %7s  %-13s %7s %9s %6s %10s %7s %7s\n"
        printf line, "scene", "s", "method", "setting", "error x", "events", "CPU s", "/ steps", "/ exact"
        for (i = 1; i <= n; i++) {
            split(row[i], a)
            printf line, a[1], a[2], a[3], a[4], a[5], a[6], a[7], ratio(i, 0), ratio(i, 1)
        }
    }' "$1"
}

compile cost_sim ''
if compile cost_cvode '-lsundials_cvode -lsundials_nvecserial' 2> "$out/cost_cvode.log"; then
    cvode=1
else
    cvode=0
    echo "CVODE left out: no sundials to compile with (Debian: libsundials-dev)"
fi
if "$PYTHON" -c 'import scipy.integrate' 2> /dev/null; then
    scipy=1
else
    scipy=0
    echo "SciPy left out: $PYTHON has none (PYTHON=... names another)"
fi

if "$PYTHON" -c 'import heyoka' 2> /dev/null; then
    heyoka=1
    compile cost_sim '-shared -fvisibility=default' .so
else
    heyoka=0
    echo "heyoka left out: $PYTHON has none (PYTHON=... names another)"
fi

for seconds in 10 1000; do
    [ $seconds = 10 ] || [ "$LONG_RECORD" = 1 ] || continue
    rows=$out/rows-$seconds.tsv
    "$out/cost_sim" compare $seconds > "$rows"
    [ $cvode = 0 ] || "$out/cost_cvode" $seconds >> "$rows"
    [ $heyoka = 0 ] || "$PYTHON" tests/bench/cost_heyoka.py "$out/cost_sim.so" $seconds >> "$rows"
    if [ $seconds != 10 ]; then
        echo "SciPy left out at $seconds s: it would take a quarter of an hour"
    elif [ $scipy = 1 ]; then
        "$PYTHON" tests/bench/cost_scipy.py $seconds 1e-6 1e-8 1e-10 >> "$rows"
    fi
    sort -s -t "$(printf '\t')" -k 1,1 "$rows" > "$rows.sorted"
    table "$rows.sorted"
    echo
done
"$out/cost_sim" cost "$out/scratch.h5" | expand -t 18
if [ "$LONG_RECORD" = 1 ]; then
    compile cost_features ''
    "$out/cost_features" | expand -t 18
    compile cover_features ''
    "$out/cover_features" | expand -t 22 || echo "errors of ss-features do not cover as they should"
    compile cover_backbone tests/decay.c
    "$out/cover_backbone"
    compile cover_steps
    "$out/cover_steps" 100 | expand -t 15
    compile cover_identity tests/rig.c
    "$out/cover_identity" | expand -t 18 || echo "numbers of ss-features are not of what they say"
fi

# What a tool takes that does nothing: shell loops run many.
echo 'int main(void) { return 0; }' > "$out/empty.c"
$CCLD -o "$out/empty" "$out/empty.c"
start() {       # COMMAND ...: CPU ms a run
    (i=0; while [ $i -lt 300 ]; do "$@" > /dev/null 2>&1; i=$((i + 1)); done; times) |
        awk -F '[ms ]+' 'END { printf "%.1f", ($1 * 60 + $2 + $3 * 60 + $4) / 300 * 1000 }'
}
echo "CPU ms a run: empty program $(start "$out/empty"), ss-cat --version $(start ss-cat --version)"

# Features of a live signal: five minutes at 1 kHz, with transitions and without any.
echo
echo "ss-features --stream of 300 s at 1 kHz: five transitions a second, from 10 and 5 Hz on; white noise"
ss-sim -c t,a -s duration=300 -s rate=1000 compliant-light | ss-noise --snr 40 --seed 7 --format au > "$out/live.au"
ss-signal noise --duration 300 --rate 1000 --seed 7 --format au > "$out/still.au"
for signal in '10 live' '5 live' '10 still'; do
    ss-features -v --stream --fmin "${signal% *}" "$out/${signal#* }.au" 2>&1 > /dev/null | grep CPU
done
