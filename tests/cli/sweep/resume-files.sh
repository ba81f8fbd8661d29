# What is no regular file cannot be continued: refused at once, where a FIFO would wait for ever.
mkfifo fifo
mkdir folder
ln -s fifo link
for name in fifo link folder /dev/null /dev/full; do
    ss-sweep -m amplitude --vary mass=2:3:2 --resume $name coulomb || echo $?
done
[ -c /dev/null ] || echo "/dev/null was replaced"
ls
