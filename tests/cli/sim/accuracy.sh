# --accuracy finds method and tolerance, and refuses what cannot be kept.
try() {
    status=0
    ss-sim "$@" > out 2> err || status=$?
    # where a budget ends is no promise
    sed -e 's/[0-9.]* s of 5 s, about [0-9.e+]* steps/T s of 5 s, about N steps/' \
        -e 's/[0-9.e-]* of its/E of its/' err >&2
    echo "exit $status, $(grep -vc '^#' out) rows: $(grep -E '^# (integrator|tolerance)' out | tr '\n' ' ')"
}
try -a 1e-9 --set settle=0 --set duration=1 compliant-light
try -a 1e-6 -m rk8pd --set settle=0 --set duration=1 compliant-light
try -a 1e-6 -m msbdf --set settle=0 --set duration=1 coulomb
try -a 1e-6 --max-steps 100 -m rk2 coulomb
try -a 1e-6 -t 1e-9 coulomb
try -a 1e-15 coulomb
try -a 1e-6 -m exact state-variable
# the error is between half of this accuracy and all of it: x is 7 orders smaller than what moves it
try -a 4e-8 -m exact --set friction=1.3859 --set settle=0 --set duration=1 coulomb
