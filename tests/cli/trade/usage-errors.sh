# Wrong usage is one line and exit 2; a missing scene exit 1.
try() {
    status=0
    ss-trade "$@" || status=$?
    echo "exit $status"
}
try
try coulomb extra
try --budget 0 coulomb
try --target 2 coulomb
try --target 1e-6 -o a.png coulomb
try -o a.h5 coulomb
try --set mas=2 coulomb
try nowhere.scene
