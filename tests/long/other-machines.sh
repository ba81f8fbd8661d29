# The library on other kinds of machines: built by Debian's cross compilers for arm64 and for a big-endian one (s390x),
# those of the two whose compiler is here, with packages of these in a folder of their own, and the tests of numbers,
# signals, files, scenes and motion run by qemu, those that take a second here as it takes half a minute there; then files
# are written there and read here, and the other way round.
command -v mmdebstrap > /dev/null || { echo "no mmdebstrap"; exit 77; }
git -C "$SRC" rev-parse --git-dir > /dev/null 2>&1 || { echo "not a clone"; exit 77; }
tests='test_number test_least test_signal_forms test_signal_tables test_filter test_store_foreign test_coefficients
    test_scene test_bernstein test_catalogue test_rate_and_state'
files='au-libsndfile au-sizes au-sox hdf5-octave-h5dump hdf5-others hdf5-times npy wav wav-sox wav-written'
git -C "$SRC" archive --prefix=tree/ HEAD | tar x

# The packages of a machine, without running any of their programs.  Links from the root of the folder become
# relative ones.
packages() {    # ARCHITECTURE
    mmdebstrap --variant=extract --architectures="$1" \
        --include=libc6-dev,libgsl-dev,libfftw3-dev,libhdf5-dev,libcmocka-dev bookworm "$1" > "$1.log" 2>&1 ||
        { echo "no packages for $1: $(tail -n 1 "$1.log")"; exit 77; }
    find "$1" -type l -lname '/*' | while read -r link; do
        ! [ -e "$1$(readlink "$link")" ] || ln -sfr "$1$(readlink "$link")" "$link"
    done
}

awk 'BEGIN { print "t_s,x_mm,f_N"; for (i = 0; i < 3000; i++) printf "%.3f,%.17g,%.17g\n", i / 1000, 2e4 * sin(i), exp(-i / 5) }' \
    > run.csv
checked=0
check() {       # ARCHITECTURE TRIPLE EMULATOR
    if ! command -v "$2-gcc" > /dev/null || ! command -v "$3" > /dev/null; then return; fi
    checked=1
    packages "$1"
    root=$PWD/$1
    # shellcheck disable=SC2046,SC2086  # lists of names
    env -i PATH="$PATH" HOME="$PWD" PKG_CONFIG_SYSROOT_DIR="$root" \
        PKG_CONFIG_LIBDIR="$root/usr/lib/$2/pkgconfig:$root/usr/share/pkgconfig" \
        "$MAKE" -s -j "$(getconf _NPROCESSORS_ONLN)" -C tree BUILD="build-$1" INSTALL_DEPS=0 \
        CC="$2-gcc --sysroot=$root" AR="$2-ar" all $(printf "build-$1/tests/%s " $tests)
    for test in $tests; do
        (cd tree && CMOCKA_MESSAGE_OUTPUT=TAP "$3" -L "$root" "build-$1/tests/$test" > ../log 2>&1 < /dev/null) ||
            { echo "$1: $test"; grep -A 3 '^not ok' log || tail -n 3 log; }
    done
    mkdir -p "theirs-$1/bin"
    for tool in tree/build-"$1"/bin/ss-*; do
        [ "${tool##*/}" != ss-report ] || continue      # a script
        printf '#!/bin/sh\nexec %s -L "%s" "%s" "$@"\n' "$3" "$root" "$PWD/$tool" > "theirs-$1/bin/${tool##*/}"
    done
    chmod +x "theirs-$1"/bin/*
    # shellcheck disable=SC2086  # a list of names
    env BUILD="$PWD/theirs-$1" LONG= JOBS=1 TMPDIR="$PWD" ONLY="$(printf 'cli/formats/%s ' $files)" sh "$SRC/tests/run.sh" > log 2>&1 ||
        sed -n '/^---/,$p' log
    # The same bytes of a file; of HDF5, whose library keeps a number of its own in the machine's order, the same signal.
    here() { PATH="$BUILD/bin:$PATH" "$@"; }
    there() { PATH="$PWD/theirs-$architecture/bin:$PATH" "$@"; }
    architecture=$1
    for form in tsv csv json au wav h5; do
        here ss-cat run.csv -o "here.$form"
        there ss-cat run.csv -o "there.$form"
        [ $form = h5 ] || cmp "here.$form" "there.$form"
        [ $form = json ] || { here ss-cat "there.$form" > one; there ss-cat "here.$form" | cmp one -; }
    done
    here ss-morlet -c x_mm here.h5 -o map.h5
    here ss-contour map.h5 -o here.gp
    there ss-contour map.h5 | cmp here.gp -
    cd tree
    # their compilers multiply and add in one step: times of events to 1e-13 of the record, not to the last digit
    for scene in coulomb compliant-light; do
        "$3" -L "$root" "build-$1/bin/ss-sim" "$scene" --events | grep -v '^#' > theirs
        PATH="$BUILD/bin:$PATH" ss-sim "$scene" --events | grep -v '^#' | paste theirs - |
            awk -F '\t' 'NR > 1 && ($2 != $7 || ($1 - $6) ^ 2 > 1e-26) { print; n++ } END { exit n > 0 || NR < 20 }' ||
            echo "$1: events of $scene"
    done
    cd ..
}
check arm64 aarch64-linux-gnu qemu-aarch64-static
check s390x s390x-linux-gnu qemu-s390x-static
[ $checked = 1 ] || { echo "no cross compiler with its qemu"; exit 77; }
