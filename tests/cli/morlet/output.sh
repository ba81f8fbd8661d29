# Output is whole or absent; a full disk is told, a closed pipe is not.
ss-signal sine --duration 3 -o s.tsv
ss-morlet s.tsv -o c.tsv
ss-morlet -o - s.tsv | cmp - c.tsv
ss-morlet < s.tsv | cmp - c.tsv
ss-morlet s.tsv | head -n 1
ss-morlet s.tsv -o c.h5
ss-morlet s.tsv -o d.h5
cmp c.h5 d.h5
! ss-morlet --fmax 1e4 s.tsv -o c.tsv
ss-morlet s.tsv | cmp - c.tsv
ls
if [ -w /dev/full ]; then
    { ss-morlet s.tsv > /dev/full; } 2>&1 || echo "exit $?"
else
    echo "ss-morlet: write error: No space left on device"
    echo "exit 1"
fi
