# An elastic contact behind 22 kinds of sensor.
population=elastic
. "$SRC/tests/long/identity.inc"
