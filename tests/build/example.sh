# The example programs compile against an installed copy, with pkg-config, shared and static, and
# work.
"$MAKE" -s -C "$SRC" BUILD="$BUILD" PREFIX="$PWD/usr" install > log 2>&1 || cat log
PKG_CONFIG_PATH=$PWD/usr/lib/pkgconfig
export PKG_CONFIG_PATH
printf 't,force (N)\n' > run.csv
# A burst, so that there is one largest |W| and not a row of equals.
awk 'BEGIN { for (i = 0; i < 4000; i++) print i / 1000 "," 3 + exp(-((i - 2000) / 200)^2) * sin(6.283185307179586 * i / 25) }' >> run.csv
{ echo 't,accel (m/s^2)'; ss-sim -c t,a compliant-heavy | ss-noise --snr 40 | grep -v '^#' | tr '\t' ','; } > accel.csv

build() {       # shared|static [FLAG]: all examples, in a directory of this name
    mkdir "$1"
    for source in "$SRC"/tests/examples/*.c; do
        # shellcheck disable=SC2046,SC2086  # flags are a list
        $CCLD -o "$1/$(basename "$source" .c)" "$source" $(pkg-config $2 --cflags --libs stickslip gsl) -lpthread -lm
    done
}
run() {
    echo "-- $1"
    cd "$1"
    ./contour
    test -s contour.h5 && test -s contour.gp
    if command -v gnuplot > /dev/null; then
        gnuplot -e 'set terminal pngcairo; set output "contour.png"' contour.gp 2> log || cat log
        test -s contour.png
    fi
    ./simulate
    ./recording ../run.csv force
    ./plan
    ./stiffness ../accel.csv accel 2.42 2310
    ./stiffness ../run.csv force 2.42 2310
    cd ..
}

build shared ''
LD_LIBRARY_PATH=$PWD/usr/lib DYLD_LIBRARY_PATH=$PWD/usr/lib
export LD_LIBRARY_PATH DYLD_LIBRARY_PATH
run shared
unset LD_LIBRARY_PATH DYLD_LIBRARY_PATH

rm usr/lib/libstickslip.*[!a]
build static --static
run static
