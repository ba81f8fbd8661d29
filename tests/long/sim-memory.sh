# 1000 s at 100 kHz, 10^8 samples, as text into a pipe: less than 20 MB of memory.
[ "$(uname)" = Linux ] || { echo "other systems count memory in other units"; exit 77; }
[ -z "$SAN" ] || { echo "sanitizers need memory of their own"; exit 77; }
$CCLD -o high_water "$SRC/tests/stop/high_water.c"
most=$(./high_water ss-sim --set settle=0 --set duration=1000 --set rate=100000 coulomb 2>&1 > /dev/null)
[ "$most" -lt 20480 ] || echo "$most KiB"
