# A sweep killed 20 times on its way, and in the middle of a line, loses and repeats nothing.
. "$SRC/tests/stop/stop.sh"
set -- --vary friction=0.6:1.2:3000 coulomb
ss-sweep -o whole.tsv "$@"
for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    stopped $((10 + 9 * (i % 10))) 9 ss-sweep --threads 2 --resume part.tsv "$@" || true
    [ ! -e part.tsv ] || head -c "$(wc -c < part.tsv)" whole.tsv | cmp - part.tsv
done
echo "$(hits) of 20 hit at work"
[ "$(wc -l < part.tsv)" -gt 500 ] || echo "$(wc -l < part.tsv) rows only were kept"
ss-sweep --resume part.tsv "$@"
cmp part.tsv whole.tsv
ss-sweep --resume part.tsv "$@"
cmp part.tsv whole.tsv
for bytes in 0 9 300 1000 20001; do
    head -c $bytes whole.tsv > cut.tsv
    ss-sweep --resume cut.tsv "$@"
    cmp cut.tsv whole.tsv
done
ss-sweep --shard 2/7 "$@" > whole2.tsv
head -n 50 whole2.tsv > part2.tsv
ss-sweep --shard 2/7 --resume part2.tsv "$@"
cmp part2.tsv whole2.tsv

# What belongs to another sweep is left alone.
cp whole.tsv other.tsv
try() { ss-sweep --resume "$@" 2>&1 || echo "exit $?"; cmp other.tsv whole.tsv; }
try other.tsv --shard 1/2 "$@"
try other.tsv --tol 1e-8 "$@"
try other.tsv --vary friction=0.6:1.2:2999 coulomb
try other.tsv --set mass=3 "$@"
try . "$@"
printf 'my diary\n' > diary
ss-sweep --resume diary "$@" 2>&1 || echo "exit $?"
cat diary
ls *.tsv diary
