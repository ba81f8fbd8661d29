# test_threads under the thread sanitizer.
[ -z "$SAN" ] || { echo "it has a sanitizer of its own"; exit 77; }
echo 'int main(void) { return 0; }' > main.c
$CC -fsanitize=thread -o main main.c 2> log && ./main 2> log || { echo "no thread sanitizer"; exit 77; }
"$MAKE" -s -C "$SRC" BUILD="$PWD/tree" CC="$CC" SANFLAGS=-fsanitize=thread "$PWD/tree/tests/test_threads" > log 2>&1 ||
    cat log
TSAN_OPTIONS=halt_on_error=1 tree/tests/test_threads > log 2>&1 || sed "s|$SRC/||g; s|$PWD/||g" log
