# Each key of each model at the ends of what it may be: a record of numbers, or one line that says why
# not and no row; at most 2 s of CPU time either way.
seconds=2
[ -z "$SAN" ] || seconds=20

check() {       # SCENE KEY=VALUE
    status=0
    # shellcheck disable=SC3045  # POSIX has only ulimit -f, but every sh here limits CPU time; a busy machine adds none
    (ulimit -t $seconds; exec ss-sim -q -s duration=0.5 -s rate=100 -s "$2" "$1") > out 2> err || status=$?
    rows=$(grep -vc '^#' out || :)
    case $status in
    0) [ "$rows" = 50 ] && ! grep -v '^#' out | grep -qi '[a-z]*nan\|inf' && [ ! -s err ] ;;
    1 | 2) [ "$rows" = 0 ] && [ "$(wc -l < err)" = 1 ] ;;
    *) false ;;
    esac || { echo "$1 $2: exit $status, $rows rows"; cat err; }
}

usual="mass stiffness friction base_amplitude base_frequency phase x0 v0 settle damping base_velocity surface_velocity"
for scene in coulomb state-variable compliant-light compliant-heavy; do
    case $scene in
    coulomb) keys="$usual static_friction" ;;
    state-variable) keys="$usual alpha gamma" ;;
    *) keys="$usual contact_stiffness contact_damping static_friction" ;;
    esac
    for key in $keys; do
        for value in 0 1e-300 1e-12 1e12 1e300; do
            check $scene $key=$value
        done
    done
done
