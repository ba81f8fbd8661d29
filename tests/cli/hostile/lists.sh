# Lists, tables and plans that tools make for each other: rows of a sweep, features, events, a line over
# a map.  What is no such thing is refused in one line and little memory.
# shellcheck disable=SC3045  # where there is no such limit, there is none
limit() { [ -n "$SAN" ] || ulimit -v 200000 2> /dev/null || true; "$@"; }   # sanitizers map more
refused() { limit "$@" > /dev/null || echo $?; }
map() { refused ss-plot --map x,y,z "$@"; }
ss-signal ringdown --duration 0.1 > run.tsv
ss-morlet run.tsv > c.tsv
ss-sweep -m amplitude --vary mass=1:2:2 --vary friction=1:2:2 coulomb > sweep.tsv
printf '# stickslip features 1\n# spike: 0.1 jump\n0.1\t0.2\t3\t0.1\t40\n' > features.tsv
printf '# stickslip events 1\n0.1\n' > events.tsv
mkdir folder

# No file, a directory, nothing, a FIFO that closes in the middle of a row.
mkfifo in
for name in missing folder /dev/null; do
    map $name
    refused ss-contour --features $name c.tsv
    refused ss-contour --events $name c.tsv
    refused ss-features $name
    refused ss-rank $name
    refused ss-sweep --vary mass=1:2:2 $name
    refused ss-plot --map mass,friction,amplitude --line $name sweep.tsv
done
bytes=$(($(wc -c < sweep.tsv) - 6))
head -c $bytes sweep.tsv > in & refused ss-plot --map mass,friction,amplitude in; wait
head -c 55 features.tsv > in & refused ss-contour --features in c.tsv; wait
head -c 200 run.tsv > in & refused ss-features in; wait
head -c 200 run.tsv > in & refused ss-rank in; wait

# A line of a gigabyte, a million columns.
gigabyte() { "$@"; head -c 1000000000 /dev/zero | tr '\0' 1; }
gigabyte printf '# stickslip sweep 1\n# columns: ' | map
gigabyte printf '# stickslip features 1\n' | refused ss-contour --features - c.tsv
gigabyte true | refused ss-contour --features - c.tsv
gigabyte true | refused ss-features
gigabyte true | refused ss-rank
gigabyte true | refused ss-sweep --vary mass=1:2:2 -
awk 'BEGIN { printf "# stickslip sweep 1\n# columns: index"; for (i = 0; i < 1e6; i++) printf " a"
    print " status" }' | map

# Other text: lone CRs, UTF-16, letters that drive a terminal.
wide() { LC_ALL=C awk '{ gsub(/./, "&@"); printf "%s\n@", $0 }' "$1" | tr '@' '\0'; }
for form in "tr \\n \\r" "wide"; do
    for file in sweep features; do
        case $form in wide) wide $file.tsv ;; *) $form < $file.tsv ;; esac > other.$file
    done
    map other.sweep
    refused ss-contour --features other.features c.tsv
done
printf '# stickslip sweep 1\n# columns: index x y z status\n0\t\033[2J\t1\t1\tok\n' | map
printf '# stickslip features 1\n\033[2J\n' | refused ss-contour --features - c.tsv
printf '# stickslip sweep 1\r\n# columns: index x y z status\r\n0\t1\t1\t1\tok\r\n' | map
printf 'x\033[2J\n1 2\n3 4\n' | ss-plot --map mass,friction,amplitude --line - sweep.tsv | grep -c '^3 4$'

# Each byte of a list of features, another: taken or refused, and never more than that.
for i in $(seq 24 73); do
    awk -v at="$i" 'BEGIN { RS = "\a" } { srand(at)
        printf "%s%c%s", substr($0, 1, at), 32 + int(95 * rand()), substr($0, at + 2) }' features.tsv |
        ss-contour --features - -o a.gp c.tsv 2> words || [ $? = 1 ] || echo "at $i: $(cat words)"
    [ "$(wc -l < words)" -le 1 ] || cat words
done

# What begins as the sweep does but goes on as none.
ss-sweep -m amplitude --vary mass=1:2:2 --vary friction=1:2:2 coulomb > whole.tsv
for row in '\t\t\t' '7\t1\t1\t1\tok' '-1' 'x' '99999999999999999999999\t1'; do
    { grep '^#' whole.tsv; printf '%b\n' "$row"; } > part.tsv
    cp part.tsv before.tsv
    refused ss-sweep --resume part.tsv -m amplitude --vary mass=1:2:2 --vary friction=1:2:2 coulomb
    cmp part.tsv before.tsv
done
ls -A
