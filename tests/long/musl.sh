# ss-sim as one file that needs nothing: linked statically with musl, and with GSL and FFTW built for it, which Debian
# has no package of: MUSL=PREFIX names where they are.  Times of its events are those of ss-sim to 1e-13.
command -v musl-gcc > /dev/null || { echo "no musl-gcc"; exit 77; }
[ -e "${MUSL-}/lib/libfftw3.a" ] || { echo "no GSL and FFTW for musl: MUSL=PREFIX names them"; exit 77; }
git -C "$SRC" rev-parse --git-dir > /dev/null 2>&1 || { echo "not a clone"; exit 77; }
version=$(sed -n 's/^.define SS_VERSION "\(.*\)"/\1/p' "$SRC/include/stickslip/status.h")
git -C "$SRC" archive --prefix=tree/ HEAD | tar x
mkdir include
cp /usr/include/fftw3.h include         # declarations only
libraries="-L$MUSL/lib -lgsl -lgslcblas -lfftw3 -lm"
env -i PATH="$PATH" HOME="$PWD" "$MAKE" -s -o needs -C tree BUILD=build CC=musl-gcc CFLAGS=-O1 LDFLAGS=-static \
    LIBS="$libraries" NUMERICS="$libraries" INCLUDES="-I$MUSL/include -I$PWD/include $INCLUDES" \
    -o "build/libstickslip.so.$version" build/bin/ss-sim
! readelf -d tree/build/bin/ss-sim | grep NEEDED
for scene in coulomb compliant-light; do
    tree/build/bin/ss-sim "$scene" --events | grep -v '^#' > musl.tsv
    ss-sim "$scene" --events | grep -v '^#' | paste musl.tsv - |
        awk -F '\t' 'NR > 1 && ($2 != $7 || ($1 - $6) ^ 2 > 1e-26) { print; n++ } END { exit n > 0 || NR < 20 }' ||
        echo "events of $scene"
done
