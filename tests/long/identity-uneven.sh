# Bases of two or three harmonics: all goals are met.
population=uneven
. "$SRC/tests/long/identity.inc"
