# Threads change nothing; shards, whether numbered from 0 or from 1, are the whole in parts.
set -- --vary friction=0.5:1.3:41 --vary base_frequency=2.5:3.5:11 coulomb
ss-sweep -o whole.tsv "$@"
ss-sweep --threads 2 "$@" | cmp - whole.tsv
ss-sweep --threads 5 -o five.tsv "$@"
cmp five.tsv whole.tsv
grep -v '^#' whole.tsv > rows
for from in 0 1; do
    for i in 0 1 2; do ss-sweep --threads 2 --shard $((from + i))/3 -o part$i.tsv "$@"; done
    cat part[012].tsv | grep -v '^#' | sort -n | cmp - rows
    grep '^#' part0.tsv > header
    grep '^#' whole.tsv | cmp - header
    wc -l < part1.tsv
done
ss-sweep --shoot --threads 2 "$@" > two
ss-sweep --shoot "$@" | cmp - two
ss-sweep --shard 7/1000 "$@" | tail -n 1 | cut -f 1
ss-sweep --shard 700/1000 "$@" | grep -vc '^#' || true
