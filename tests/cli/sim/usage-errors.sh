# Wrong usage is one line and exit 2.
try() {
    status=0
    ss-sim "$@" || status=$?
    echo "exit $status"
}
try
try coulomb extra
try --set mas=3 coulomb
try --set mass=-3 coulomb
try --set alpha=3 coulomb
try --columns x,q coulomb
try --tol 1e-20 coulomb
try --tol tight coulomb
try --method magic coulomb
try --max-steps 0 coulomb
try -o out.png coulomb
try --events --format au coulomb
try --frobnicate
try --set foo=1 coulomb
try --set q=1 coulomb
