# Missing and unreadable scenes, a budget used up, a full disk: one line and exit 1.
try() {
    status=0
    ss-sim "$@" || status=$?
    echo "exit $status"
}
try nowhere.scene
try .
try -o nowhere/x.tsv coulomb
try --max-steps 5 -o x.tsv coulomb
try -o x.h5 --max-steps 5 coulomb
try --set rate=1e12 coulomb
try -o x.h5 --set rate=1e12 coulomb
try --max-steps 5 --set rate=1e12 coulomb
ls
[ -w /dev/full ] || exit 0
ss-sim coulomb > /dev/full || echo "exit $?"
ss-sim --help > /dev/full || echo "exit $?"
