# Ctrl-C at any moment: a stream ends at a row's end, a file is complete or absent, and nothing is
# left beside it.
timeout --foreground -s INT 10 true 2> /dev/null || { echo "no timeout of GNU"; exit 77; }
ss-sim --set duration=1 -o whole.tsv coulomb
for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    moment=$(awk -v seed="$i" 'BEGIN { srand(seed); printf "%.3f", 0.3 * rand() }')
    timeout --foreground -s INT "$moment" ss-sim --set duration=1e6 coulomb > stream.tsv || true
    [ ! -s stream.tsv ] || tail -c 1 stream.tsv | od -An -c | grep -q '\\n' || echo "$moment: cut"
    awk -F '\t' '!/^#/ && NF != 5 { print "row of " NF }' stream.tsv
    timeout --foreground -s INT "$moment" ss-sim --set duration=30 -o file.tsv coulomb || true
    [ ! -e file.tsv ] || [ "$(grep -vc '^#' file.tsv)" = 60000 ] || echo "$moment: part of a file"
    rm -f file.tsv stream.tsv
    ls -A
done | sort | uniq -c | awk '{ print $1, $2 }'
status=0
timeout --foreground --preserve-status -s INT 0.2 ss-sim --set duration=1e6 coulomb > /dev/null || status=$?
echo "exit $status"
