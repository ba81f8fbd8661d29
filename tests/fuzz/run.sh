#!/bin/sh
# run.sh HARNESS ...: fuzz each for $FUZZ_SECONDS, or $FUZZ_RUNS times, from $BUILD/tests, and say what
# came of it.
#
# What libFuzzer finds to be new goes to $BUILD/corpus/NAME, what fails to $BUILD/findings/NAME.
# A finding does not end a run.  Those of which HDF5 itself is to blame are counted apart: its
# parser is not ours to mend, and README.md says what that means.
set -u
if [ -n "${FUZZ_RUNS-}" ]; then limit=-runs=$FUZZ_RUNS; else limit=-max_total_time=${FUZZ_SECONDS:=60}; fi
SRC=$(cd "$(dirname "$0")/../.." && pwd)
BUILD=$(cd "$BUILD" && pwd) || exit 1
LSAN_OPTIONS=suppressions=$SRC/tests/fuzz/leaks:print_suppressions=0
ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=1
UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export LSAN_OPTIONS ASAN_OPTIONS UBSAN_OPTIONS
failed=0

# Run a finding again: 0 if it does not fail then (it was slow on a loaded machine), else 1 if HDF5 is
# to blame, 2 if we are: the topmost function that is neither the sanitizer's nor libc's decides.
blame() {
    "$1" -timeout=60 "$2" > "$2.report" 2>&1 && { rm -f "$2" "$2.report"; return 0; }
    awk '/^ *#[0-9]+ / && !/libc\.so|nptl|sysdeps|compiler-rt|interceptor|sanitizer|__asan|fuzzer::| in (free|malloc|calloc|realloc|mem[a-z]*|str[a-z]*) / {
             exit /libhdf5/ ? 1 : 2
         }' "$2.report"
}

fuzz() {
    name=${1##*/fuzz_}
    program=$BUILD/tests/$1 found=$BUILD/findings/$name new=$BUILD/corpus/$name
    rm -rf "$found"
    mkdir -p "$found" "$new"
    dictionary=$SRC/tests/fuzz/$name.dict
    [ -f "$dictionary" ] || dictionary=$SRC/tests/fuzz/text.dict
    leaks=1
    [ "$name" != hdf5 ] || leaks=0      # looked for at the end only: those of HDF5 are many
    "$program" -fork=1 -detect_leaks=$leaks -ignore_crashes=1 -ignore_timeouts=1 -ignore_ooms=1 \
        -timeout=10 -rss_limit_mb=2048 "$limit" -max_len=65536 \
        -dict="$dictionary" -artifact_prefix="$found/" "$new" "$SRC/tests/fuzz/corpus/$name" \
        > "$found.log" 2>&1
    ours=0 theirs=0
    for file in "$found"/*; do
        [ -f "$file" ] || continue
        blame "$program" "$file"
        case $? in 1) theirs=$((theirs + 1)) ;; 2) ours=$((ours + 1)) ;; esac
    done
    # The edges of all workers together are counted wrongly; those of the corpus are what it is.
    edges=$("$program" -runs=0 "$new" "$SRC/tests/fuzz/corpus/$name" 2>&1 | awk '/INITED/ { print $4 }')
    awk -v name="$name" -v ours=$ours -v theirs=$theirs -v edges="$edges" '
        /^#[0-9]+: cov: / { split($0, f, "[ :#]+"); runs = f[2] }
        END { printf "%s: %d executions, %d edges, %d findings", name, runs, edges, ours
              print (theirs > 0 ? ", " theirs " inputs fail in HDF5 itself" : "") }' "$found.log"
    [ $ours = 0 ] || { failed=1; echo "see $found"; }
}

for harness; do fuzz "$harness"; done
exit $failed
