# A number of ss-features is one file and one row of the list: then ss-features writes it as text, as CSV and of
# several files, and ss-trade --models compares it.  Without its row its function does not compile; without its
# function the row does not link.
mkdir -p include/stickslip
awk '/SS_FEATURE_NUMBER_LIST\(number\)/ { inside = 1 }
    inside && !/\\$/ { print $0 " \\"; print "    number(SS_LOUDNESS, \"loudness\", \"dB\", \"ringing\", 0, ss_find_loudness)"; inside = 0; next }
    { print }' "$SRC/include/stickslip/features.h" > include/stickslip/features.h
diff "$SRC/include/stickslip/features.h" include/stickslip/features.h | grep '^>' | grep -c LOUDNESS
. "$SRC/tests/build/block.inc"
block src/find/loudness.c > loudness.c
compile() {     # FOLDER OF HEADERS, FILES: the number is the last, so that nothing else need be compiled anew
    # shellcheck disable=SC2086  # flags are lists
    $CC -std=c11 -D_XOPEN_SOURCE=700 -O2 -I"$1" -I"$SRC/include" -I"$SRC/src" $INCLUDES -c "$2"
}
compile "$SRC/include" loudness.c 2> said || { grep -q 'error.*SS_LOUDNESS' said && echo 'no row: does not compile'; }
for source in src/find/numbers.c src/find/features.c src/find/slip_rate.c src/find/write.c src/study/trade/models.c \
        src/study/trade/needs.c tools/ss-features.c tools/ss-trade.c; do
    compile include "$SRC/$source"
done
mv write.o find_write.o
compile include "$SRC/src/study/trade/write.c"
mv write.o trade_write.o
# shellcheck disable=SC2086  # a list
parts=$(printf "$BUILD/tools/%s.o " $TOOL_PARTS)
objects='numbers.o features.o slip_rate.o find_write.o trade_write.o models.o needs.o'
link() {        # TOOL, OBJECTS
    tool=$1
    shift
    # what is linked first takes the place of the library's own
    # shellcheck disable=SC2086
    $CCLD -o "$tool" "$tool.o" "$@" $parts "$BUILD/libstickslip.a" $LIBS
}
# shellcheck disable=SC2086
link ss-features $objects 2> said || { grep -q ss_find_loudness said && echo 'no function: does not link'; }
compile include loudness.c
# shellcheck disable=SC2086
link ss-features loudness.o $objects
# shellcheck disable=SC2086
link ss-trade loudness.o $objects

ss-sim -s duration=1 compliant-light > run.tsv
./ss-features run.tsv > features.tsv
ss-features run.tsv > usual.tsv
grep -v '^# loudness' features.tsv | cmp - usual.tsv
sed -n 's/^# loudness: [0-9.-]* /loudness NUMBER /p' features.tsv
./ss-features --format csv run.tsv | awk -F , 'NR == 1 { print $(NF - 1), $NF } NR == 2 { print $(NF - 1) < 0, $NF }'
./ss-features run.tsv run.tsv | awk -F '\t' '/^# columns/ { n = split($0, name, " "); print name[n - 2], name[n - 1] }
    !/^#/ { print $(NF - 2) < 0, $(NF - 1) }'
./ss-features run.tsv run.tsv | sed -n 's/^# loudness: [0-9.-]* /loudness NUMBER /p'
./ss-trade --models -s duration=0.5 -s settle=0 compliant-light |
    awk -F '\t' '/^# columns/ { n = split($0, name, " "); for (i = 3; i <= n; i++) if (name[i] == "loudness") c = i - 2 }
        !/^#/ { print $1, ($c > 0) }'
./ss-trade --need loudness=1e-9 -s duration=0.5 -s settle=0 compliant-light
# ss-report shows what the table of files has.
PATH=$PWD:$PATH ss-report -o report run.tsv
grep -o '<tr><td>loudness</td>' report/0001-run.tsv.html
