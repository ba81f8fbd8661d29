#!/usr/bin/env python3
"""number_pow10.py > src/number_pow10.h: the powers of ten that number.c needs, in 128 bits.

10^e = (hi 2^64 + lo + r) 2^(floor(log2 10^e) - 127) with the top bit of hi set and 0 <= r < 1."""
FIRST, LAST = -342, 324

print("/* number_pow10.h -- made by data/number_pow10.py; not to be edited. */")
print("enum { POW10_FIRST = %d, POW10_LAST = %d };" % (FIRST, LAST))
print("static const struct pow10 { uint64_t hi, lo; } pow10_table[] = {")
for e in range(FIRST, LAST + 1):
    num, den = 10 ** max(e, 0), 10 ** max(-e, 0)
    shift = 128 - num.bit_length() + den.bit_length()
    g = (num << shift if shift > 0 else num >> -shift) // den
    while g >> 128:
        g >>= 1
    assert g >> 127 and (g + 1) % 2 ** 64, e    # so that number.c may add 1 without a carry
    print("    { 0x%016x, 0x%016x }," % (g >> 64, g % 2 ** 64))
print("};")
