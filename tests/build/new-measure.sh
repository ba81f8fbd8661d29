# A measure of sweeps is three lines: its name in the enumeration of sweep.h, its row in steady.c, its value
# in meter.c.  Then ss-sweep measures it, and what lacks it refuses it in one clear line.
mkdir -p include/stickslip
sed 's/^    SS_MEASURES$/    SS_SLIP_FRACTION,\n&/' "$SRC/include/stickslip/sweep.h" > include/stickslip/sweep.h
sed 's/^    \[SS_PERIOD\] = { { "period".*/&\n    [SS_SLIP_FRACTION] = { { "slip", "" }, STICKS },/' \
    "$SRC/src/study/sweep/steady.c" > steady.c
sed 's/^    value\[SS_STOPS\] = .*/&\n    value[SS_SLIP_FRACTION] = 1 - r->stick \/ r->time;/' \
    "$SRC/src/study/sweep/meter.c" > meter.c
for file in include/stickslip/sweep.h src/study/sweep/steady.c src/study/sweep/meter.c; do
    copy=$file; [ -f "$copy" ] || copy=${file##*/}
    diff "$SRC/$file" "$copy" | grep -c '^>' || true
done
# shellcheck disable=SC2086  # flags are lists
$CC -std=c11 -D_XOPEN_SOURCE=700 -O2 -Iinclude -I"$SRC/include" -I"$SRC/src" $INCLUDES -c steady.c meter.c \
    "$SRC/src/study/sweep/sweep.c" "$SRC/tools/ss-sweep.c"
$CC -std=c11 -D_XOPEN_SOURCE=700 -O2 -Iinclude -I"$SRC/include" -I"$SRC/src" -c "$SRC/src/study/sweep/write.c"
# shellcheck disable=SC2086  # a list
parts=$(printf "$BUILD/tools/%s.o " $TOOL_PARTS)
# what is linked first takes the place of the library's own
# shellcheck disable=SC2086
$CCLD -o ss-sweep ./*.o $parts "$BUILD/libstickslip.a" $LIBS
./ss-sweep --vary friction=0.5:1:2 --measure stick,slip coulomb | awk -F '\t' '!/^#/ { print ($3 > 0), $3 + $4 }'
./ss-sweep --vary friction=0.5:1:2 --measure slip coulomb | grep '^# columns'
./ss-sweep --vary friction=0.5:1:2 --measure slip state-variable || echo "exit $?"
