# The same input gives the same bytes in every form: twice in a row, with another number of threads,
# in another locale.
ss-sim --set duration=1 compliant-light > run
for l in de_DE.UTF-8 fr_FR.UTF-8 C.UTF-8; do
    if [ "$(LC_ALL=$l awk 'BEGIN { printf "%.1f", 0.5 }')" = 0,5 ]; then comma=$l; fi
done
make_() {
    for form in tsv au h5; do
        ss-sim --set duration=1 -o sim.$form compliant-light
        ss-noise --rms 1e-3 -o noise.$form run
        ss-cat -o cat.$form run
        ss-signal noise --duration 1 -o signal.$form
    done
    ss-sim --events compliant-light > events.tsv
    for grid in --dense --dyadic --voices=5; do
        for form in tsv h5; do ss-morlet $grid --threads "$1" -o morlet$grid.$form run; done
    done
    ss-morlet --method fft --threads "$1" -o fft.tsv run
    ss-morlet --stream --octaves -7:-5 --threads "$1" run > stream.tsv
    ss-morlet --inverse -o inverse.tsv morlet--voices=5.tsv
    ss-features --threads "$1" -o features.tsv run
    ss-sweep -m stops,amplitude --vary mass=2:3:7 --vary friction=1:2:7 --threads "$1" -o sweep.tsv coulomb
    ss-plot --map mass,friction,stops -o map.gp sweep.tsv
    ss-contour --features features.tsv -o features.gp morlet--voices=5.tsv
    ss-rank -q -o rank.tsv run compliant-light coulomb
    ss-contour -o contour.gp morlet--voices=5.tsv
    ss-plot -o plot.gp run
    if command -v gnuplot > /dev/null; then ss-plot -o plot.svg run; fi
}
mkdir once again threads comma
(cd once && ln ../run . && make_ 1)
(cd again && ln ../run . && make_ 1)
(cd threads && ln ../run . && make_ 3)
if [ -n "${comma-}" ]; then (cd comma && ln ../run . && LC_ALL=$comma make_ 1); else cp -R once/. comma; fi
for other in again threads comma; do diff -r once $other; done
