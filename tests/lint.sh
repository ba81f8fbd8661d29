#!/bin/sh
# lint.sh: what tools find in the source, silent if nothing; one that is missing is skipped with a
# word.  $CC is gcc, $FLAGS what the compiler needs.
set -u
cd "$(dirname "$0")/.." || exit 1
failed=0
have() { command -v "$1" > /dev/null || { echo "skipped: no $1" >&2; false; }; }

# gcc 12 sees neither that a loop fills an array nor that a status other than SS_OK goes with a NULL,
# so what it says of these is left out; the sanitizers and test_memory see to them.  Unchecked
# allocations, double frees, files left open and signal handlers remain.
# shellcheck disable=SC2086  # flags are a list
analyze() {
    $CC $FLAGS -O1 -Wall -Wextra -Wpedantic -Wshadow -Werror -fanalyzer \
        -Wno-analyzer-use-of-uninitialized-value -Wno-analyzer-malloc-leak \
        -Wno-analyzer-null-dereference -Wno-analyzer-use-after-free -c -o /dev/null "$1"
}
if have gcc; then
    for file in src/*.c src/*/*.c src/*/*/*.c tools/*.c; do analyze "$file" || failed=1; done
fi
if have clang-tidy; then
    # shellcheck disable=SC2086
    clang-tidy --quiet src/*.c src/*/*.c src/*/*/*.c -- $FLAGS 2> /dev/null || failed=1
    # A tool is one thread.
    # shellcheck disable=SC2086
    clang-tidy --quiet --checks=-concurrency-mt-unsafe tools/*.c -- $FLAGS 2> /dev/null || failed=1
fi
if have cppcheck; then
    cppcheck -q --error-exitcode=1 --enable=warning,performance,portability --inline-suppr --std=c11 \
        -Iinclude -Isrc -D__GNUC__=12 -DM_PI=3.14 '-DH5E_BEGIN_TRY={' '-DH5E_END_TRY=}' \
        src tools || failed=1
fi
if have shellcheck; then
    shellcheck -s sh .ci/run data/*.sh tools/*.sh tests/*.sh tests/fuzz/*.sh tests/bench/*.sh || failed=1
    shellcheck -s sh -S warning -e SC2034,SC2154,SC2164 tests/*/*.sh || failed=1
fi
if have mandoc; then (cd man && mandoc -T lint ./*.[1-9]) || failed=1; fi
exit $failed
