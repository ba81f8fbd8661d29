#!/bin/sh
# install-deps.sh [--report] [build] [check] [paper] [others]: install what these need and is missing.
#
# others are programs that tests compare with; without them these tests are skipped.
# A machine that has everything is not touched.  --report, or INSTALL_DEPS=0 in the environment,
# only says what is missing, and exits 1 if anything is; so does a system that is not known here.
set -u
report=${INSTALL_DEPS:-1}
[ "$report" != 0 ] || report=only

# A want is named by what it is, and each system has its own name for the package.
# shellcheck disable=SC2034  # used through eval
{
others='python arb sndfile sox h5dump clang mandoc shellcheck locales zsh'
wants="compiler pkgconfig gsl fftw3 hdf5 cmocka gnuplot $others"
debian='gcc:libc6-dev pkg-config libgsl-dev libfftw3-dev libhdf5-dev libcmocka-dev gnuplot-nox
    python3-numpy:python3-h5py:python3-xarray:python3-h5netcdf libflint-arb-dev|libflint-dev
    sndfile-programs sox hdf5-tools clang:libclang-rt-dev mandoc shellcheck locales zsh'
fedora='gcc pkgconf-pkg-config gsl-devel fftw-devel hdf5-devel libcmocka-devel gnuplot
    python3-numpy:python3-h5py:python3-xarray:python3-h5netcdf flint-devel
    libsndfile-utils sox hdf5 clang:compiler-rt mandoc ShellCheck glibc-locale-source zsh'
arch='gcc pkgconf gsl fftw hdf5 cmocka gnuplot
    python-numpy:python-h5py:python-xarray:python-h5netcdf flint
    libsndfile sox hdf5 clang:compiler-rt mandoc shellcheck glibc zsh'
homebrew='gcc pkgconf gsl fftw hdf5 cmocka gnuplot
    numpy:h5py flint libsndfile sox hdf5 llvm mandoc shellcheck gettext zsh'
unknown='C11-compiler pkg-config GSL FFTW3 HDF5(with-hl) CMocka gnuplot(with-cairo-terminals)
    Python(with-NumPy-h5py-xarray-h5netcdf) FLINT(with-Arb) sndfile-convert
    sox h5dump clang(with-libFuzzer) mandoc shellcheck localedef(with-de_DE) zsh'
}

: "${CC:=cc}" "${PKG_CONFIG:=pkg-config}"
need=
for word; do
    case $word in
    --report) report=only ;;
    build) need="$need compiler pkgconfig gsl fftw3 hdf5" ;;
    check) need="$need cmocka gnuplot" ;;
    paper) need="$need gnuplot" ;;
    others) need="$need $others" ;;
    *) echo "usage: install-deps.sh [--report] [build] [check] [paper] [others]" >&2; exit 2 ;;
    esac
done

# A library need not have a pkg-config file; the compiler finds it then, or Homebrew has it.
have_library() {        # HEADER PKG-CONFIG-NAME ...
    header=$1
    shift
    for name; do
        ! "$PKG_CONFIG" --exists "$name" || return 0
    done
    # shellcheck disable=SC2086  # flags are a list
    printf '#include <%s>\n' "$header" |
        $CC ${CPPFLAGS-} -I"$(brew --prefix 2>/dev/null || echo .)/include" -E -
}

have() {
    case $1 in
    compiler)   echo 'int main(void) { return 0; }' | $CC -x c -fsyntax-only -include stdio.h - ;;
    pkgconfig)  command -v "$PKG_CONFIG" ;;
    hdf5)       have_library hdf5_hl.h hdf5-serial hdf5 ;;
    gnuplot)    GNUTERM=dumb gnuplot -e 'set terminal pngcairo; set terminal pdfcairo' ;;
    python)     for p in python3 /usr/bin/python3; do
                    ! $p -c 'import numpy, h5py, xarray, h5netcdf' || return 0
                done
                false ;;
    arb)        have_library flint/arb.h || have_library arb.h ;;
    sndfile)    command -v sndfile-convert ;;
    clang)      echo 'int LLVMFuzzerTestOneInput(void) { return 0; }' |
                    clang -x c -fsanitize=fuzzer -o /dev/null - ;;
    locales)    locale -a | grep -q -i '^de_DE.utf' ||
                    { command -v localedef && test -e /usr/share/i18n/locales/de_DE; } ;;
    sox | h5dump | mandoc | shellcheck | zsh) command -v "$1" ;;
    *)          "$PKG_CONFIG" --exists "$1" ;;
    esac > /dev/null 2>&1
}

find_missing() {
    missing=
    for want in $need; do
        case " $missing " in *" $want "*) continue ;; esac
        have "$want" || missing="$missing $want"
    done
}

find_system() {
    system=unknown
    # shellcheck source=/dev/null
    like=$( . "${OS_RELEASE:-/etc/os-release}" 2> /dev/null && echo "${ID-} ${ID_LIKE-}")
    case $(uname -s) in Darwin) like=$(command -v brew) && like=homebrew ;; esac
    for word in $like; do
        case $word in
        debian | ubuntu) system=debian ;;
        fedora | rhel)   system=fedora ;;
        arch)            system=arch ;;
        homebrew)        system=homebrew ;;
        *) continue ;;
        esac
        break
    done
}

# The packages of the wants that are missing, by their names on this system.
name_packages() {
    packages=
    eval "names=\$$system"
    # shellcheck disable=SC2086,SC2154  # a list, by eval above
    set -- $names
    for want in $wants; do
        case " $missing " in *" $want "*) packages="$packages $(echo "$1" | tr : ' ')" ;; esac
        shift
    done
}

# Of a package that has a name in one version of the system and another in the next, the one known here.
known() {
    for name; do
        case $name in *'|'*) ! apt-cache show "${name%|*}" > /dev/null 2>&1 || name=${name%|*} ;; esac
        echo "${name#*|}"
    done
}

run_installer() {
    # shellcheck disable=SC2046  # a list
    case $system in
    debian)   as_root apt-get update &&
              as_root env DEBIAN_FRONTEND=noninteractive \
                  apt-get install -y --no-install-recommends $(known "$@") ;;
    fedora)   as_root dnf install -y "$@" ;;
    arch)     as_root pacman -S --needed --noconfirm "$@" ||      # its lists may be old, and
                  as_root pacman -Syu --needed --noconfirm "$@" ;;  # Arch upgrades whole or not
    homebrew) brew install "$@" ;;
    esac
}

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

find_missing
[ -n "$missing" ] || exit 0
find_system
name_packages
if [ "$report" = only ]; then
    echo "missing:$packages (make deps installs what is missing)" >&2
    exit 1
fi
if [ "$system" = unknown ]; then
    echo "missing:$packages; this system is not known here, please install them yourself" >&2
    exit 1
fi
if [ "$system" != homebrew ] && [ "$(id -u)" != 0 ] && ! command -v sudo > /dev/null; then
    echo "missing:$packages; please install them as root (there is no sudo)" >&2
    exit 1
fi
echo "installing:$packages" >&2
# shellcheck disable=SC2086  # a list
run_installer $packages || exit 1
find_missing
[ -z "$missing" ] || { echo "installed, yet still missing:$missing" >&2; exit 1; }
