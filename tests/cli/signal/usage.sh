ss-signal || echo $?
ss-signal square || echo $?
ss-signal sine --seed 2 || echo $?
ss-signal noise --at 1 || echo $?
ss-signal sine --rate 0 || echo $?
ss-signal ringdown --damping 1 || echo $?
ss-signal sine cosine || echo $?
ss-signal sine -o x.dat || echo $?
ss-noise --snr 1 --rms 1 || echo $?
ss-noise || echo $?
ss-cat --time t --rate 5 || echo $?
ss-cat --format aiff || echo $?
ss-signal impulse --at 100 || echo $?
ss-signal impulse --at -1 || echo $?
ss-signal impulse --at 9.9997 | grep -c '	1$'
ss-signal sine -f 1001 --duration 0.0005 | tail -n 1
ss-signal chirp --to 1001 --duration 0.0005 | tail -n 1
ss-signal sine -f 1000 --duration 0.0005 | tail -n 1
ASAN_OPTIONS=${ASAN_OPTIONS-}:allocator_may_return_null=1 ss-signal sine --duration 1e12 2>&1 |
    grep ^ss-signal
ss-cat --from 5 --to 2 || echo $?
ss-cat --from 5 --to 5 || echo $?
