# True sticks behind hums, filters and sensors that resonate.  The aim is 0.2 % beyond; measured were 1.0 % of 1129
# numbers (seeds 981001 and 991001).
population=coulomb beyond=1
. "$SRC/tests/long/identity.inc"
