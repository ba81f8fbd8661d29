# What a file to be resumed keeps are rows of this sweep: the grid's values, a number in each column, a status.
set -- -m stick,amplitude,period --vary friction=1:2:3 --vary base_frequency=2:3:2 coulomb
ss-sweep -o whole.tsv "$@"
first=$(grep -vn '^#' whole.tsv | sed 1q | cut -d: -f1)
# Cell C of the second row becomes WORD.
forge() {       # C WORD
    c=$1 word=$2
    shift 2
    awk -F '\t' -v OFS='\t' -v at=$((first + 1)) -v c="$c" -v word="$word" \
        'NR == at { $c = word } NR <= at + 1' whole.tsv > forged.tsv
    cp forged.tsv before.tsv
    ss-sweep --resume forged.tsv "$@" && echo "cell $c '$word' is taken"
    cmp forged.tsv before.tsv
}
for word in 1x '' -1 99999999999999999999999 0 7; do forge 1 "$word" "$@"; done
for word in 1.0001 nan - '' one; do forge 2 "$word" "$@"; done
forge 3 2 "$@"
for word in nan inf x '' aperiodic 1e 0x10 -; do forge 5 "$word" "$@"; done
for word in 1.5.1 nan ''; do forge 6 "$word" "$@"; done
for word in '' "$(printf 'ok\tok')"; do forge 7 "$word" "$@"; done
# cells that are missing, a row too much, a NUL
row=$((first + 1))
for change in "${row}s/\t[^\t]*\$//" "${row}s/\t.*//" "${row}s/\$/$(printf '%09000d' 0)/" "\$p"; do
    sed "$change" whole.tsv > forged.tsv
    cp forged.tsv before.tsv
    ss-sweep --resume forged.tsv "$@" && echo "'$change' is taken"
    cmp forged.tsv before.tsv
done
sed "${row}s/ok/o@/" whole.tsv | tr @ '\000' > forged.tsv
ss-sweep --resume forged.tsv "$@" || echo "status $?"
# what may stand there
sed "${row}s/\t[^\t]*\tok\$/\taperiodic\tok/" whole.tsv > right.tsv
ss-sweep --resume right.tsv "$@"

# CSV says of no sweep that it is this one.
ss-sweep -o whole.csv "$@"
cp whole.csv before.csv
ss-sweep --resume whole.csv "$@" || echo "status $?"
cmp whole.csv before.csv
ss-sweep --format csv --resume new.tsv "$@"
cmp new.tsv whole.tsv
set -- --simulate --max-cycles 300 -m period,x_phase --strobe 5 --vary base_frequency=0.52:0.7:4 chaos
ss-sweep "$@" -o strobe.tsv
for bytes in 60 200 400 10000; do
    head -c $bytes strobe.tsv > cut.tsv
    ss-sweep --resume cut.tsv "$@" && cmp cut.tsv strobe.tsv
done
