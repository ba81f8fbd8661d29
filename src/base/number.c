/* number.c -- write doubles with the fewest decimal digits, and read them, in every locale the
 * same.
 *
 * Writing and reading multiply a 64-bit integer by a power of ten of 128 bits.  This is enough to
 * decide the rounding of every number that is written (Giulietti, "The Schubfach way to render
 * doubles", 2020) and of all numbers that are read, except a few in 2^60 (Clinger 1990; Lemire,
 * "Number parsing at a gigabyte per second", 2021).  strtod reads those few, the subnormal numbers, the overflowing
 * ones and those of more than 19 digits.  So the only error is the rounding of a number that is read. */
#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#if defined(__APPLE__)
#include <xlocale.h>
#endif
#include <stickslip/number.h>
#include "base/number.h"
#include "number_pow10.h"       /* made by data/number_pow10.sh */

struct wide {
    uint64_t hi, lo;
};

static struct wide
product(uint64_t a, uint64_t b)
{
#ifdef __SIZEOF_INT128__
    __extension__ typedef unsigned __int128 uint128;
    uint128 p = (uint128)a * b;
    return (struct wide){ (uint64_t)(p >> 64), (uint64_t)p };
#else
    uint64_t al = (uint32_t)a, ah = a >> 32, bl = (uint32_t)b, bh = b >> 32;
    uint64_t low = al * bl, mid = ah * bl + (low >> 32), mid2 = al * bh + (uint32_t)mid;
    return (struct wide){ ah * bh + (mid >> 32) + (mid2 >> 32), mid2 << 32 | (uint32_t)low };
#endif
}

/* floor(log2(10^e)) for |e| < 1233, in fixed point; >> must keep the sign, as it does with every compiler that we
 * know. */
static int
log2_pow10(int e)
{
    return e * 1741647 >> 19;
}

/* --- writing ------------------------------------------------------------------------------- */

/* g c 2^-128, rounded to the next odd integer unless it is exact: it then compares rightly with every
 * even integer. */
static uint64_t
round_to_odd(struct pow10 g, uint64_t c)
{
    struct wide x = product(g.lo, c), y = product(g.hi, c);
    uint64_t low = y.lo + x.hi;
    return (y.hi + (low < y.lo)) | (low > 1);
}

/* Of the decimals d 10^k that round to c 2^q, the shortest, and of these the nearest; d may end in
 * zeros.  irregular: the next double below is only half as far away, as at powers of two. */
static uint64_t
shortest(uint64_t c, int q, int irregular, int *exponent)
{
    /* k: floor(log10(f 2^q)) for |q| < 1500, f = 1 or 3/4 */
    int k = (q * 1262611 - (irregular ? 524031 : 0)) >> 22, h = q + log2_pow10(-k) + 1;
    struct pow10 g = pow10_table[-k - POW10_FIRST];
    g.lo += -k < 0 || -k > 55;                  /* rounded up, unless 10^-k is exact */
    uint64_t odd = c & 1;
    uint64_t v = round_to_odd(g, 4 * c << h);               /* all in quarters of 10^k */
    uint64_t lower = round_to_odd(g, (4 * c - (irregular ? 1 : 2)) << h) + odd;
    uint64_t upper = round_to_odd(g, (4 * c + 2) << h) - odd;
    uint64_t s = v / 4, tens = s / 10;

    if (tens > 0) {                             /* one digit less? */
        int below = lower <= 40 * tens, above = 40 * tens + 40 <= upper;
        if (below != above) {
            *exponent = k + 1;
            return tens + (uint64_t)above;
        }
    }
    *exponent = k;
    int below = lower <= 4 * s, above = 4 * s + 4 <= upper;
    if (below != above)
        return s + (uint64_t)above;
    return s + (v > 4 * s + 2 || (v == 4 * s + 2 && (s & 1)));
}

/* Write the digits of d to the end of digit.  Returns the first of the n digits that remain without
 * trailing zeros; *exponent grows by the number of these zeros. */
