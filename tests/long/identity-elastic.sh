# An elastic contact behind 22 kinds of sensor: all goals are met.
population=elastic
. "$SRC/tests/long/identity.inc"
