# The low-pass, high-pass and band-pass of SoX, at the same edges, with the same transitions and stop band.
command -v sox > /dev/null || { echo "no sox"; exit 77; }
ss-signal chirp --rate 8000 --duration 5 --frequency 0 --to 4000 --amplitude .5 --format au > chirp.au
compare() {     # a chirp is at 800 t Hz; both filters may be off by 1e-4 of .5, and SoX by its 32 bits
    awk '!/^#/ { if (FNR == NR) { x[sprintf("%.6f", $1)] = $2; next }
        f = 800 * $1; k = sprintf("%.6f", $1)
        if (!(k in x) || (f > 380 && f < 620) || (f > 780 && f < 1220)) next
        d = x[k] - $2; n++; if (d * d > e) e = d * d } END { print (n > 30000), (sqrt(e) < 2e-4 * .5 + 1e-8) }' "$1" "$2"
}
run() {         # OPTIONS: of ss-filter, then "sox" and the effect
    options=
    while [ "$1" != sox ]; do options="$options $1"; shift; done
    shift
    # shellcheck disable=SC2086
    ss-filter $options chirp.au > ours.tsv
    sox -D -t au chirp.au -t au -e floating-point -b 64 - "$@" 2> /dev/null | ss-cat > theirs.tsv
    compare ours.tsv theirs.tsv
}
run --low-pass 1000 sox sinc -a 80 -t 400 -1000
run --high-pass 500 sox sinc -a 80 -t 200 500
run --high-pass 500 --low-pass 1000 sox sinc -a 86 -t 200 500 sinc -a 86 -t 400 -1000
