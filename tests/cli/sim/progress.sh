# Progress is for terminals: a log has none of it, a terminal shows a line after a second.
timeout -s INT 2 ss-sim --set duration=1e6 coulomb > /dev/null || true
# A session of its own: script of util-linux 2.34 ends its whole group when its input does.
script() { setsid -w script "$@"; }
script -qec true /dev/null < /dev/null > log 2>&1 || { echo "no pseudo-terminal to be had"; exit 77; }
script -qec 'timeout -s INT 5 ss-sim --set duration=1e6 coulomb > /dev/null' /dev/null < /dev/null > log || true
tr '\r' '\n' < log | grep -q 'ss-sim:  *[0-9]* %, [0-9]* s left' || echo "no progress"
script -qec 'timeout -s INT 3 ss-sim -q --set duration=1e6 coulomb > /dev/null' /dev/null < /dev/null > log || true
grep '%' log || true
# So do transforms and what looks at them, here stopped again and again, so that a second passes on every machine.
cat > slowly <<'END'
"$@" &
while kill -STOP $! 2> /dev/null; do
    sleep 0.5
    kill -CONT $! 2> /dev/null && sleep 0.1
done
END
ss-signal noise --rate 20000 --duration 4 -o short.au
ss-signal noise --rate 20000 --duration 45 -o long.au
slow='--method quadrature --accuracy 1e-13 --step 4 --voices 32 --center 200 --fmax 3000'
ss-signal sine --amplitude 0 --rate 20000 --duration 3 |
    ss-morlet --dense --voices 16 --fmin 20 -o dense.h5
ss-sim --set duration=10 compliant-light | ss-cat --column a -o run.au
ss-sim --set duration=60 compliant-light | ss-cat --column a -o longer.au
for command in "ss-morlet $slow short.au -o w.au" 'ss-features long.au -o f.tsv' \
        'ss-contour dense.h5 -o c.gp' \
        'ss-rank longer.au -o r.tsv' 'ss-rank --fit run.au -o f.scene'; do
    script -qec "sh slowly $command" /dev/null < /dev/null > log || true
    tr '\r' '\n' < log | grep -q "${command%% *}:  *[0-9]* %, [0-9]* s left" || echo "no progress: $command"
done
