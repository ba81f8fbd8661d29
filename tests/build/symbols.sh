# The shared library has its soname and shows what the public headers declare, no more and no less.
library=$BUILD/libstickslip.so
[ -f "$library" ] || { echo "no ELF library"; exit 77; }
nm -D --defined-only "$library" | sed -e 's/.* //' -e 's/@.*//' | grep -v -e '^_' -e '^STICKSLIP_' | sort > shown

# Functions and constants that the headers declare.
echo '#include <stickslip.h>' | $CC -I"$SRC/include" -x c -E -P - | grep -v '^#' |
    tr '\n;{}' ' \n\n\n' | grep -v -e typedef -e '^[^(]*(\*' |
    sed -n -e 's/^.*[ *]\(ss_[a-z0-9_]*\) *(.*/\1/p' \
        -e 's/^ *extern const.*[ *]\(ss_[a-z0-9_]*\).*$/\1/p' |
    sort -u > declared
diff declared shown
# Debian's list of them, each with the version that it came with
symbols=debian/libstickslip1.symbols
sed -n 's/^ \(ss_[a-z0-9_]*\)@STICKSLIP_1 .*/\1/p' "$SRC/$symbols" | diff -u --label declared --label $symbols declared -
readelf -d "$library" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p'

# A program that links the static library meets no other name either.
nm -g --defined-only "$BUILD/libstickslip.a" | awk 'NF == 3 && $3 !~ /^_?ss_|^_/ { print "libstickslip.a:", $3 }'
