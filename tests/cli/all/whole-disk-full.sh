# A disk that fills up, here a small one in memory: one line, exit 1, nothing beside what was there.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
mkdir disk
small_disk() { unshare -rm sh -c 'mount -t tmpfs -o size=64k none disk && "$@"' sh "$@"; }
small_disk true 2> /dev/null || { echo "no small disk can be mounted here"; exit 77; }
ss-sim coulomb -o run.h5
ss-cat run.h5 -o run.tsv
ss-morlet run.tsv -o c.h5
cat > fill.sh <<'END'
for ending in tsv au h5 gp png svg pdf; do echo old > disk/old.$ending; done
write() { for name in old new; do "$@" -o disk/$name."$ending" || echo $?; done; }
for ending in tsv au h5; do write ss-sim coulomb; write ss-cat run.tsv; write ss-cat run.h5; done
for ending in tsv au h5; do write ss-signal noise; write ss-noise --rms 1 run.tsv; done
for ending in tsv h5; do write ss-morlet run.tsv; done
for ending in gp svg; do write ss-plot run.h5; write ss-contour c.h5; done
head -c 64000 /dev/zero 2> words > disk/zero || true     # pictures are smaller
for ending in png pdf; do write ss-plot run.h5; write ss-contour c.h5; done
rm disk/zero
cat disk/old.*
ls -A disk
END
small_disk sh -eu fill.sh
