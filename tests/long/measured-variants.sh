# Parts of each measured recording, every second sample of it, another scale and more noise may change what
# is known of the slips, but bring no number where there is none, and no other ringing or repetition.
data=$SRC/../shared/data/measured
[ -d "$data" ] || { echo "no measured recordings"; exit 77; }

part() {        # FROM: half of the samples, from so many quarters on
    awk -v from="$1" '/^#/ { head = head $0 "\n"; next } { row[n++] = $0 }
        END { first = int(from * n / 4); split(row[first], at)
            sub(/# start: [^\n]*/, "# start: " at[1], head); printf "%s", head
            for (i = first; i < first + int(n / 2); i++) print row[i] }' whole
}
variant() {
    case $1 in
    whole) cat whole;;
    first) part 0;;
    middle) part 1;;
    last) part 2;;
    second) awk '/^# rate/ { $3 /= 2 } /^#/ || n++ % 2 == 0' whole;;
    scaled) ss-cat --scale 137.5 whole;;
    noisy) ss-noise --snr 40 whole;;
    esac
}
# What is known against what is said: a line for each wrong number, and the count of the right ones.
judge() {       # FILE COLUMN VARIANT
    awk -F '\t' -v file="$1" -v column="$2" -v variant="$3" '
        FNR == NR { if ($1 == file && $2 == column) { low[$3] = $4; high[$3] = $5 } next }
        /^# [a-z_]+: / { split($0, w, " "); key = substr(w[2], 1, length(w[2]) - 1) }
        /^# [a-z_]+: / && key in low && key != "slips" && w[3] != "-" {
            slack = w[4] == "-" ? 0 : 3 * w[4]
            if (low[key] == "-" || (key != "slip_rate" && (w[3] < low[key] - slack || w[3] > high[key] + slack)))
                print "wrong:", variant, file, column, key, w[3], w[4]
            else
                print "right" > "/dev/stderr"
        }' "$data/truth.tsv" found
}
: > right
cut -f 1,2 "$data/truth.tsv" | sed 1d | uniq | while IFS="$(printf '\t')" read -r file column; do
    ss-cat -q --column "$column" "$data/$file" > whole
    for v in whole first middle last second scaled noisy; do
        variant $v | ss-features -q > found
        judge "$file" "$column" $v 2>> right
    done
done
n=$(wc -l < right)
[ "$n" -ge 180 ] && echo "numbers: enough" || echo "numbers: $n"
