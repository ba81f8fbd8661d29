# 1000 s at 100 kHz, 10^8 samples, as text into a pipe: less than 20 MB of memory.
[ -r /proc/self/status ] || { echo "no /proc"; exit 77; }
[ -z "$SAN" ] || { echo "sanitizers need memory of their own"; exit 77; }
ss-sim --set settle=0 --set duration=1000 --set rate=100000 coulomb > /dev/null &
tool=$!
most=0
while now=$(awk '/^VmHWM/ { print $2 }' /proc/$tool/status 2> /dev/null) && [ -n "$now" ]; do
    most=$now
    sleep 1
done
wait $tool
[ "$most" -gt 0 ] && [ "$most" -lt 20480 ] || echo "$most KiB"
