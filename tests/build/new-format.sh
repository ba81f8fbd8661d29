# A format is added by one file and one row of the list: then every tool reads a signal in it, and each
# that writes signals, coefficients or rows writes it.  It has a line FISH, then its rate, names and
# numbers with a bar between.
mkdir -p src/io bin
awk '/define FORMAT_LIST/ { inside = 1 } inside && !/\\$/ { print $0 " \\"; print "    row(fish)"; inside = 0; next }
    { print }' "$SRC/src/io/format.h" > src/io/format.h
diff "$SRC/src/io/format.h" src/io/format.h | grep -c '^> ' || true
. "$SRC/tests/build/block.inc"
block src/io/fish.c > src/io/fish.c
# The file alone, without the row, does not compile.
# shellcheck disable=SC2086  # flags are a list
! $CC -std=c11 -D_XOPEN_SOURCE=700 -I"$SRC/include" -I"$SRC/src" $INCLUDES -c src/io/fish.c 2> log || echo "compiled"
grep -o 'FORMAT_fish.* undeclared\|undeclared.*FORMAT_fish' log | head -n 1 | tr -d "'‘’" || cat log
for file in "$SRC"/src/io/*.c src/io/fish.c; do
    # shellcheck disable=SC2086  # flags are a list
    $CC -std=c11 -D_XOPEN_SOURCE=700 -Isrc -I"$SRC/include" -I"$SRC/src" $INCLUDES -c "$file"
done
# shellcheck disable=SC2086  # a list
parts=$(printf "$BUILD/tools/%s.o " $TOOL_PARTS)
for tool in cat features morlet plot noise filter rank trade sim signal sweep; do
    # shellcheck disable=SC2086
    $CCLD -o "bin/ss-$tool" "$BUILD/tools/ss-$tool.o" $parts ./*.o "$BUILD/libstickslip.a" $LIBS
done
PATH=$PWD/bin:$PATH

echo '-- what writes signals'
ss-signal ringdown --duration 4 --rate 500 --frequency 20 -o ring.fish
ss-signal ringdown --duration 4 --rate 500 --frequency 20 > ring.tsv
head -n 3 ring.fish
ss-cat ring.fish --format fish | cmp - ring.fish
ss-sim -s duration=0.01 coulomb --format fish | head -n 2
echo '-- what reads them: the same as of text'
for command in ss-cat 'ss-noise --rms 1' ss-morlet ss-plot 'ss-features -q' 'ss-rank -q --long'; do
    $command ring.tsv | grep -v -e '^# signal' > one
    $command ring.fish | grep -v -e '^# signal' > two
    cmp one two && [ "$(wc -l < two)" -gt 9 ] && echo "$command: the same"
done
ss-trade -q -b 0.01 ring.fish | grep '^# compared'
echo '-- what writes rows'
ss-morlet --voices 1 --format fish ring.fish | head -n 2 | tail -n 1
ss-features ring.fish -o features.fish && head -n 1 features.fish | cut -d '|' -f 1-12
ss-sim --events -s settle=0 -s duration=0.5 coulomb -o events.fish && head -n 2 events.fish
ss-rank -q ring.fish coulomb -o ranking.fish && head -n 1 ranking.fish | cut -d '|' -f 1-5
ss-sweep coulomb --vary friction=0.5:1:2 --measure stops -o sweep.fish && cat sweep.fish
