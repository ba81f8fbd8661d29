# A gap; the tolerance is in the message.
printf 't,x\n0,1\n1,2\n2,2\n3.5,3\n4.5,4\n5.5,5\n' > run.csv
ss-cat -o out.tsv run.csv || status=$?
ls
exit "$status"
