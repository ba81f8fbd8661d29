# CSV for other programs: read with Python's csv module, as pandas, R and Miller read it, the numbers are those of
# the text form; what awk finds where there is no Python.
command -v python3 > /dev/null || { echo "no python3"; exit 77; }
cat > check.py <<'PY'
import csv, sys
def rows(name):
    with open(name, newline="") as f:
        return list(csv.reader(f))
def same(text, table, what):
    lines = open(text).read().split("\n")
    columns = [l for l in lines if l.startswith("# columns: ")][-1].split(": ", 1)[1].split()
    data = [l.split("\t") for l in lines if l and not l.startswith("#")]
    head, *cells = rows(table)
    own = [i for i, name in enumerate(head) if not name.startswith("all_") and name != "answer"]
    for i, name in enumerate(head):     # the summary, which is a note in the text form
        if name.startswith("all_") and not name.endswith("_error"):
            note, = [l.split() for l in lines if l.startswith("# " + name[4:] + ": ")]
            assert all([r[i] or "-", r[i + 1] or "-"] == note[2:4] for r in cells), note
        if name == "answer":
            assert all("# answer: " + r[i] in lines for r in cells), name
    head, cells = [head[i] for i in own], [[r[i] for i in own] for r in cells]
    assert len(head) == len(set(head)), head
    assert all(len(r) == len(head) for r in cells), "ragged"
    assert len(cells) == len(data) and len(data) > 0, (len(cells), len(data))
    for a, b in zip(cells, data):
        assert [c if c else "-" for c in a] == b, (a, b)
    print(what, ",".join(head)[:60], len(cells))
same(*sys.argv[1:])
PY
compare() { what=$1; shift; "$@" > one.tsv; "$@" --format csv > one.csv; python3 check.py one.tsv one.csv "$what"; }
compare ss-sim ss-sim -s duration=0.1 coulomb
compare events ss-sim --events compliant-light
ss-sim compliant-light > run.tsv
compare ss-cat ss-cat run.tsv
compare ss-noise ss-noise --rms 1 run.tsv
compare ss-signal ss-signal sine --duration 0.01
compare ss-morlet ss-morlet --voices 2 run.tsv
compare 'ss-morlet --stream' ss-morlet --stream --fmin 20 --voices 2 run.tsv
compare ss-features ss-features run.tsv
compare ss-sweep ss-sweep -q --vary friction=0.5:2:3 coulomb
ss-sim compliant-light -o run.csv
ss-sim --columns t,a compliant-light -o accel.tsv
compare ss-rank ss-rank -q accel.tsv compliant-light
ss-trade -q -b 0.001 coulomb -o trade.csv
python3 -c 'import csv; r = list(csv.reader(open("trade.csv"))); print(r[0], {len(x) for x in r})'
# Names that need quotes, and none that do not.
printf 't_s,"force, ""raw"" (N)",x\n0,1,2\n0.001,3,4\n' | ss-cat --format csv
ss-cat run.csv 2> warning | sed -n 2,4p
wc -l < warning
refused() { "$@" || echo $?; }
refused ss-features --format au run.tsv
