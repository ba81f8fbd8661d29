# The conformance set: its two methods agree with its tables, and a table with a wrong digit does not.
set=$SRC/tests/conformance
for table in events values; do
    for method in FIRST SECOND; do
        sh "$set/tables.sh" $table $method > $table.$method &
    done
done
wait
sh "$set/check.sh" events.FIRST values.FIRST && sh "$set/check.sh" events.SECOND values.SECOND && echo conforms
sed '2,500s/\(.*\)e-05/\1e-04/' values.FIRST > wrong
sh "$set/check.sh" events.FIRST wrong > said || echo "exit $?"
sed -n '1s/:.*//p' said | sed 's/.*\///'
head -n 300 events.FIRST > short
sh "$set/check.sh" short values.FIRST | sed 's/.*\///'
