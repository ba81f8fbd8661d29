# The example program compiles against an installed copy, with pkg-config, shared and static, and
# works.
"$MAKE" -s -C "$SRC" BUILD="$BUILD" PREFIX="$PWD/usr" install > log 2>&1 || cat log
PKG_CONFIG_PATH=$PWD/usr/lib/pkgconfig
export PKG_CONFIG_PATH
check() {
    mkdir "$1"
    cd "$1"
    ../"$1-example"
    test -s contour.h5 && test -s contour.gp
    if command -v gnuplot > /dev/null; then
        gnuplot -e 'set terminal pngcairo; set output "contour.png"' contour.gp 2> log || cat log
        test -s contour.png
    fi
    cd ..
}

# shellcheck disable=SC2046  # flags are a list
$CCLD -o shared-example "$SRC/tests/examples/contour.c" $(pkg-config --cflags --libs stickslip gsl)
LD_LIBRARY_PATH=$PWD/usr/lib DYLD_LIBRARY_PATH=$PWD/usr/lib
export LD_LIBRARY_PATH DYLD_LIBRARY_PATH
check shared
unset LD_LIBRARY_PATH DYLD_LIBRARY_PATH

rm usr/lib/libstickslip.*[!a]
# shellcheck disable=SC2046  # flags are a list
$CCLD -o static-example "$SRC/tests/examples/contour.c" $(pkg-config --static --cflags --libs stickslip gsl)
check static
