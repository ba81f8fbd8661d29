# As build/proven-events, for 1000 s, and for 100 random scenes, stiff and undamped contacts among them.
# shellcheck source=tests/proof/prove.inc
. "$SRC/tests/proof/prove.inc"
proven 1000 coulomb compliant-heavy compliant-light
proven random 100 > random.tsv || true
grep -c 'proven$' random.tsv
grep -v 'proven$' random.tsv || true
