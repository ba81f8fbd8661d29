# Quarter 4 of 10,000 random scenes: methods, mirror image, units and energy (tests/test_random.c).
[ -z "$SAN" ] || { echo "the same as without sanitizers, for hours"; exit 77; }
FIRST=7500 SCENES=2500 "$BUILD/tests/test_random" > log 2>&1 || cat log
