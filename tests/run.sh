#!/bin/sh
# run.sh TEST_PROGRAM ...: run all tests, several at a time, and close with their sum.
#
# Tests are the CMocka programs named, from $BUILD/tests, and the scripts below tests/cli and
# tests/build, with LONG=1 also tests/long.  A script is run by sh -eu in an empty
# directory, with the tools in PATH and $SRC, $BUILD, $CC, $CCLD (compiler with flags for linking),
# $LIBS, $INCLUDES, $TOOL_PARTS (objects that tools share), $MAKE, $SAN and $LOCALES set.  It must give what
# NAME.out, NAME.err and NAME.exit beside it hold (nothing, nothing and 0 if they are absent).  Exit 77
# skips it, its first line saying why.
# python3 is the first that has NumPy, h5py, xarray and h5netcdf, or else the first.
# ONLY='test_store cli/features/rows' runs these alone.
set -u
SRC=$(cd "$(dirname "$0")/.." && pwd)
: "${LIMIT:=600}" "${JOBS:=$(getconf _NPROCESSORS_ONLN)}"

# --- one test, by a run.sh of its own ----------------------------------------------------------

limited() {
    if command -v timeout > /dev/null; then timeout -k 10 "$LIMIT" "$@"; else "$@"; fi
}

# Sets passed, failed, skipped from the test's words in TAP.
run_program() {
    # by env: an assignment before a function is not exported by every shell
    limited env TMPDIR="$scratch" CMOCKA_MESSAGE_OUTPUT=TAP "$BUILD/tests/$1" > "$log" 2>&1 < /dev/null
    status=$?
    # shellcheck disable=SC2046  # four numbers
    set -- $(awk '/^(not )?ok .*# SKIP/ { s++; next } /^ok / { p++ } /^not ok / { f++ }
        /^1\.\.[0-9]+$/ { plan += substr($0, 4) } END { print p + 0, f + 0, s + 0, plan + 0 }' "$log")
    passed=$1 failed=$2 skipped=$3
    if [ $((passed + failed + skipped)) -ne "$4" ] || [ "$4" = 0 ] ||
            { [ $status != 0 ] && [ "$failed" = 0 ]; }; then
        echo "exit status $status after $((passed + failed + skipped)) of $4 tests" >> "$log"
        failed=$((failed + 1))
    fi
}

compare() {     # FILE WHAT: is the text in $scratch.WHAT that of FILE, or empty without FILE?
    if [ -f "$1" ]; then diff -u "$1" "$scratch.$2"; else diff -u /dev/null "$scratch.$2"; fi ||
        passed=0
}

run_script() {
    passed=0 failed=0 skipped=0 status=0 wanted=0
    base=$SRC/tests/$1
    (cd "$scratch" && limited sh -eu "$base.sh" > "$scratch.out" 2> "$scratch.err" < /dev/null) ||
        status=$?
    if [ $status = 77 ]; then
        skipped=1
        head -n 1 "$scratch.out" > "$log"
        return
    fi
    [ ! -f "$base.exit" ] || read -r wanted < "$base.exit"
    passed=1
    {
        compare "$base.out" out
        compare "$base.err" err
        [ $status = "$wanted" ] || { echo "exit status $status, not $wanted"; passed=0; }
        if grep -qF -e "$SRC" -e "$scratch" "$scratch.out" "$scratch.err"; then
            echo "a path of this machine in the output"
            passed=0
        fi
    } > "$log" 2>&1
    failed=$((1 - passed))
}

if [ "${1-}" = --one ]; then
    scratch=$WORK/$(echo "$2" | tr / -)
    log=$scratch.log
    mkdir "$scratch" || exit 1
    began=$(date +%s)
    case $2 in
    */*) run_script "$2" ;;
    *)   run_program "$2" ;;
    esac
    echo "$passed $failed $skipped $2" > "$scratch.count"
    spent=$(($(date +%s) - began))
    if [ "$failed" != 0 ]; then line="FAIL  $2: $failed failed"
    elif [ "$passed" = 0 ]; then line="skip  $2: $(head -n 1 "$log")"
    else line="ok    $2"
    fi
    [ $((passed + failed + skipped)) = 1 ] || line="$line ($((passed + failed + skipped)) tests)"
    [ $spent -lt 2 ] || line="$line $spent s"
    echo "$line"                    # at once: others write too
    exit 0
fi

# --- all tests ---------------------------------------------------------------------------------

WORK=$(mktemp -d "${TMPDIR:-/tmp}/stickslip-check.XXXXXX") || exit 1
trap 'rm -rf "$WORK"' EXIT
trap 'exit 130' HUP INT TERM
BUILD=$(cd "$BUILD" && pwd) || exit 1
PATH=$BUILD/bin:$PATH
HOME=$WORK
LC_ALL=C
ASAN_OPTIONS=detect_stack_use_after_return=1
[ "$(uname)" = Darwin ] || ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=1
UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export SRC WORK BUILD PATH HOME LC_ALL ASAN_OPTIONS UBSAN_OPTIONS LIMIT CC CCLD LIBS INCLUDES TOOL_PARTS MAKE SAN
unset CDPATH GNUTERM DISPLAY
for python in ${PYTHON-} $(command -v python3) /usr/bin/python3; do
    if "$python" -c 'import numpy, h5py, xarray, h5netcdf' 2> /dev/null; then
        mkdir "$WORK/bin"
        printf '#!/bin/sh\nexec "%s" "$@"\n' "$python" > "$WORK/bin/python3"
        chmod +x "$WORK/bin/python3"
        PATH=$WORK/bin:$PATH
        break
    fi
done

# A locale with a decimal comma, where the system can make one.
mkdir "$WORK/locales"
if localedef -c -i de_DE -f UTF-8 "$WORK/locales/de_DE.UTF-8" > /dev/null 2>&1 ||
        [ -e "$WORK/locales/de_DE.UTF-8/LC_NUMERIC" ]; then
    LOCALES=$WORK/locales
    export LOCALES
fi

cd "$SRC" || exit 1
tests=$*
for script in $(find tests/cli tests/build ${LONG:+tests/long} -name '*.sh' 2> /dev/null | sort); do
    script=${script#tests/} tests="$tests ${script%.sh}"
done

tests=${ONLY:-$tests}
[ -n "$tests" ] || { echo "no tests"; exit 1; }

# shellcheck disable=SC2086  # a list of names
printf '%s\n' $tests | xargs -n 1 -P "$JOBS" sh tests/run.sh --one

passed=0 failed=0 skipped=0
: > "$WORK/reasons"
for name in $tests; do
    result=$WORK/$(echo "$name" | tr / -)
    read -r p f s _ < "$result.count" || { p=0 f=1 s=0; }
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
    [ "$s" = 0 ] || if [ "$p" = 0 ]; then echo "$(head -n 1 "$result.log"): $name"
    else echo "as they say: $s in $name"; fi >> "$WORK/reasons"
    [ "$f" = 0 ] || { echo; echo "--- $name"; cat "$result.log"; }
done
[ $skipped = 0 ] || sort "$WORK/reasons" | awk -F ': ' '
    { text = $1 == reason ? text ", " $2 : text end (text == "" ? "Not tested: " : "; ") $2 }
    { reason = $1; end = " (" $1 ")" }
    END { print text end "." }'
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
