# Every reader stands a little of what libFuzzer makes up; make fuzz gives it longer, and sanitizers.
# Here only the readers are compiled for it: all else is the library as it is.
echo 'int LLVMFuzzerTestOneInput(const char *p, long n) { return p == 0 && n < 0; }' > f.c
[ -z "$SAN" ] || { echo "it has sanitizers of its own"; exit 77; }
case $CCLD in *--coverage*) echo "clang cannot link it with gcov"; exit 77 ;; esac
clang -fsanitize=fuzzer -o f f.c 2> log || { echo "no clang with libFuzzer"; exit 77; }
mkdir -p tests/fuzz
# shellcheck disable=SC2086  # flags are lists
set -- -std=c11 -D_XOPEN_SOURCE=700 -I"$SRC/include" -I"$SRC/src" -I"$BUILD" $INCLUDES -O0
# shellcheck disable=SC2086
clang "$@" -fsanitize=fuzzer-no-link -c "$SRC"/src/base/number.c "$SRC"/src/scene/lines.c "$SRC"/src/signal/*.c \
    "$SRC"/src/io/*.c "$SRC"/src/io/table/*.c "$SRC"/src/io/hdf5/h5.c "$SRC"/src/io/hdf5/*_reader.c \
    "$SRC"/src/io/hdf5/read.c "$SRC"/src/plot/map*.c "$SRC"/src/plot/isoline.c "$SRC"/tests/fuzz/common.c
names=
for harness in "$SRC"/tests/fuzz/fuzz_*.c; do
    name=fuzz/$(basename "$harness" .c)
    names="$names $name"
    # shellcheck disable=SC2086
    clang "$@" -fsanitize=fuzzer -o "tests/$name" "$harness" ./*.o "$BUILD/libstickslip.a" $LIBS
done
# shellcheck disable=SC2086
BUILD=$PWD FUZZ_RUNS=300 sh "$SRC/tests/fuzz/run.sh" $names > log 2>&1 || sed "s|$SRC/||g" log
grep -c 'executions, .* edges' log
