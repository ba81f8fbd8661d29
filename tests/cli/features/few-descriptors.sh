# More files at once than a process may open.
case $CCLD in *--coverage*) echo "gcov opens files of its own"; exit 77 ;; esac
[ -z "$SAN" ] || { echo "sanitizers need descriptors of their own"; exit 77; }
ss-sim -q -s duration=0.1 coulomb -o run.tsv
set -- run.tsv run.tsv run.tsv run.tsv run.tsv run.tsv
# shellcheck disable=SC3045  # every sh here has it
(ulimit -n 12; exec ss-features --jobs 20 "$@" "$@") || echo "status $?"
