# Soft contacts, filters, clocks that wander.
population=soft
. "$SRC/tests/long/identity.inc"
