printf 't,x\n0,1\n0.1,abc\n' > run.csv
ss-cat -o out.tsv run.csv || status=$?
ls
exit "$status"
