# install-deps.sh on systems that it knows, on others, and where nothing is missing.  The installers
# and pkg-config are stand-ins.
unset INSTALL_DEPS
mkdir bin
for name in apt-get dnf pacman brew sudo; do
    # shellcheck disable=SC2016  # for the script written
    printf '#!/bin/sh\n[ "$1" = --prefix ] || echo %s "$@"\n' $name > bin/$name
done
printf '#!/bin/sh\nexec "$@"\n' > bin/sudo
printf '#!/bin/sh\nexit 1\n' > bin/pkg-config
cp bin/pkg-config bin/gnuplot
cp bin/pkg-config bin/no-compiler
chmod +x bin/*
PATH=$PWD/bin:$PATH
OS_RELEASE=$PWD/os-release
export PATH OS_RELEASE
deps() { CC=no-compiler sh "$SRC/tools/install-deps.sh" "$@" 2>&1 || echo "exit $?"; }

for like in 'ID=debian' 'ID=linuxmint ID_LIKE="ubuntu debian"' 'ID=fedora' 'ID="rocky" ID_LIKE="rhel fedora"' \
        'ID=arch' 'ID=haiku'; do
    echo "$like" | sed 's/ ID_LIKE/\nID_LIKE/' > os-release
    echo "-- $like"
    deps build check paper
done
echo '-- what tests compare with'
cp bin/pkg-config bin/clang
printf '#!/bin/sh\n[ "$2" != libflint-arb-dev ]\n' > bin/apt-cache
chmod +x bin/*
echo ID=debian > os-release
deps others | grep -E '^apt-get|^installed' | tr ' ' '\n' | grep -x -e installed, -e 'libfl.*' -e arb -e clang
echo '-- report'
echo ID=debian > os-release
deps --report build
INSTALL_DEPS=0 deps paper
"$MAKE" -s -C "$SRC" BUILD="$PWD/tree" CC=no-compiler 2>&1 | grep -v '^make'
"$MAKE" -s -C "$SRC" BUILD="$PWD/tree" CC=no-compiler INSTALL_DEPS=0 check 2>&1 | grep -v '^make'
echo '-- nothing is missing'
printf '#!/bin/sh\nexit 0\n' > bin/pkg-config
cp bin/pkg-config bin/gnuplot
cp bin/pkg-config bin/no-compiler
deps build check paper
