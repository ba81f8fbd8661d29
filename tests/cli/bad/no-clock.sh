printf 'x,y\n3,1\n1,2\n' > run.csv
ss-cat -o out.tsv run.csv || status=$?
ls
exit "$status"
