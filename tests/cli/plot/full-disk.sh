# A picture or file that cannot be written whole is an error and leaves nothing behind.
[ -c /dev/full ] || { echo "no /dev/full"; exit 77; }
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim coulomb | ss-morlet -o run.h5
ss-plot run.h5 > /dev/full || echo $?
ss-contour run.h5 > /dev/full || echo $?
for form in gp png svg pdf h5; do ln -s /dev/full full.$form; done
for form in gp png svg pdf; do ss-contour run.h5 -o full.$form || echo $?; done
ss-morlet run.h5 -o full.h5 || echo $?

# No file of more than 64 blocks: the old picture stays.
echo old > old.png
(trap '' XFSZ; ulimit -f 64; ss-contour run.h5 -o old.png) || echo $?
(trap '' XFSZ; ulimit -f 64; ss-morlet run.h5 -o new.h5) || echo $?
cat old.png
mkdir locked
chmod 500 locked
if ! touch locked/x 2> /dev/null; then     # not as root
    ss-plot run.h5 -o locked/a.png 2> words || grep -q 'locked/a.png: Permission denied' words
    ss-morlet run.h5 -o locked/a.h5 2> words || grep -q 'locked/a.h5: Permission denied' words
    rm words
else
    rm locked/x
fi
ls -A . locked
