# The examples of ss-morlet(1).
ss-signal ringdown --frequency 47 --damping 0.02 --at 5 | ss-morlet --fmin 20 --fmax 100 -o ring.tsv
awk '!/^#/ && !$7 && $5^2 + $6^2 > w { w = $5^2 + $6^2; b = $3; f = $4 } END { print sqrt(w), b, f }' \
    ring.tsv
ss-signal impulse --at 5 | ss-morlet --dyadic -o impulse.h5
ss-morlet --inverse ring.tsv -o back.tsv
ss-signal chirp --to 400 --format au | ss-morlet --stream --fmin 20 --format au | ss-contour -o chirp.gp
ls
