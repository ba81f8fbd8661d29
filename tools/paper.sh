#!/bin/sh
# paper.sh: the paper's figures, the HDF5 files behind them and a table of what they show, into $OUT.
#
# Figures 2, 3, 5 and 6 are simulated, as in the paper; figures 1 and 7, measured there, are
# simulated here and say so, unless MEASURED=FILE names a recording for figure 7 (and COLUMN=NAME
# its column, FROM=S and TO=S the span drawn).
set -eu
: "${OUT:=build/paper}" "${MEASURED:=}" "${COLUMN:=}" "${FROM:=}" "${TO:=}"
mkdir -p "$OUT"

draw() {        # NAME TOOL ...: a picture, on the screen and on paper
    picture=$OUT/$1
    shift
    "$@" -o "$picture.png"
    "$@" -o "$picture.pdf"
}

contours() {    # NAME TITLE COLUMN [OPTION ...]: the contours, and what was read from them over these
    name=$1 title=$2 column=$3
    shift 3
    ss-features ${column:+--column "$column"} -o "$OUT/$name-features.tsv" "$OUT/$name.h5"
    draw "$name" ss-contour --span 80 --title "$title" "$@" "$OUT/$name.h5"
    draw "$name-features" ss-contour --span 80 --title "$title" --features "$OUT/$name-features.tsv" "$@" \
        "$OUT/$name.h5"
}

figure() {      # NAME SCENE TITLE: contours on the fine grid, and on the paper's
    ss-sim "$2" | ss-morlet -o "$OUT/$1.h5"
    ss-morlet --dyadic "$OUT/$1.h5" -o "$OUT/$1-dyadic.h5"
    contours "$1" "$3" ''
    draw "$1-dyadic" ss-contour --span 80 --title "$3, dyadic" "$OUT/$1-dyadic.h5"
    draw "loop-$2" ss-plot --xy x,f --title "$3" "$OUT/$1.h5"
}

# first, since only a recording can be wrong
if [ -n "$MEASURED" ]; then
    ss-cat ${FROM:+--from "$FROM"} ${TO:+--to "$TO"} "$MEASURED" |
        ss-morlet ${COLUMN:+--column "$COLUMN"} --detrend mean -o "$OUT/figure7.h5"
    contours figure7 "Measured${COLUMN:+: $COLUMN}" "$COLUMN"
else
    ss-sim compliant-light | ss-noise --snr 40 | ss-morlet -o "$OUT/figure7.h5"
    contours figure7 'Simulated, not measured: c = 25, 40 dB noise' ''
fi

figure figure2 coulomb 'Coulomb, simulated'
figure figure3 state-variable 'State-variable, simulated'
figure figure5 compliant-heavy 'Compliant, c = 80 N s/m, simulated'
figure figure6 compliant-light 'Compliant, c = 25 N s/m, simulated'
draw figure1 ss-plot --title 'Compliant, c = 25 N s/m, simulated' "$OUT/figure6.h5"

for n in 2 3 5 6 7; do
    set -- "$@" "$OUT/figure$n.h5"
done
paper-table "$@" > "$OUT/table.txt"
grep -v '^    ' "$OUT/table.txt"
echo
echo "Each of them: $OUT/table.txt.  The figures: $OUT/*.png, *.pdf."