static const char *
digits_of(uint64_t d, char digit[20], int *n, int *exponent)
{
    static const char pair[] =
        "0001020304050607080910111213141516171819202122232425262728293031323334353637383940414243"
        "4445464748495051525354555657585960616263646566676869707172737475767778798081828384858687"
        "888990919293949596979899";
    char *p = digit + 20, *end = p;     /* cppcheck-suppress ctuPointerArith */
    for (; d >= 100; d /= 100)
        memcpy(p -= 2, pair + 2 * (d % 100), 2);
    if (d >= 10)
        memcpy(p -= 2, pair + 2 * d, 2);
    else
        *--p = (char)('0' + d);
    for (; end[-1] == '0'; end--)
        ++*exponent;
    *n = (int)(end - p);
    return p;
}

static char *
append(char *to, const char *from, int n)
{
    memcpy(to, from, (size_t)n);
    return to + n;
}

/* Write the n digits of 0.ddd x 10^point in the layout of %.17g. */
static char *
lay_out(char *p, const char *digit, int n, int point)
{
    static const char zeros[] = "00000000000000000";
    if (point > 17 || point < -3) {
        int e = point - 1;
        *p++ = digit[0];
        if (n > 1) {
            *p++ = '.';
            p = append(p, digit + 1, n - 1);
        }
        *p++ = 'e';
        *p++ = e < 0 ? '-' : '+';
        e = abs(e);
        if (e >= 100)
            *p++ = (char)('0' + e / 100);
        *p++ = (char)('0' + e / 10 % 10);
        *p++ = (char)('0' + e % 10);
    } else if (point <= 0) {
        p = append(p, "0.", 2);
        p = append(p, zeros, -point);
        p = append(p, digit, n);
    } else if (point >= n) {
        p = append(p, digit, n);
        p = append(p, zeros, point - n);
    } else {
        p = append(p, digit, point);
        *p++ = '.';
        p = append(p, digit + point, n - point);
    }
    return p;
}

size_t
ss_number_format(char text[SS_NUMBER_MAX], double x)
{
    if (text == NULL)
        return 0;
    char *p = text, digit[20];
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    uint64_t fraction = bits & ((UINT64_C(1) << 52) - 1);
    int biased = (int)(bits >> 52 & 0x7ff), n, exponent;

    if (isnan(x))
        return strlen(strcpy(text, "nan"));
    if (bits >> 63)
        *p++ = '-';
    if (biased == 0x7ff) {
        p = append(p, "inf", 3);
    } else if (biased == 0 && fraction == 0) {
        *p++ = '0';
    } else {
        uint64_t c = biased == 0 ? fraction : fraction | UINT64_C(1) << 52;
        uint64_t d = shortest(c, (biased == 0 ? 1 : biased) - 1075, fraction == 0 && biased > 1,
                              &exponent);
        const char *first = digits_of(d, digit, &n, &exponent);
        p = lay_out(p, first, n, n + exponent);
    }
    *p = '\0';
    return (size_t)(p - text);
}

/* --- reading ------------------------------------------------------------------------------- */

/* A decimal number w 10^e. */
struct decimal {
    uint64_t w;
    long e;
    int is_long;                /* it has more digits than w holds, and w is not its value */
};

/* Append the digits at p to w. */
static inline const char *
scan_digits(struct decimal *d, const char *p)
{
    uint64_t all = d->w;
    for (unsigned digit; (digit = (unsigned)(unsigned char)*p - '0') < 10; p++)
        all = all * 10 + digit;
    d->w = all;
    return p;
}

/* Read the unsigned number at p.  Returns its end, or NULL if there is none. */
static const char *
scan(struct decimal *d, const char *start)
{
    enum { MOST = 19 };
    const char *p = scan_digits(d, start), *point = *p == '.' ? p : NULL;
    if (point != NULL)
        p = scan_digits(d, point + 1);
    size_t digits = (size_t)(p - start) - (point != NULL);
    if (digits == 0)
        return NULL;
    d->e = point != NULL ? point + 1 - p : 0;
    d->is_long = digits > MOST;
    if (*p != 'e' && *p != 'E')
        return p;
    struct decimal power = { 0 };
    const char *q = p + 1 + (p[1] == '-' || p[1] == '+'), *end = scan_digits(&power, q);
    if (end == q)
        return p;
    d->is_long |= end - q > 8;
    d->e += p[1] == '-' ? -(long)power.w : (long)power.w;
    return end;
}

