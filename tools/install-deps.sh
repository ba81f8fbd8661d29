#!/bin/sh
# install-deps.sh [--report] [build] [check] [paper]: install what these need and is missing.
#
# A machine that has everything is not touched.  --report, or INSTALL_DEPS=0 in the environment,
# only says what is missing, and exits 1 if anything is; so does a system that is not known here.
set -u
report=${INSTALL_DEPS:-1}
[ "$report" != 0 ] || report=only

# A want is named by what it is, and each system has its own name for the package.
# shellcheck disable=SC2034  # used through eval
{
wants='compiler pkgconfig gsl fftw3 hdf5 cmocka gnuplot'
debian='gcc:libc6-dev pkg-config libgsl-dev libfftw3-dev libhdf5-dev libcmocka-dev gnuplot-nox'
fedora='gcc pkgconf-pkg-config gsl-devel fftw-devel hdf5-devel libcmocka-devel gnuplot'
arch='gcc pkgconf gsl fftw hdf5 cmocka gnuplot'
homebrew='gcc pkgconf gsl fftw hdf5 cmocka gnuplot'
unknown='C11-compiler pkg-config GSL FFTW3 HDF5(with-hl) CMocka gnuplot(with-cairo-terminals)'
}

: "${CC:=cc}" "${PKG_CONFIG:=pkg-config}"
need=
for word; do
    case $word in
    --report) report=only ;;
    build) need="$need compiler pkgconfig gsl fftw3 hdf5" ;;
    check) need="$need cmocka gnuplot" ;;
    paper) need="$need gnuplot" ;;
    *) echo "usage: install-deps.sh [--report] [build] [check] [paper]" >&2; exit 2 ;;
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

run_installer() {
    case $system in
    debian)   as_root apt-get update &&
              as_root env DEBIAN_FRONTEND=noninteractive \
                  apt-get install -y --no-install-recommends "$@" ;;
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
