#!/bin/sh
# coverage.sh: which lines of src/ the tests in $BUILD ran, file by file and in all; at least 95 %.
#
# Of the rest most are inner loops that are compiled for several processors (base/versions.h) and counted
# once for each, while one machine runs one of them.  Others are failures of GSL, FFTW and HDF5 on memory
# of their own, which nothing here can bring about, words for statuses that always come with a text, and
# guards against sizes beyond what a machine has.
set -eu
cd "$(dirname "$0")/.."
BUILD=$(cd "$BUILD" && pwd)
command -v gcov > /dev/null || { echo "no gcov"; exit 77; }
rm -rf "$BUILD/report"
mkdir "$BUILD/report"
find "$BUILD/src" -name '*.gcda' > "$BUILD/report/files"
ln -s "$PWD/src" "$PWD/include" "$BUILD/report"            # gcov looks for them where it writes
(cd "$BUILD/report" && xargs gcov -r -p < files > log 2>&1)
awk '
    { name = FILENAME; sub(/.*\//, "", name); sub(/\.gcov$/, "", name); gsub(/#/, "/", name) }
    name !~ /^src/ { next }
    $1 ~ /^[0-9]+\*?:/ { ran[name]++ }
    $1 ~ /^[#=]+:/ { not[name]++; ran[name] += 0 }
    END {
        for (n in ran) {
            printf "%5.1f %%  %4d of %4d  %s\n", 100 * ran[n] / (ran[n] + not[n]), ran[n],
                   ran[n] + not[n], n | "sort -n"
            all += ran[n]; missed += not[n]
        }
        close("sort -n")
        printf "%5.1f %%  %d of %d lines of src/\n", 100 * all / (all + missed), all, all + missed
        exit all < 0.95 * (all + missed)
    }' "$BUILD"/report/*.gcov
