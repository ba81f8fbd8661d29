#!/bin/sh
# coverage.sh: which lines of src/ the tests in $BUILD ran, file by file and in all; at least 95 %.
#
# A line that is compiled more than once, as in a header or for several processors (base/versions.h), has run if
# it ran in one of them.
#
# The other 1.2 % are: a third, failures of memory, of files and of HDF5, of which test_memory, test_store_failures and
# cli/all/full-disk bring about those that lie at a place of their own; a third, refusals and reasons of fits and searches for
# records that no test has; and arguments that no tool gives, and numbers at the ends of double precision.
set -eu
cd "$(dirname "$0")/.."
BUILD=$(cd "$BUILD" && pwd)
command -v gcov > /dev/null || { echo "no gcov"; exit 77; }
rm -rf "$BUILD/report"
mkdir "$BUILD/report"
find "$BUILD/src" -name '*.gcda' > "$BUILD/report/files"
ln -s "$PWD/src" "$PWD/include" "$BUILD/report"            # gcov looks for them where it writes
(cd "$BUILD/report" && xargs gcov -r -p < files > log 2>&1)
awk -F : '
    { name = FILENAME; sub(/.*\//, "", name); sub(/\.gcov$/, "", name); gsub(/#/, "/", name) }
    name !~ /^src/ { next }
    !((name, $2) in ran) && $1 ~ /^ *([0-9]+\*?|[#=]+)$/ { ran[name, $2] = 0; lines[name]++; all++ }
    $1 ~ /^ *[0-9]/ && !ran[name, $2]++ { done[name]++; sum++ }
    END {
        for (n in lines)
            printf "%5.1f %%  %4d of %4d  %s\n", 100 * done[n] / lines[n], done[n], lines[n], n | "sort -n"
        close("sort -n")
        printf "%5.1f %%  %d of %d lines of src/\n", 100 * sum / all, sum, all
        exit sum < 0.95 * all
    }' "$BUILD"/report/*.gcov
