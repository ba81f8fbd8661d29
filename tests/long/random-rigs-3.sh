# Quarter 3 of 10,000 random scenes with all terms, against the oracle (tests/test_rigs.c).
[ -z "$SAN" ] || { echo "the same as without sanitizers, for hours"; exit 77; }
FIRST=5000 SCENES=2500 SLIPS=1000 "$BUILD/tests/test_rigs" > log 2>&1 || cat log
