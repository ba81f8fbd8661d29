# The shared library has its soname and shows what the public headers declare, no more and no less.
library=$BUILD/libstickslip.so
[ -f "$library" ] || { echo "no ELF library"; exit 77; }
nm -D --defined-only "$library" | sed 's/.* //' | grep -v '^_' | sort > shown

# Functions and constants that the headers declare: types go, and so do words in comments.
cat "$SRC"/include/stickslip/*.h | $CC -fpreprocessed -dD -E -P -x c - 2>/dev/null |
    tr -s ' \n' '  ' | tr ';{}' '\n\n\n' |
    grep -v -e typedef -e '#define' |
    sed -n -e 's/^.*[ *]\(ss_[a-z0-9_]*\)(.*/\1/p' -e 's/^ *extern const.*[ *]\(ss_[a-z0-9_]*\).*$/\1/p' |
    sort -u > declared
diff declared shown
readelf -d "$library" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p'
