# Debian packages from the archive that make dist writes: lintian has no error and no warning, flags harden all, no file
# has a path of its own for libraries, and the programs and the library work where they are installed.
for need in dpkg-buildpackage dh lintian blhc hardening-check; do
    command -v "$need" > /dev/null || { echo "no $need"; exit 77; }
done
git -C "$SRC" rev-parse --git-dir > /dev/null 2>&1 || { echo "not a clone"; exit 77; }
version=$(sed -n 's/^.define SS_VERSION "\(.*\)"/\1/p' "$SRC/include/stickslip/status.h")
clean() { env -i PATH="$PATH" HOME="$PWD" LC_ALL=C "$@"; }       # nothing that the tests were called with
clean "$MAKE" -s -C "$SRC" dist BUILD="$PWD"
mv "libstickslip-$version.tar.gz" "libstickslip_$version.orig.tar.gz"
tar xzf "libstickslip_$version.orig.tar.gz"
(cd "libstickslip-$version" &&
    clean DEB_BUILD_OPTIONS="nocheck parallel=$(getconf _NPROCESSORS_ONLN)" dpkg-buildpackage -us -uc) > build.log 2>&1 || { tail -20 build.log; exit 1; }
lintian --fail-on error,warning --allow-root ./*.changes > lintian.log 2>&1 || cat lintian.log
blhc build.log
ls ./*.deb | sed "s/_.*//; s|./||" | sort
for deb in ./*.deb; do
    case $deb in *dbgsym*) continue ;; esac
    dpkg -x "$deb" all
done
find all -type f | while read -r file; do
    ! readelf -d "$file" 2> /dev/null | grep -E 'R(UN)?PATH' || echo "in $file"
    # Debian 12's C library has no control flow to be found
    ! readelf -h "$file" 2> /dev/null | grep -q DYN || hardening-check --nocfprotection -q "$file" || echo "in $file"
done
# What autopkgtest runs, with the packages unpacked only: AUTOPKGTEST=1 installs them on this machine for it.
if [ "${AUTOPKGTEST-}" = 1 ]; then
    clean autopkgtest ./*.deb "./libstickslip-$version/" -- null > test.log 2>&1 || { tail -40 test.log; exit 1; }
fi
multiarch=$(dpkg-architecture -q DEB_HOST_MULTIARCH)
clean PATH="$PWD/all/usr/bin:$PATH" LD_LIBRARY_PATH="$PWD/all/usr/lib/$multiarch" \
    sh "libstickslip-$version/debian/tests/tools"
