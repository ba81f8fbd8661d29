# Every public function is called in tests/test_arguments.c.
echo '#include <stickslip.h>' | $CC -I"$SRC/include" -x c -E -P - | grep -v '^#' |
    tr '\n;{}' ' \n\n\n' | grep -v typedef | sed -n 's/^.*[ *]\(ss_[a-z0-9_]*\) *([^*].*/\1/p' |
    sort -u > functions
while read -r function; do
    grep -q "[^a-z_]$function(" "$SRC/tests/test_arguments.c" || echo "not called: $function"
done < functions
[ -s functions ] || echo "no functions found"
