# Every reader stands a little of what libFuzzer makes up; make fuzz gives it longer.
echo 'int LLVMFuzzerTestOneInput(const char *p, long n) { return p == 0 && n < 0; }' > f.c
[ -z "$SAN" ] || { echo "it has sanitizers of its own"; exit 77; }
clang -fsanitize=fuzzer,address,undefined -o f f.c 2> log || { echo "no clang with libFuzzer"; exit 77; }
"$MAKE" -s -C "$SRC" BUILD="$BUILD" FUZZ_SECONDS=2 fuzz > log 2>&1 || sed "s|$SRC/||g" log
grep -c 'executions, .* edges' log
