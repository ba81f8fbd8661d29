# Every tool has a manual page, and mandoc finds nothing to say about any.
command -v mandoc > /dev/null || { echo "no mandoc"; exit 77; }
for tool in "$BUILD"/bin/ss-*; do
    [ -f "$SRC/man/${tool##*/}.1" ] || echo "no man page: ${tool##*/}"
done
# Every public name stands in a page of section 3.
[ ! -f "$BUILD/libstickslip.so" ] ||
    nm -D --defined-only "$BUILD/libstickslip.so" | sed -n 's/.* \(ss_\)/\1/p' | while read -r name; do
        grep -qw -e "$name" "$SRC"/man/*.3 || echo "in no man page: $name"
    done
cd "$SRC/man"
mandoc -T lint ./*.[1-9]
