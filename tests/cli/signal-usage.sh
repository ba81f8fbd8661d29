ss-signal || echo $?
ss-signal square || echo $?
ss-signal sine --seed 2 || echo $?
ss-signal noise --at 1 || echo $?
ss-signal sine --rate 0 || echo $?
ss-signal ringdown --damping 1 || echo $?
ss-signal sine cosine || echo $?
ss-signal sine -o x.csv || echo $?
ss-noise --snr 1 --rms 1 || echo $?
ss-noise || echo $?
ss-cat --time t --rate 5 || echo $?
ss-cat --format wav || echo $?
