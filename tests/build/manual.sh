# Every tool has a manual page, and mandoc finds nothing to say about any.
command -v mandoc > /dev/null || { echo "no mandoc"; exit 77; }
for tool in "$BUILD"/bin/ss-*; do
    [ -f "$SRC/man/${tool##*/}.1" ] || echo "no man page: ${tool##*/}"
done
cd "$SRC/man"
mandoc -T lint ./*.[1-9]
