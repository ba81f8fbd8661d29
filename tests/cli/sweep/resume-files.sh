# What is no regular file cannot be continued: refused at once, where a FIFO would wait for ever.
ss-signal sine > signal
mkfifo fifo
mkdir folder
ln -s fifo link
for name in fifo link folder /dev/null /dev/full; do
    ss-sweep -m amplitude --vary mass=2:3:2 --resume $name coulomb || echo $?
    ss-morlet --dyadic --wisdom $name signal > /dev/null || echo $?
done
ss-morlet --dyadic --wisdom - signal > /dev/null || echo $?
ss-morlet --dyadic --wisdom= signal > /dev/null || echo $?
[ -c /dev/null ] || echo "/dev/null was replaced"
ls
