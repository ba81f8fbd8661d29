printf '' > run.csv
ss-cat -o out.tsv run.csv || status=$?
ls
exit "$status"
