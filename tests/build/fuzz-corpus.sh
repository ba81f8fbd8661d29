# Every reader takes its corpus: seeds, and what was once found to be wrong.
LSAN_OPTIONS=suppressions=$SRC/tests/fuzz/leaks:print_suppressions=0
export LSAN_OPTIONS
for harness in "$SRC"/tests/fuzz/fuzz_*.c; do
    name=$(basename "$harness" .c)
    name=${name#fuzz_}
    "$BUILD/tests/fuzz/replay_$name" "$SRC/tests/fuzz/corpus/$name"/* 2> log ||
        { echo "$name:"; sed "s|$SRC/||g" log; }
done
