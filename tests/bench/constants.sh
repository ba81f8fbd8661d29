#!/bin/sh
# constants.sh [FOLDER ...]: the tuning constants of src/find and src/fit, one a line: file, name, value; then
# their number in each folder.
#
# A tuning constant decides what features, fits and ranks say.  Counted are #define and enum constants with a
# number, static const numbers, and decimal numbers in the code, called by their line.  Not counted: numbers that
# only formulas have (halves, quarters, powers of ten: ranges and steps of derivatives), and those below, which only
# decide what memory and time is spent, or which part of the work is done.
set -eu
cd "$(dirname "$0")/../.."
spent='LANES|BITS|DIGITS|HALO|STRIP|ROW_HEADS|NONE|SAMPLES_A_STEP|VARPRO_COLUMNS|COLUMNS'
spent="$spent|TRANSFORMED|FLOODED|FITTED|ROOM|SERIES|STATES|AT_ONCE|LAW_NUMBERS|LAWS_MOST|FORCED_RUNS|OFTEN|HEARD|JUDGED"
for folder in "${@:-src/find src/fit}"; do
    # shellcheck disable=SC2086  # two folders by default
    for each in $folder; do
        # without comments and texts
        for file in "$each"/*.[ch]; do
            sed -e 's|/\*.*\*/||; s|/\*.*||; s|^ \*.*||; s|^     *\*.*||; s|"[^"]*"|""|g' "$file" |
                awk -v file="$file" -v spent="^($spent)\$" '
                function say(name, value) { if (name !~ spent) print file "\t" name "\t" value }
                /^ *#define +[A-Z_0-9]+ +\(?-?[0-9.]/ { say($2, $3); next }
                /^ *#/ { next }
                /enum \{|^    [A-Z_0-9]+ = [0-9]/ {
                    rest = $0
                    while (match(rest, /[A-Z_0-9]+ = [0-9.]+($|[ ,;}])/)) {
                        split(substr(rest, RSTART, RLENGTH), part, " = ")
                        if (part[2] + 0 > 1)
                            say(part[1], part[2] + 0)
                        rest = substr(rest, RSTART + RLENGTH)
                    }
                    next
                }
                {
                    rest = $0
                    while (match(rest, /[0-9]*\.[0-9]+(e-?[0-9]+)?|[0-9]+\.?e-?[0-9]+/)) {
                        value = substr(rest, RSTART, RLENGTH)
                        if (value !~ /^0?\.(5|25)$/ && value !~ /^1e/ && !((NR, value) in seen))
                            say("line " NR, value)
                        seen[NR, value] = 1
                        rest = substr(rest, RSTART + RLENGTH)
                    }
                }'
        done | tee "${TMPDIR:-/tmp}/constants.$$"
        echo "$each: $(wc -l < "${TMPDIR:-/tmp}/constants.$$") tuning constants"
        rm -f "${TMPDIR:-/tmp}/constants.$$"
    done
done
