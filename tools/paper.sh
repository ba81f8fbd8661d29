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
    name=$1
    shift
    "$@" -o "$OUT/$name.png"
    "$@" -o "$OUT/$name.pdf"
}

figure() {      # NAME SCENE TITLE: contours on the fine grid, and on the paper's
    ss-sim "$2" | ss-morlet -o "$OUT/$1.h5"
    ss-morlet --dyadic "$OUT/$1.h5" -o "$OUT/$1-dyadic.h5"
    draw "$1" ss-contour --title "$3" "$OUT/$1.h5"
    draw "$1-dyadic" ss-contour --title "$3, dyadic" "$OUT/$1-dyadic.h5"
    draw "loop-$2" ss-plot --xy x,f --title "$3" "$OUT/$1.h5"
}

# first, since only a recording can be wrong
if [ -n "$MEASURED" ]; then
    ss-morlet ${COLUMN:+--column "$COLUMN"} --detrend mean "$MEASURED" -o "$OUT/figure7.h5"
    draw figure7 ss-contour --title "Measured${COLUMN:+: $COLUMN}" ${FROM:+--from "$FROM"} \
        ${TO:+--to "$TO"} "$OUT/figure7.h5"
else
    ss-sim compliant-light | ss-noise --snr 40 | ss-morlet -o "$OUT/figure7.h5"
    draw figure7 ss-contour --title 'Simulated, not measured: c = 25, 40 dB noise' \
        "$OUT/figure7.h5"
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
