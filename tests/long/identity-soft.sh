# Soft contacts, filters, clocks that wander.  The aim is 0.2 % beyond; measured were 1.0 % of 292 numbers
# (stickslip-features(7)).
population=soft beyond=1
. "$SRC/tests/long/identity.inc"
