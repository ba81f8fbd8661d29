# An elastic contact behind 22 kinds of sensor: the goals.  Measured were 0 of 416 numbers beyond (seed 97001) and 6 of 192
# (994001), five of them of one record, in which micro-slips make a sensor ring.
population=elastic
. "$SRC/tests/long/identity.inc"
