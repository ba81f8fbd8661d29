# A signal that cannot be read while it is drawn: the message names it, and blames no output.
ss-sim -s duration=60 coulomb -o bad.h5
dd if=/dev/zero of=bad.h5 bs=1000 seek=300 count=4 conv=notrunc 2> /dev/null
for how in "" --spectrum --xy=x,v; do
    ss-plot $how bad.h5 -o bad.gp || echo "exit $?"
done
ss-plot --spectrum bad.h5 -o bad.tsv || echo "exit $?"
ls
