# Every method finds every event.
for scene in coulomb compliant-heavy compliant-light; do
    for how in '-m rk8pd' '-m rkf45 -t 1e-8' '-m msbdf -t 1e-8'; do
        # shellcheck disable=SC2086  # two options
        ss-sim -e $how --set settle=0 --set duration=10 "$scene" | grep -vc '^#'
    done
done
