# An error late in a stream leaves no file behind.
{ ss-signal sine --duration 20; echo "20	oops"; } > run.tsv
ss-cat -o out.tsv run.tsv || status=$?
ls
exit "$status"
