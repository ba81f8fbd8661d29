# Progress is for terminals: a log has none of it, a terminal shows a line after a second, here by a
# clock that goes on by 1 s whenever a tool looks at it.
# A session of its own: script of util-linux 2.34 ends its whole group when its input does.
script() { setsid -w script "$@"; }
script -qec true /dev/null < /dev/null > log 2>&1 || { echo "no pseudo-terminal to be had"; exit 77; }
. "$SRC/tests/link.sh"
for tool in sim cat morlet features contour rank sweep trade; do link_tool ss-$tool "$BUILD/tests/clock.o"; done
PATH=$PWD:$PATH CLOCK_STEP=1
export PATH CLOCK_STEP
ss-signal noise --rate 20000 --duration 9 -o noise.au
ss-signal sine --amplitude 0 --rate 20000 --duration 3 |
    ss-morlet --dense --voices 16 --fmin 20 -o dense.h5
ss-sim --set duration=10 compliant-light | ss-cat --column a -o run.au
shows() {       # how many lines of progress a command writes; their percentage never falls
    script -qec "$1" /dev/null < /dev/null | tr '\r' '\n' > log
    sed -n "s/.*${1%% *}:  *\([0-9]*\) %, [0-9]* s left.*/\1/p" log > percents
    sort -n percents | cmp -s - percents || echo "$1: falls"
    wc -l < percents | tr -d ' '
}
ss-sim --set duration=1000 coulomb 2> log > /dev/null && wc -c < log
shows 'ss-sim -q --set duration=1000 coulomb > /dev/null'
for command in 'ss-sim --set duration=1000 coulomb > /dev/null' 'ss-morlet noise.au -o w.au' \
        'ss-features noise.au -o f.tsv' 'ss-contour dense.h5 -o c.gp' \
        'ss-rank run.au -o r.tsv' 'ss-rank --fit run.au -o f.scene' \
        'ss-sweep --vary friction=.5:1:50 coulomb -o s.tsv' 'ss-trade -b 60 -s duration=.2 coulomb -o t.tsv'; do
    [ "$(shows "$command")" -gt 1 ] || echo "no progress: $command"
done
# A table is read to its end before its rows are given: half of the work, and the rest shows, too.
ss-cat --to 3 noise.au -o noise.csv
for command in 'ss-cat noise.csv -o copy.tsv' 'ss-cat noise.au -o copy.tsv' 'ss-cat noise.csv > copy.tsv' \
        'ss-contour noise.csv -o c.gp' 'ss-contour noise.au -o c.gp' 'ss-features noise.csv -o f.tsv' \
        'ss-morlet noise.csv -o w.au'; do
    lines=$(shows "$command")
    [ "$lines" -gt 9 ] || echo "no progress: $command, $lines"
    [ "$(grep -c '^100$' percents)" -le 2 ] || echo "waits at 100 %: $command"
    [ "$(awk '$1 > 10 && $1 < 45' percents | wc -l)" -gt 2 ] || echo "no reading: $command"
done
