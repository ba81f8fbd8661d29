# Stopped at a call of its own that writes, each tool leaves the file that was there or a whole new one,
# and nothing beside it unless it was killed.  TRIES times each; tests/long tries harder, half by HALF.
. "$SRC/tests/stop/stop.sh"
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
# shellcheck disable=SC3045
ulimit -c 0 2> /dev/null || true
mkdir whole work
ss-sim --set duration=20 coulomb > run
ss-cat --to 5 run > short
ss-morlet short > coefficients
ss-cat --to 1 run | ss-morlet --dyadic > few
ss-sim --set settle=2 --set duration=1 compliant-light > sticks

# make_ FILE COMMAND ...: have it made by a tool that the command runs.
make_() {
    file=$1
    shift
    case $file in
    sim.*)       "$@" ss-sim --set duration=20 --tol 1e-13 -o "$file" coulomb ;;
    cat.au)      "$@" ss-cat -o cat.au ../run ;;
    noise.tsv)   "$@" ss-noise --rms 1 -o noise.tsv ../run ;;
    signal.h5)   "$@" ss-signal noise --duration 100 -o signal.h5 ;;
    morlet.*)    "$@" ss-morlet -o "$file" ../short ;;
    stream.h5)   "$@" ss-morlet --stream --fmin 5 -o stream.h5 ../run ;;
    plot.svg)    "$@" ss-plot -o plot.svg ../run ;;
    contour.*)   "$@" ss-contour -o "$file" ../coefficients ;;
    inverse.au)  "$@" ss-morlet --inverse -o inverse.au ../few ;;
    features.*)  "$@" ss-features -o "$file" ../short ;;
    sweep.tsv)   "$@" ss-sweep -m amplitude --vary mass=2:3:40 --vary friction=1:2:40 -o sweep.tsv coulomb ;;
    fit.scene)   "$@" ss-rank -q --fit -o fit.scene ../sticks ;;
    map.svg)     "$@" ss-plot --map mass,friction,amplitude -o map.svg ../sweep ;;
    esac
}
ss-sweep -m amplitude --vary mass=2:3:9 --vary friction=1:2:9 coulomb > sweep
one='sim.tsv sim.au sim.h5 cat.au noise.tsv signal.h5 morlet.tsv morlet.h5 stream.h5'
two='plot.svg contour.png contour.gp inverse.au features.tsv sweep.tsv fit.scene map.svg'
case ${HALF:-} in 1) all=$one ;; 2) all=$two ;; *) all="$one $two" ;; esac
cd work

number=0
for made in $all; do
    calls=$(make_ "$made" calls_of)
    mv "$made" ../whole
    for try in $(seq "${TRIES:-2}"); do
        number=$((number + 1))
        moment=$((1 + calls * (2 * try - 1) / (2 * ${TRIES:-2})))
        case $((number % 5)) in 0) signal=9 ;; 1) signal=2 ;; 2) signal=15 ;; 3) signal=1 ;; 4) signal=3 ;; esac
        [ $((try % 2)) = 0 ] || echo old > "$made"
        (make_ "$made" stopped $moment $signal) > ../words 2>&1 || true
        [ $signal != 9 ] || rm -f ."$made".*
        if [ ! -e "$made" ]; then
            [ $((try % 2)) = 0 ] || echo "$made, $signal at call $moment: what was there is gone"
        elif ! echo old | cmp -s - "$made" && ! cmp -s "$made" ../whole/"$made"; then
            echo "$made, $signal at call $moment: a part of it"
        fi
        rm -f "$made"
        ls -A | sed "s/^/$made, $signal at call $moment: left /"
        rm -rf ../work/.[!.]*
    done
    echo "$made: $(hits) of ${TRIES:-2} hit at work"
done
