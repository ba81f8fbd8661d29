# sh check.sh EVENTS VALUES: compare two tables, with the columns and rows of events.tsv and values.tsv, with these.
# Times must agree to 1e-10 s, and to 1e-10 of the largest x, v and f of the scene the others.
# Says what differs, and exits 1 if anything does.  (Needs a POSIX shell and awk, nothing else.)
folder=$(dirname "$0")
compare() {     # TRUTH GIVEN WORDS: columns that are words, as ":3:4:"
    awk -F '\t' -v words="$3" -v truth="$1" '
        FNR == 1 { file++; if (file == 1) split($0, name) ; next }
        file == 1 { rows++; for (i = 1; i <= NF; i++) row[rows, i] = $i
            for (i = 3; i <= NF; i++) { x = $i < 0 ? -$i : $i; if (x > most[$1, i]) most[$1, i] = x }
            next }
        { given++
          for (i = 1; i <= NF; i++) {
            off = $i - row[given, i]; if (off < 0) off = -off
            allowed = 1e-10 * (i == 2 ? 1 : most[row[given, 1], i])
            same = i == 1 || index(words, ":" i ":") > 0 ? $i == row[given, i] : off <= allowed
            if (!same && wrong++ < 20)
                print truth ": row " given ", " row[given, 1] ", " name[i] ": " $i " where " row[given, i] " is true" } }
        END { if (given != rows) { print truth ": " given + 0 " rows, not " rows; wrong++ }
            exit wrong > 0 }' "$1" "$2"
}
status=0
compare "$folder/events.tsv" "$1" :3:4: || status=1
compare "$folder/values.tsv" "$2" : || status=1
exit $status
