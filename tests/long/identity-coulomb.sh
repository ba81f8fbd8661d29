# True sticks behind hums, filters and sensors that resonate.  The aim is 0.2 % beyond; measured were 3.9 % of 311
# numbers (stickslip-features(7)).
population=coulomb beyond=4
. "$SRC/tests/long/identity.inc"
