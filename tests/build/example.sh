# The example programs compile against an installed copy by the line that the README gives, shared and
# static, and work; so does one in C++.
# From a copy: another PREFIX makes tools again, which other tests run meanwhile.
mkdir tree
cp -a "$BUILD"/src "$BUILD"/tools "$BUILD"/bin "$BUILD"/flags "$BUILD"/libdir "$BUILD"/*.* tree
"$MAKE" -s -C "$SRC" BUILD="$PWD/tree" PREFIX="$PWD/usr" install > log 2>&1 || cat log
PKG_CONFIG_PATH=$PWD/usr/lib/pkgconfig
export PKG_CONFIG_PATH
printf 't,force (N)\n' > run.csv
# A burst, so that there is one largest |W| and not a row of equals.
awk 'BEGIN { for (i = 0; i < 4000; i++) print i / 1000 "," 3 + exp(-((i - 2000) / 200)^2) * sin(6.283185307179586 * i / 25) }' >> run.csv
{ echo 't,accel (m/s^2)'; ss-sim -c t,a compliant-heavy | ss-noise --snr 40 | grep -v '^#' | tr '\t' ','; } > accel.csv

build() {       # NAME [FLAG] [FLAG OF PKG-CONFIG]: all examples, in a directory of this name
    mkdir "$1"
    for source in "$SRC"/tests/examples/*.c; do
        # shellcheck disable=SC2046,SC2086  # flags are a list
        $CCLD ${2-} -o "$1/$(basename "$source" .c)" "$source" $(pkg-config ${3-} --cflags --libs stickslip)
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

build shared
LD_LIBRARY_PATH=$PWD/usr/lib DYLD_LIBRARY_PATH=$PWD/usr/lib
export LD_LIBRARY_PATH DYLD_LIBRARY_PATH
run shared
cat > events.cc <<'C'
#include <cstdio>
#include <stickslip.h>
int main()
{
    ss_scene scene = ss_scene_defaults;
    scene.model = ss_model_named("coulomb");
    std::printf("C++: %zu samples\n", ss_scene_samples(&scene));
}
C
for c in "${CXX:-c++}" g++ clang++ ''; do
    if [ -n "$c" ] && command -v "$c" > /dev/null; then break; fi
done
# shellcheck disable=SC2046,SC2086
if [ -n "$c" ]; then
    $c ${SAN:+-fsanitize=address -fsanitize=undefined} -o events events.cc $(pkg-config --cflags --libs stickslip)
    ./events
else
    echo "C++: 20000 samples"
fi
unset LD_LIBRARY_PATH DYLD_LIBRARY_PATH

rm usr/lib/libstickslip.*[!a]
build static '' --static
run static > static.out
cat static.out

# wholly static, where the compiler and HDF5 can
cat > least.c <<'C'
#include <hdf5.h>
int main(void) { return H5open() < 0; }
C
# shellcheck disable=SC2046,SC2086
if [ -z "$SAN" ] && $CCLD -static $INCLUDES -o least least.c $(pkg-config --static --libs stickslip) 2> log; then
    build all-static -static --static 2> log         # of dlopen, in HDF5
    run all-static > all
    sed 's/^-- static/-- all-static/' static.out | cmp - all
fi
