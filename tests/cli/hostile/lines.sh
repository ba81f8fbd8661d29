# Lines without an end, and rows without: refused in little memory, long before the input ends.
# shellcheck disable=SC3045  # where there is no such limit, there is none
limit() { [ -n "$SAN" ] || ulimit -v 200000 2> /dev/null || true; "$@"; }   # sanitizers map more
gigabyte() { "$@"; head -c 1000000000 /dev/zero | tr '\0' 1; }
refused() { limit "$@" > /dev/null || echo $?; }
gigabyte true | refused ss-cat
gigabyte printf '# stickslip signal 1\n# note: ' | refused ss-cat
gigabyte printf '# stickslip signal 1\n# rate: 1\n# columns: t/s x\n0\t' | refused ss-morlet
gigabyte printf 't;x\n0;1\n' | refused ss-plot
gigabyte printf '# stickslip coefficients 1\n# note: ' | refused ss-contour
gigabyte printf 'model = ' | refused ss-sim -
ss-sim --events coulomb > events.tsv
ss-signal sine | ss-morlet -o c.tsv
{ head -n 1 events.tsv; gigabyte true; } | refused ss-contour --events - c.tsv

million() {
    awk -v first="$1" -v cell="$2" 'BEGIN {
        printf "%s", first; for (i = 0; i < 1e6; i++) printf "%s%d", cell, i; print "" }'
}
million 't' ';x' | refused ss-cat
million 0 ';' | refused ss-cat
{ printf '# stickslip signal 1\n# rate: 1\n'; million '# columns: t/s' ' x'; } | refused ss-cat
{ printf '# stickslip signal 1\n# rate: 1\n# columns: t/s x\n'; million 0 '	'; } | refused ss-noise --rms 1
# Thousands of columns are no matter.
awk 'BEGIN {
    printf "t"; for (i = 0; i < 9999; i++) printf ";a%d", i; print ";z"
    for (t = 0; t < 2; t++) { printf "%d", t; for (i = 0; i < 1e4; i++) printf ";%d", i; print "" }
}' > wide.csv
ss-cat --column z wide.csv | tail -n 1

# A million comments and notes.
{ echo '# stickslip signal 1'; awk 'BEGIN { for (i = 0; i < 1e6; i++) print "# comment" }'
  printf '# rate: 1\n# columns: x\n1\n'; } | limit ss-cat | tail -n 1
awk 'BEGIN { print "# stickslip signal 1"; for (i = 0; i < 1e6; i++) print "# k" i ": v" }' |
    refused ss-cat
