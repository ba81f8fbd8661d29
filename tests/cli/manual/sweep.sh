# The examples of ss-sweep(1).
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sweep --shoot --measure stops,amplitude \
    --vary base_frequency=2:8:61 --vary friction=0.1:1.3:49 \
    coulomb -o map.tsv
ss-plot --map base_frequency,friction,stops,amplitude \
    map.tsv -o map.png
test -s map.png
command -v parallel > /dev/null || parallel() { for i in 1 2 3 4; do ss-sweep --resume part$i.tsv --shard $i/4 --vary friction=0.1:1.3:401 coulomb; done; }
parallel ss-sweep --resume part{}.tsv --shard {}/4 \
    --vary friction=0.1:1.3:401 coulomb ::: 1 2 3 4
grep '^#' part1.tsv > all.tsv
cat part[1-4].tsv | grep -v '^#' | sort -n >> all.tsv
ss-sweep --vary friction=0.1:1.3:401 coulomb | cmp - all.tsv
