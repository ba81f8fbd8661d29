#!/bin/sh
# number_pow10.sh: the powers of ten that number.c needs, as a C header.
#
# 10^e = (hi 2^64 + lo + r) 2^(floor(log2 10^e) - 127) with the top bit of hi set and 0 <= r < 1.  Numbers
# are limbs of 16 bits, the highest first: 10^e for e >= 0 whole, 2^1584 10^e below, which has 448 bits or
# more.  Rounding down at every division by ten gives the same as rounding down once.
awk '
    function text(x,    first, scale, k, digits) {
        for (first = 1; x[first] == 0; first++)
            ;
        for (scale = 1; x[first] * scale < 32768; scale *= 2)
            ;
        for (k = first; k < first + 8; k++)
            digits = digits sprintf("%04x", x[k] * scale % 65536 + int(x[k + 1] * scale / 65536))
        return "    { 0x" substr(digits, 1, 16) ", 0x" substr(digits, 17) " },"
    }
    BEGIN {
        FIRST = -342; LAST = 324; LIMBS = 100
        for (i = 1; i <= LIMBS; i++)
            down[i] = up[i] = 0
        down[1] = up[LIMBS] = 1
        for (e = -1; e >= FIRST; e--) {
            rest = 0
            for (i = 1; i <= LIMBS; i++) {
                rest = rest * 65536 + down[i]
                down[i] = int(rest / 10)
                rest -= 10 * down[i]
            }
            row[e] = text(down)
        }
        for (e = 0; e <= LAST; e++) {
            row[e] = text(up)
            carry = 0
            for (i = LIMBS; i >= 1; i--) {
                carry += 10 * up[i]
                up[i] = carry % 65536
                carry = int(carry / 65536)
            }
        }
        print "/* number_pow10.h -- made by data/number_pow10.sh */"
        print "enum { POW10_FIRST = " FIRST ", POW10_LAST = " LAST " };"
        print "static const struct pow10 { uint64_t hi, lo; } pow10_table[] = {"
        for (e = FIRST; e <= LAST; e++)
            print row[e]
        print "};"
    }'
