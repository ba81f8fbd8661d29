# As with other filters: the reader has had enough, silently.
ss-signal sine --duration 1000 | head -n 1
ss-signal sine --duration 1000 | ss-cat | ss-noise --rms 1 | head -n 1
