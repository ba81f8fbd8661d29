# JSON has the rows of CSV: each line is an object, whose names are those of the columns, whose numbers and words are
# those of the cells, and null is an empty cell, or
# infinite.
command -v python3 > /dev/null || { echo "no python3"; exit 77; }
ss-sim compliant-light --set settle=0 -o run.tsv
ss-sim -c t,a compliant-heavy --set duration=1 | ss-filter -q --low-pass 200 -o 'odd
name.tsv'
cat > compare.py <<'EOF'
import csv, json, sys
rows = list(csv.reader(open("out.csv", newline="")))
lines = open("out.json").read().splitlines()
assert len(lines) == len(rows) - 1, (len(lines), len(rows))
for row, line in zip(rows[1:], lines):
    one = json.loads(line, parse_float=str, parse_int=str)
    assert list(one) == rows[0], (list(one), rows[0])
    assert ["" if v is None else v for v in one.values()] == [w.replace("inf", "") for w in row], (line, row)
print(len(rows) > 1)
EOF
same() {
    "$@" --format csv > out.csv
    "$@" --format json > out.json
    python3 compare.py || echo "$*"
}
same ss-cat run.tsv
same ss-sim --events coulomb
same ss-signal chirp
same ss-noise --rms 1 run.tsv
same ss-filter --low-pass 100 run.tsv
same ss-features run.tsv
same ss-features run.tsv 'odd
name.tsv'
same ss-morlet -c a --fmin 5 run.tsv
same ss-morlet -c a --fmin 20 --stream run.tsv
same ss-plot --spectrum run.tsv
same ss-rank run.tsv
# What is said of the whole result stands in each row: the answer as the note has it, and its numbers.
answers() {
    same "$@"
    "$@" | sed -n 's/^# \(answer\|mechanism\|decay\): //p; s/^# friction: \([^ ]*\).*/\1/p' > note.txt
    python3 - <<'END'
import json
one = json.loads(open("out.json").readline())
words = open("note.txt").read().splitlines()
print(words and words == [one[key] if key != "all_friction" else f"{one[key]:.5g}"
                          for key in ("answer", "mechanism", "decay", "all_friction") if key in one])
END
}
answers ss-rank run.tsv coulomb
answers ss-rank run.tsv --column f --motion x
answers ss-backbone -c a run.tsv
printf '%s\n' model=coulomb mass=1 stiffness=40 damping=.05 friction=.002 x0=.01 duration=60 rate=50 |
    ss-sim - | ss-noise --snr 40 > decay.tsv
answers ss-backbone -c x decay.tsv
same ss-sweep coulomb --vary friction=1:2:3
ss-sim --columns t,x,v coulomb --set duration=.002 --format json
ss-cat run.tsv -o run.json && ss-cat run.tsv --format json | cmp - run.json
printf '# stickslip signal 1\n# rate: 1\n# columns: t/s a"b\\\303\244/m\n0\t1\n' | ss-cat --format json
ss-sweep coulomb --vary friction=1:2:3 --resume rows.json || echo $?
