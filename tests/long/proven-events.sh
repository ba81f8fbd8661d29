# As build/proven-events, for 1000 s, and for random scenes, stiff and undamped contacts among them, and
# random rigs.  One of those is a pull from rest with f_s = f_k, whose v touches that of its belt.
# shellcheck source=tests/proof/prove.inc
. "$SRC/tests/proof/prove.inc"
proven 1000 coulomb compliant-heavy compliant-light
for kind in random rigs; do
    proven $kind 100 > scenes.txt || true
    grep -c 'proven$' scenes.txt
    grep -v 'proven$' scenes.txt | sed 's/from .*/from there on/' || true
done
