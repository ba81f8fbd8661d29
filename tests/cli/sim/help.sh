# --help and --version are for standard output; help fits a terminal.
for tool in "$BUILD"/bin/ss-*; do
    name=${tool##*/}
    "$tool" --version | grep -qx "$name (libstickslip) [0-9.]*" || echo "$name: version"
    "$tool" --help > help
    head -n 1 help | grep -q "^usage: $name" || echo "$name: no usage line"
    awk -v name="$name" 'length > 80 { print name ": wide: " $0 }' help
    [ "$(wc -l < help)" -le 24 ] || echo "$name: long help: $(wc -l < help)"
    status=0
    "$tool" --no-such-option 2> err || status=$?
    [ "$status" = 2 ] && [ "$(wc -l < err)" = 1 ] || echo "$name: wrong option: $status $(cat err)"
    [ ! -w /dev/full ] || { ! "$tool" --help > /dev/full 2> err && [ "$(wc -l < err)" = 1 ] ||
        echo "$name: full disk"; }
done
