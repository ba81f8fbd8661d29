# The tests of readers, writers and memory, and each tool on little, under valgrind's memcheck.
command -v valgrind > /dev/null || { echo "no valgrind"; exit 77; }
[ -z "$SAN" ] || { echo "sanitizers and valgrind exclude each other"; exit 77; }
check() {
    valgrind -q --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=definite,indirect \
        "$@" > out 2> log || { echo "$*" | sed "s|$BUILD/||"; sed "s|$SRC/||g; s|$BUILD/||g" log; }
}
for test in scene signal store plot features threads; do check "$BUILD/tests/test_$test"; done
check ss-sim --set duration=0.1 --set settle=0 -o run.tsv compliant-light
check ss-sim --set duration=0.1 --events -o events.tsv compliant-light
check ss-cat -o run.h5 run.tsv
check ss-cat --format au run.h5
check ss-noise --snr 20 run.tsv
check ss-signal chirp --duration 0.1
check ss-morlet --voices 2 --threads 2 -o c.h5 run.tsv
check ss-contour --events events.tsv c.h5
check ss-plot run.h5
check ss-morlet --stream --octaves -7:-6 -o stream.tsv run.tsv
check ss-morlet --inverse --accuracy 1e-2 -o inverse.tsv c.h5
check ss-morlet --voices 1 --method fft -o measured.tsv run.tsv
check ss-features -o features.tsv run.tsv
check ss-contour --features features.tsv c.h5
check ss-sweep --threads 2 -m stops,amplitude --vary mass=2:3:2 --vary friction=1:2:2 -o sweep.tsv coulomb
check ss-plot --map mass,friction,amplitude sweep.tsv
