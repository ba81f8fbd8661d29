# What is built stops an overrun of a buffer: the compiler's checks, and tables that are read-only.
[ -z "$SAN" ] || { echo "sanitizers look closer"; exit 77; }
command -v readelf > /dev/null || { echo "no readelf"; exit 77; }
# Does this compiler have them, for a program that must be checked?
cat > probe.c <<'C'
#include <stdio.h>
int main(int argc, char *argv[])
{
    char name[8];
    return snprintf(name, sizeof name, "%s", argv[argc - 1]);
}
C
# shellcheck disable=SC2086  # flags are lists
$CC -O2 -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2 -fstack-protector-strong -Wl,-z,relro,-z,now -o probe probe.c \
    2> /dev/null || { echo "the compiler has none of it"; exit 77; }
case " $CCLD " in *" -O"[1-3s]*) : ;; *) echo "built without optimisation"; exit 77 ;; esac
uses() { nm -D --undefined-only "$1" | grep -q "$2"; }
for file in "$BUILD"/bin/ss-* "$BUILD/libstickslip.so"; do
    name=$(basename "$file")
    [ "$(head -c 2 "$file")" != '#!' ] || continue
    readelf -lW "$file" | grep -q GNU_RELRO || echo "$name: no RELRO"
    readelf -dW "$file" | grep -q 'BIND_NOW\|NOW$\|Flags:.*NOW' || echo "$name: binds late"
    ! uses probe __stack_chk_fail || uses "$file" __stack_chk_fail || echo "$name: no stack protector"
    ! uses probe _chk || uses "$file" 'printf_chk' || echo "$name: no FORTIFY"
done
