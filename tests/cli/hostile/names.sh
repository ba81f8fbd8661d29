# Files, scenes and columns whose names hold rows, settings and what drives a terminal: outputs show them in
# one line, in which nothing is a row, a key or a command.
name=$(printf 'x\n77\t1\t2\nmass = 1\n\033[2J')
cp "$SRC/data/scenes/compliant-light.scene" "$name.scene"
ss-sim --set duration=5 -c a compliant-light > "$name.tsv"
printf '# stickslip signal 1\n# rate: 100\n# note: \033[2J \302\2332J\n# columns: a\033[2J/\302\233m\n' > columns.tsv
ss-signal noise --rate 100 --duration 1 | grep -v '^#' | cut -f 2 >> columns.tsv

# No line but those of the tool itself: what is neither a note nor a row of as many cells as the last.
check() {
    "$@" > out
    if LC_ALL=C grep -n "$(printf '\033\\|\302\233')" out; then echo "$1: a command"; fi
    if grep -n '^mass = 1$\|^77	1	2' out; then echo "$1: a row or a key"; fi
}
check ss-sim "$name.scene"
check ss-sim --events "$name.scene"
check ss-sim --list "$name.scene"
check ss-sweep --vary mass=1:2:2 "$name.scene"
check ss-trade --models "$name.scene"
check ss-trade --budget 0.01 "$name.tsv"
check ss-rank "$name.tsv" "$name.scene"
check ss-rank --fit "$name.tsv"
check ss-features "$name.tsv"
check ss-features --summary "$name.tsv"
for tool in ss-cat 'ss-cat --format csv' ss-plot 'ss-noise --rms 1' ss-features ss-morlet; do
    # shellcheck disable=SC2086  # a tool and its options
    check $tool columns.tsv
done
ss-sim -o out.h5 "$name.scene"
check ss-cat out.h5
