# On a disk of any size the report is whole, or absent, and one line says so.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
mkdir disk
small_disk() { unshare -rm sh -c 'mount -t tmpfs -o "size=$1" none disk && shift && "$@"' sh "$@"; }
small_disk 64k true 2> /dev/null || { echo "no small disk can be mounted here"; exit 77; }
ss-sim --set duration=5 compliant-light > run.tsv
ss-report -o whole run.tsv
cat > report.sh <<'END'
ss-report -o disk/pages run.tsv 2> words
status=$?
case $status in
0) diff -r whole disk/pages && echo whole ;;
1) [ -z "$(ls -A disk)" ] && [ "$(wc -l < words)" = 1 ] && echo absent || { ls -A disk; cat words; } ;;
*) echo "exit $status" ;;
esac
END
for size in 4k 16k 64k 128k 256k 512k 1m 2m 3m 16m; do
    small_disk $size sh report.sh
done | sort | uniq -c | awk '$2 != "whole" && $2 != "absent"; { n++ } END { print n + 0 " kinds of end" }'
