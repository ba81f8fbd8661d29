ss-signal sine --format au | head -c 1001 | ss-cat -o out.tsv || status=$?
ls
exit "$status"
