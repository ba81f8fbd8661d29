# What make install puts somewhere is complete, and make uninstall takes all of it away.
# From a copy: another PREFIX makes tools again, which other tests run meanwhile.
mkdir tree
cp -a "$BUILD"/src "$BUILD"/tools "$BUILD"/bin "$BUILD"/flags "$BUILD"/libdir "$BUILD"/*.* tree
root="$PWD/a 'root'" tree=$PWD/tree
make_() {
    "$MAKE" -s -C "$SRC" BUILD="$tree" PREFIX=/usr DESTDIR="$root" "$@" > log 2>&1 || cat log
}
make_ install
(cd "$root/usr" && find . ! -type d | sort) > files
for path in include/stickslip.h include/stickslip/sim.h lib/libstickslip.a lib/pkgconfig/stickslip.pc \
        share/stickslip/scenes/compliant-light.scene share/doc/stickslip/examples/stiffness.c; do
    grep -qx "./$path" files || echo "not installed: $path"
done
for tool in "$SRC"/tools/ss-*.*; do
    name=$(basename "${tool%.*}")
    "$root/usr/bin/$name" --version > installed
    "$BUILD/bin/$name" --version | diff - installed || echo "$name: not the one that was built"
    [ -f "$root/usr/share/man/man1/$name.1" ] || echo "not installed: $name.1"
done
make_ uninstall
make_ uninstall          # what is gone already is no error
find "$root" ! -type d
find "$root" -name '*stickslip*'
