#!/bin/sh
# coverage.sh: which lines of src/ the tests in $BUILD ran, file by file and in all; at least 95 %.
set -eu
cd "$(dirname "$0")/.."
BUILD=$(cd "$BUILD" && pwd)
command -v gcov > /dev/null || { echo "no gcov"; exit 77; }
rm -rf "$BUILD/report"
mkdir "$BUILD/report"
find "$BUILD/src" -name '*.gcda' > "$BUILD/report/files"
(cd "$BUILD/report" && xargs gcov -r -s "$OLDPWD" -p < files > log 2>&1)
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
