# A program that was linked with the last release runs with this library, or this one has another soname:
# abidiff compares the two, built from the commit of that release and from here.
BEFORE=3d61344          # 0.1.0, the state before options had a size and laws their keys
command -v abidiff > /dev/null || { echo "no abidiff, of abigail-tools"; exit 77; }
[ -e "$BUILD/libstickslip.so" ] || { echo "no ELF library"; exit 77; }
git -C "$SRC" cat-file -e "$BEFORE^{commit}" 2> /dev/null || { echo "no clone with the release's commit"; exit 77; }
soname() { readelf -d "$1" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p'; }
# abidiff sets bit 8 where a program may break, bit 4 where anything changed.
breaks() {
    status=0
    abidiff --headers-dir1 "$1/include" --headers-dir2 "$2/include" "$1/lib.so" "$2/lib.so" > differences || status=$?
    [ $((status & 8)) != 0 ]
}

mkdir before
git -C "$SRC" archive "$BEFORE" | tar -x -C before
"$MAKE" -C before -j2 build/libstickslip.so.0.1.0 BUILD=build CFLAGS='-O0 -g' > log 2>&1 || { tail -n 3 log; exit 1; }
mkdir old new cut
cp -r before/include old
cp before/build/libstickslip.so.0.1.0 old/lib.so
cp -r "$SRC/include" new
cp "$BUILD/libstickslip.so" new/lib.so
cp -r new/. cut

# It sees a function that is missing.
nm -D --defined-only new/lib.so | sed -n 's/.* T \(ss_[a-z_]*\)@.*/\1/p' > names
grep -qx ss_version names
printf 'STICKSLIP_1 { global: %s local: *; };\n' "$(grep -vx ss_version names | tr '\n' ';')" > cut.map
# shellcheck disable=SC2086  # flags are a list
$CCLD -shared -Wl,--version-script=cut.map -Wl,--whole-archive "$BUILD/libstickslip.a" -Wl,--no-whole-archive -o cut/lib.so $LIBS
breaks new cut && echo "a function that goes is seen"
! breaks new new && echo "the same is the same"

if breaks old new; then
    [ "$(soname old/lib.so)" != "$(soname new/lib.so)" ] || { echo "breaks programs, with the same soname"; head -n 20 differences; }
fi
echo "$(soname old/lib.so) then"
