# Bases of two or three harmonics.
population=uneven
. "$SRC/tests/long/identity.inc"
