# True sticks behind hums, filters and sensors that resonate.
population=coulomb
. "$SRC/tests/long/identity.inc"
