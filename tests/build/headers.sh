# Each public header compiles alone, as strict C11 and as C++17.
cxx=
for c in "${CXX:-c++}" g++ clang++; do
    if command -v "$c" > /dev/null; then cxx=$c; break; fi
done
for h in "$SRC"/include/stickslip.h "$SRC"/include/stickslip/*.h; do
    name=${h#"$SRC"/include/}
    printf '#include <%s>\nint main(void) { return 0; }\n' "$name" > alone.c
    cp alone.c alone.cc
    $CC -std=c11 -pedantic -Wall -Wextra -Werror -I"$SRC/include" -fsyntax-only alone.c
    [ -z "$cxx" ] || $cxx -std=c++17 -pedantic -Wall -Wextra -Werror -I"$SRC/include" -fsyntax-only alone.cc
done
