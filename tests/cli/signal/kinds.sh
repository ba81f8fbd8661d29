for kind in sine impulse step chirp ringdown; do
    ss-signal -q "$kind" --rate 4 --duration 1 --amplitude 2 | tail -n +4 |
        awk '/^#/ { print; next } { printf "%s\t%.9f\n", $1, $2 * ($2 * $2 > 1e-20) }'
done
ss-signal step --rate 4 --duration 1 --at 0.5 | tail -n 2
ss-signal noise --rate 4 --duration 1 > one
ss-signal noise --rate 4 --duration 1 --seed 1 | cmp - one
if ss-signal noise --rate 4 --duration 1 --seed 2 | cmp -s - one; then echo "the same noise"; fi
