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
    rig=$(ss-cat "$OUT/$name.h5" | sed -n -e 's/^# mass: /--mass=/p' -e 's/^# stiffness: /--stiffness=/p')
    # shellcheck disable=SC2086  # two options, or none of a recording
    ss-features ${column:+--column "$column"} $rig -o "$OUT/$name-features.tsv" "$OUT/$name.h5"
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

# NAME WORDS [FREQUENCY STIFFNESS]: what a figure's features say in numbers, beside what the paper says of its own.
# Spikes this much below the strongest do not count [dB].
compare() {
    ss-cat "$OUT/$1.h5" | awk -v range=20 -v name="$1" -v words="$2" -v f="${3:--}" -v k="${4:--}" '
        function cell(form, x) {
            printf(x == "" || x == "-" ? " %10s" : form, x == "" ? "-" : x)
        }
        function row(title, form, paper, key, simulated) {
            printf "  %-22s", title
            cell(form, paper)
            cell(form, found[key "_raw"])
            cell(form, found[key])
            cell(" %10.2g", error[key])
            cell(form, simulated)
            print ""
        }
        FNR == 1 { file++ }
        file == 1 && /^# [a-z_]*: / { true[substr($2, 1, length($2) - 1)] = $3 }
        file == 1 { next }
        /^# spike: / && $5 >= -range { t[n + 0] = $3; level[n++] = $5 }
        /^# [a-z_]*: / { key = substr($2, 1, length($2) - 1); found[key] = $3; error[key] = $4 }
        !/^#/ { rows++; maxima += $4 != "-" }
        END {
            printf "\n%s\n  the paper: %s\n  spikes: %d", name, words, n
            half = true["base_frequency"] > 0 ? 1 / (2 * true["base_frequency"]) : 0
            for (i = 0; i < n && half > 0; i++)
                count[int(t[i] / half)]++
            for (i = 0; half > 0 && i * half < true["duration"]; i++)
                printf "%s %d", i == 0 ? "; in each half-cycle:" : "", count[i]
            printf "%s", (n > 0 ? "\n         t/s  level/dB\n" : "\n")
            for (i = 0; i < n; i++)
                printf "    %8.4f %9.2f\n", t[i], level[i]
            printf "  transitions: %d, with a local maximum %d\n", rows, maxima
            printf "  %-22s %10s %10s %10s %10s %10s\n", "", "paper", "raw", "fitted", "+-", "simulated"
            is_known = "contact_stiffness" in true
            m = true["mass"]
            c = true["contact_damping"]
            all = true["stiffness"] + true["contact_stiffness"]
            row("frequency / Hz", " %10.3f", f, "transition_frequency",
                is_known ? sqrt(all / m - c * c / (4 * m * m)) / (2 * 3.141592653589793) : "")
            row("damping ratio", " %10.5f", "-", "damping_ratio", is_known ? c / (2 * sqrt(all * m)) : "")
            row("total stiffness / N/m", " %10.0f", k, "total_stiffness", is_known ? all : "")
        }' - "$OUT/$1-features.tsv"
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

{
    echo "Spikes are within 20 dB of the strongest.  The features of each figure, FIGURE-features.tsv, have the local maxima."
    compare figure2 'a spike at each onset of sticking; no local maximum'
    compare figure3 'two weaker spikes an interval; no local maximum'
    compare figure5 'local maximum near 45 Hz at each transition, one major spike' 45 193500
    compare figure6 'local maximum near 45 Hz at each transition, grouped spikes' 45 193500
    compare figure7 'local maximum near 45 Hz at each transition, grouped spikes, more besides' 45 193500
} > "$OUT/table.txt"
grep -v '^    ' "$OUT/table.txt"
echo
echo "Each of them: $OUT/table.txt.  The figures: $OUT/*.png, *.pdf."
