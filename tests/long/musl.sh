# The library with musl, another C library, in static programs without HDF5: ss-sim, which needs no file then and whose
# times of events are those of ss-sim to 1e-13, and the tests of numbers, signals, scenes and motion.  GSL, FFTW and CMocka,
# which Debian has no package of, are built from its sources, in the folder MUSL if they shall stay.
command -v musl-gcc > /dev/null || { echo "no musl-gcc"; exit 77; }
git -C "$SRC" rev-parse --git-dir > /dev/null 2>&1 || { echo "not a clone"; exit 77; }
tests='test_number test_least test_signal test_signal_forms test_signal_tables test_filter test_waves test_scene test_models
    test_bernstein test_sim test_taylor test_catalogue test_rate_and_state'
musl=${MUSL:-$PWD/musl}
make() { env -i PATH="$PATH" HOME="$PWD" "$MAKE" -s -j "$(getconf _NPROCESSORS_ONLN)" "$@"; }
if ! [ -e "$musl/lib/libgsl.a" ]; then
    mkdir -p lists/partial "$musl/lib" "$musl/include"
    release=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
    echo "deb-src http://deb.debian.org/debian $release main" > sources.list
    from="-q -o Dir::Etc::SourceList=$PWD/sources.list -o Dir::Etc::SourceParts=- -o Dir::State::Lists=$PWD/lists"
    # shellcheck disable=SC2086  # a list
    { apt-get $from update && apt-get $from source --download-only cmocka fftw3 gsl; } > log 2>&1 ||
        { echo "no sources of GSL, FFTW and CMocka: $(tail -n 1 log)"; exit 77; }
    for archive in *.orig.tar.?z; do tar xf "$archive"; done
    (cd cmocka*/ && musl-gcc -O1 -DHAVE_SIGNAL_H -DHAVE_GCC_THREAD_LOCAL_STORAGE -Iinclude -c src/cmocka.c &&
        ar rcs "$musl/lib/libcmocka.a" cmocka.o && cp include/cmocka.h "$musl/include")
    for library in fftw*/ gsl*/; do
        (cd "$library" && env -i PATH="$PATH" ./configure CC=musl-gcc CFLAGS=-O1 --prefix="$musl" --disable-shared &&
            sed -i '/^SUBDIRS/s/ doc$//' Makefile &&        # which Debian leaves out of GSL
            make all && make install) > log 2>&1 || { tail log; exit 1; }
    done
fi
version=$(sed -n 's/^.define SS_VERSION "\(.*\)"/\1/p' "$SRC/include/stickslip/status.h")
git -C "$SRC" archive --prefix=tree/ HEAD | tar x
libraries="-L$musl/lib -lgsl -lgslcblas -lfftw3 -lm"
programs=$(printf 'build/tests/%s ' $tests)
# shellcheck disable=SC2086  # a list
make -C tree -o needs -o "build/libstickslip.so.$version" CC=musl-gcc CFLAGS=-O1 LDFLAGS=-static LIBS="$libraries" \
    NUMERICS="$libraries" CMOCKA_LIBS=-lcmocka INCLUDES="-isystem $musl/include $INCLUDES" \
    --eval="$programs: build/tools/hdf5.o" build/bin/ss-sim $programs
cd tree/build
! readelf -d bin/ss-sim | grep NEEDED
for test in $tests; do
    CMOCKA_MESSAGE_OUTPUT=TAP "tests/$test" > log 2>&1 < /dev/null || { echo "$test"; grep -A 3 '^not ok' log || tail -n 3 log; }
done
for scene in coulomb compliant-light; do
    bin/ss-sim "$scene" --events | grep -v '^#' > musl.tsv
    ss-sim "$scene" --events | grep -v '^#' | paste musl.tsv - |
        awk -F '\t' 'NR > 1 && ($2 != $7 || ($1 - $6) ^ 2 > 1e-26) { print; n++ } END { exit n > 0 || NR < 20 }' ||
        echo "events of $scene"
done