/* Compute w 10^e in double precision.  Returns 0 if 128 bits cannot decide how it rounds.
 *
 * w is shifted to the top of 64 bits.  Then the exact product lies in [z, z + 2) units of the 128 bits
 * kept.  If all numbers in this interval have the same leading 54 bits and z is not half-way, the 54th bit decides. */
static int
multiply(struct decimal d, double *x)
{
    if (d.e < POW10_FIRST || d.e > 308)
        return 0;
    int e = (int)d.e, zeros = 0;
    for (; !(d.w >> 63); zeros++)
        d.w <<= 1;
    struct pow10 g = pow10_table[e - POW10_FIRST];
    struct wide z = product(d.w, g.hi), rest = product(d.w, g.lo);
    z.lo += rest.hi;
    z.hi += z.lo < rest.hi;

    int top = (int)(z.hi >> 63), exponent = log2_pow10(e) - zeros + 11 + top;
    uint64_t mask = (UINT64_C(1) << (9 + top)) - 1, below = z.hi & mask, m = z.hi >> (9 + top);
    if ((below == mask && z.lo >= UINT64_MAX - 1) || ((m & 1) && below == 0 && z.lo == 0))
        return 0;
    if (exponent < -1074 || exponent > 970)
        return 0;
    /* m is 53 bits or, rounded up to it, 2^53, which then carries into the exponent. */
    uint64_t bits = ((uint64_t)(exponent + 1074) << 52) + ((m + 1) >> 1);
    memcpy(x, &bits, sizeof bits);
    return 1;
}

struct locales {
    locale_t c, old;
};

/* Use the locale C in this thread, until end_c. */
static struct locales
begin_c(void)
{
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return (struct locales){ c, uselocale(c) };
}

static void
end_c(struct locales used)
{
    uselocale(used.old);
    if (used.c != (locale_t)0)
        freelocale(used.c);
}

int
ss_print(FILE *out, const char *format, ...)
{
    va_list args;
    struct locales used = begin_c();
    va_start(args, format);
    int n = vfprintf(out, format, args);
    va_end(args);
    end_c(used);
    return n;
}

int
ss_print_text(char *text, size_t size, const char *format, va_list args)
{
    struct locales used = begin_c();
    int n = vsnprintf(text, size, format, args);
    end_c(used);
    return n;
}

int
ss_print_to(char *text, size_t size, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    int n = ss_print_text(text, size, format, args);
    va_end(args);
    return n;
}

double
ss_number_parse(const char *text, char **end)
{
    static const double pow10[] = { 1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11,
        1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22 };
    struct decimal d = { 0 };
    const char *p = text != NULL ? text : "";
    double x = 0;

    while (*p == ' ' || (*p >= '\t' && *p <= '\r'))
        p++;
    const char *start = p;
    int negative = *p == '-';
    p = scan(&d, p + (*p == '-' || *p == '+'));
    if (end != NULL)
        *end = (char *)(p != NULL ? p : text);
    if (p == NULL)
        return 0;
    while (!d.is_long && d.w >> 53 && d.w % 10 == 0) {        /* 1.000000000000000000e+00, as NumPy writes it */
        d.w /= 10;
        d.e++;
    }
    int exact = !d.is_long && FLT_EVAL_METHOD >= 0 && FLT_EVAL_METHOD <= 1 && !(d.w >> 53);     /* then one rounding */
    if (exact && d.e >= 0 && d.e <= 22)
        x = (double)d.w * pow10[d.e];
    else if (exact && d.e < 0 && d.e >= -22)
        x = (double)d.w / pow10[-d.e];
    else if (d.is_long || (d.w != 0 && !multiply(d, &x))) {
        struct locales used = begin_c();
        x = strtod(start, NULL);
        end_c(used);
        return x;
    }
    return negative ? -x : x;
}
