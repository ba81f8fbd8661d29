# Ringing that begins abruptly and dies out at rest has no slip whose begin a sensor would answer: its frequency is
# printed, of a file as of a stream, whose rows have it, too.
ss-signal ringdown --rate 1e6 --duration .01 --frequency 1e5 --damping .02 --at .002 --format au | tail -c 80000 > burst
for i in 0 1 2 3 4 5 6 7 8 9; do cat burst burst burst; done > bursts
{ printf '.snd\0\0\0\034\377\377\377\377\0\0\0\007\0\017\102\100\0\0\0\001\0\0\0\0'; cat bursts; } \
    | ss-filter --high-pass 1e3 --format au > bursts.au
for how in "" --stream; do
    ss-features $how --fmin 5e4 bursts.au | awk '/^[0-9]/ { rows++; same += ($7 - 1e5) ^ 2 < 1 }
        /^# transition_frequency:/ { right = ($3 - 1e5) ^ 2 < 1 } END { print (rows > 27), (same > 23), right }'
done
