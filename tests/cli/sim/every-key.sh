# Each key of each model at the ends of what it may be: a record of numbers that can be read back, or one line
# that says why not, in numbers, and no row; at most 3 s of CPU time either way.
seconds=3
[ -z "$SAN" ] || seconds=20

check() {       # SCENE KEY=VALUE [KEY=VALUE]
    status=0
    # shellcheck disable=SC3045  # POSIX has only ulimit -f, but every sh here limits CPU time; a busy machine adds none
    (ulimit -t $seconds; exec ss-sim -q -s duration=0.5 -s rate=100 -s "$2" ${3:+-s "$3"} "$1") > out 2> err || status=$?
    rows=$(grep -vc '^#' out || :)
    case $status in
    0) [ "$rows" = 50 ] && ! grep -v '^#' out | grep -qi '[a-z]*nan\|inf' && [ ! -s err ] &&
        ss-cat -q out 2> err | cmp -s - out ;;
    1 | 2) [ "$rows" = 0 ] && [ "$(wc -l < err)" = 1 ] && ! grep -qwi 'nan\|inf' err ;;
    *) false ;;
    esac || { echo "$*: exit $status, $rows rows"; cat err; }
}

usual="mass stiffness friction base_amplitude base_frequency phase x0 v0 damping base_velocity surface_velocity"
from=
for scene in coulomb state-variable compliant-light compliant-heavy leine; do
    case $scene in
    coulomb) keys="$usual settle static_friction" ;;
    leine) keys="$usual static_friction stribeck_velocity" from=settle=0 ;;
    state-variable) keys="$usual settle alpha gamma" ;;
    *) keys="$usual settle contact_stiffness contact_damping static_friction" ;;
    esac
    for key in $keys; do
        for value in 0 -0 5e-324 1e-320 1e-300 1e-12 1e12 1e300; do
            check $scene $key=$value $from
        done
    done
done

echo "clocks that readers accept, and records without a sample"
for clock in "5e-324 0" "1e-320 0" "9e-301 0" "1e-300 0" "1e-300 1e300" "1e300 0" "1e300 1e-300" "1.1e300 0" "1e308 0" \
        "2000 -0" "2000 5e-324" "2000 1e300"; do
    for form in tsv au h5; do
        ss-sim -q -s settle=0 -s "rate=${clock% *}" -s "duration=${clock#* }" -o clock.$form coulomb 2> err || {
            cat err
            break
        }
        ss-cat clock.$form > again || echo "$clock $form"
    done
done 2>&1

echo "rates that are no numbers, steps of no length"
check leine base_velocity=1e12 stribeck_velocity=1e-320
check coulomb damping=1e300 static_friction=1e12
