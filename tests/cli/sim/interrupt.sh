# Ctrl-C at any moment: a stream ends at a row's end, a file is complete or absent, and nothing is
# left beside it.
case $CCLD in *--coverage*) echo "gcov makes calls when the work is done"; exit 77 ;; esac
. "$SRC/tests/stop/stop.sh"
mkdir work
set -- -s duration=20 coulomb
to_stream=$(calls_of ss-sim "$@")
to_file=$(calls_of ss-sim -o file.tsv "$@")
rm file.tsv
for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    stopped $((to_stream * i / 20)) 2 ss-sim "$@" > stream.tsv || echo "stream: exit $?" >> said
    [ ! -s stream.tsv ] || tail -c 1 stream.tsv | od -An -c | grep -q '\\n' || echo "call $n: cut"
    awk -F '\t' '!/^#/ && NF != 5 { print "row of " NF }' stream.tsv
    (cd work && stopped $((to_file * i / 20)) 2 ss-sim -o file.tsv "$@") || echo "file: exit $?" >> said
    [ ! -e work/file.tsv ] || [ "$(grep -vc '^#' work/file.tsv)" = 40000 ] || echo "call $n: part of a file"
    rm -f work/file.tsv
    ls -A work
done
echo "$(hits) of 40 hit at work"
sort said | uniq -c | awk '{ $1 = $1; print }'
