# A directory that may not be written to: refused, and what is there stays.  Root may write
# anywhere, so it becomes nobody first.
case $CCLD in *--coverage*) echo "gcov opens files of its own"; exit 77 ;; esac
mkdir locked
echo old > locked/a.tsv
chmod 555 locked
chmod 755 .
as_nobody() { "$@"; }
if touch locked/x 2> /dev/null; then
    rm locked/x
    as_nobody() { setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; }
    as_nobody ss-sim --version > /dev/null 2>&1 && ! as_nobody touch locked/x 2> /dev/null ||
        { echo "root, and no way to be someone else"; exit 77; }
fi
ss-signal sine > run.tsv
ss-morlet run.tsv > c.tsv
chmod 644 run.tsv c.tsv
as_nobody ss-signal sine -o locked/a.tsv || echo $?
as_nobody ss-sim -o locked/a.h5 coulomb || echo $?
as_nobody ss-cat -o locked/a.au run.tsv || echo $?
as_nobody ss-noise --rms 1 -o locked/a.tsv run.tsv || echo $?
as_nobody ss-morlet -o locked/a.h5 run.tsv || echo $?
as_nobody ss-plot -o locked/a.gp run.tsv || echo $?
as_nobody ss-contour -o locked/a.svg c.tsv || echo $?
ls -A locked
cat locked/a.tsv
