# Other releases of Debian, with their compilers and libraries, in a folder of their own: each compiler says nothing, and the
# tests of numbers, signals, files, scenes and motion pass.
command -v mmdebstrap > /dev/null || { echo "no mmdebstrap"; exit 77; }
[ "$(id -u)" = 0 ] || { echo "not root, who alone may change the root"; exit 77; }
git -C "$SRC" rev-parse --git-dir > /dev/null 2>&1 || { echo "not a clone"; exit 77; }
tests='test_number test_least test_signal_forms test_signal_tables test_filter test_store test_coefficients test_scene
    test_bernstein test_sim test_taylor test_catalogue test_rate_and_state'
check() {       # RELEASE, COMPILERS
    root=$1
    shift
    mmdebstrap --variant=apt --include="$(echo "$*" | tr ' ' ,),make,pkgconf,libc6-dev,libgsl-dev,libfftw3-dev,libhdf5-dev,libcmocka-dev" \
        "$root" "$root" http://deb.debian.org/debian > log 2>&1 || { echo "no packages of $root: $(tail -n 1 log)"; exit 77; }
    git -C "$SRC" archive --prefix="$root/tree/" HEAD | tar x
    for cc; do
        # shellcheck disable=SC2046,SC2086  # lists of names
        chroot "$root" env -i PATH=/usr/bin:/bin make -s -C /tree -j "$(getconf _NPROCESSORS_ONLN)" INSTALL_DEPS=0 CC="$cc" \
            CFLAGS='-O2 -Werror' BUILD="build-$cc" all $(printf "build-$cc/tests/%s " $tests)
        for test in $tests; do
            chroot "$root" env -i PATH=/usr/bin:/bin CMOCKA_MESSAGE_OUTPUT=TAP sh -c "cd /tree && build-$cc/tests/$test" > log 2>&1 < /dev/null ||
                { echo "$cc: $test"; grep -A 3 '^not ok' log || tail -n 3 log; }
        done
    done
}
check bullseye gcc-10
check trixie gcc-13 gcc-14
