# The tarball builds where there is no git, and its tools work.
git -C "$SRC" rev-parse HEAD > /dev/null 2>&1 || { echo "no git repository"; exit 77; }
"$MAKE" -s -C "$SRC" BUILD="$PWD/made" dist > log 2>&1 || cat log
tar xzf made/libstickslip-*.tar.gz
cd libstickslip-*/
"$MAKE" -s BUILD=build INSTALL_DEPS=0 > log 2>&1 || cat log
build/bin/ss-sim coulomb --events | awk '$2 == "slip"' | wc -l
