/* test_number.c -- numbers to text and back: the C library's %.{1..17}g and strtod are the truth. */
#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/signal.h>
#include "base/number.h"
#include "io/record.h"
#include "unit.h"

static uint64_t
next_random(uint64_t *s)
{
    *s ^= *s << 13;
    *s ^= *s >> 7;
    return *s ^= *s << 17;
}

/* Digits from the first that is not 0 to the last that is not 0. */
static int
count_digits(const char *text)
{
    int n = 0, zeros = 0;
    for (; *text != '\0' && *text != 'e'; text++) {
        if (*text < '0' || *text > '9' || (n == 0 && *text == '0'))
            continue;
        n++;
        zeros = *text == '0' ? zeros + 1 : 0;
    }
    return n > zeros ? n - zeros : 1;
}

/* No shorter decimal reads back, none of its length is nearer, and it reads back. */
static void
check(double x)
{
    char text[SS_NUMBER_MAX], other[64], *end;
    int digits = 1;
    size_t length = ss_number_format(text, x);
    for (; digits < 17; digits++) {
        snprintf(other, sizeof other, "%.*e", digits - 1, x);
        if (strtod(other, NULL) == x)
            break;
    }
    if (length != strlen(text) || strtod(text, NULL) != x || count_digits(text) > digits)
        fail_msg("%.17g written as %s", x, text);
    /* %.*e is the nearest decimal of its length, so one of the fewest digits must equal it. */
    if (count_digits(text) == digits && digits < 17) {
        snprintf(other, sizeof other, "%.*e", digits - 1, x);
        if (strtold(other, NULL) != strtold(text, NULL))
            fail_msg("%.17g written as %s, but %s is nearer", x, text, other);
    }
    if (ss_number_parse(text, &end) != x || *end != '\0')
        fail_msg("%s read as %.17g", text, ss_number_parse(text, NULL));
}

static void
writes_the_fewest_digits_of_any_bit_pattern(void **state)
{
    uint64_t seed = 1;
    (void)state;
    for (int i = 0; i < 250000; i++) {
        uint64_t bits = next_random(&seed);
        double x;
        memcpy(&x, &bits, sizeof x);
        if (isfinite(x))
            check(x);
    }
}

static void
writes_the_extremes(void **state)
{
    (void)state;
    for (int e = -1074; e <= 1023; e++) {       /* above a power of two the neighbour is farther */
        check(ldexp(1, e));
        check(nextafter(ldexp(1, e), 0));
        check(nextafter(ldexp(1, e), INFINITY));
    }
    for (int e = -323; e <= 308; e++) {
        char text[16];
        snprintf(text, sizeof text, "1e%d", e);
        check(strtod(text, NULL));
        check(nextafter(strtod(text, NULL), 0));
    }
    for (int i = 0; i < 10000; i++)             /* subnormal */
        check(i * 4.9406564584124654e-324);
    for (int i = 0; i < 100000; i++)
        check(i / 1000.);
    check(DBL_MAX);
    check(DBL_MIN);
    check(-DBL_MAX);
}

static void
lays_numbers_out_as_percent_g_does(void **state)
{
    static const struct { double x; const char *text; } row[] = {
        { 0, "0" }, { -0.0, "-0" }, { 1, "1" }, { -42, "-42" }, { 0.0005, "0.0005" },
        { 0.00005, "5e-05" }, { 1e16, "10000000000000000" }, { 1e17, "1e+17" },
        { 0.1 + 0.2, "0.30000000000000004" }, { 1e100, "1e+100" }, { 1e23, "1e+23" },
        { 4.9406564584124654e-324, "5e-324" }, { DBL_MAX, "1.7976931348623157e+308" },
        { DBL_MIN, "2.2250738585072014e-308" }, { 9007199254740992, "9007199254740992" },
        { 123456.78125, "123456.78125" }, { NAN, "nan" }, { INFINITY, "inf" },
        { -INFINITY, "-inf" }, { -1.25e-300, "-1.25e-300" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char text[SS_NUMBER_MAX];
        ss_number_format(text, row[i].x);
        assert_string_equal(text, row[i].text);
    }
}

static void
reads_any_number_of_digits_as_strtod_does(void **state)
{
    uint64_t seed = 7;
    (void)state;
    for (int i = 0; i < 300000; i++) {
        char text[128], *end;
        uint64_t bits = next_random(&seed);
        double x;
        memcpy(&x, &bits, sizeof x);
        if (!isfinite(x))
            continue;
        snprintf(text, sizeof text, "%.*e", (int)(next_random(&seed) % 40), x);
        double y = ss_number_parse(text, &end);
        if (y != strtod(text, NULL) || *end != '\0')
            fail_msg("%s read as %.17g", text, y);
    }
}

/* Without an exponent, with zeros at either end. */
static void
reads_fixed_decimals(void **state)
{
    uint64_t seed = 11;
    (void)state;
    for (int i = 0; i < 300000; i++) {
        char text[400], *end;
        double size = (double)(next_random(&seed) % 41) - 20;
        double x = pow(10, size) * ((double)next_random(&seed) / 0x1p63 - 1);
        snprintf(text, sizeof text, "%.*f", (int)(next_random(&seed) % 30), x);
        double should = strtod(text, NULL), is = ss_number_parse(text, &end);
        if (memcmp(&is, &should, sizeof is) != 0 || *end != '\0')
            fail_msg("%s read as %.17g", text, is);
    }
}

static void
reads_hard_cases(void **state)
{
    static const char *const text[] = {
        "9007199254740993", "9007199254740992.99999999999999999999", "9007199254740993.0000000000001",
        "1.00000000000000011102230246251565404236316680908203125",      /* half-way to the next */
        "1.00000000000000011102230246251565404236316680908203124",
        "1.00000000000000011102230246251565404236316680908203126",
        "2.4703282292062327208e-324", "2.4703282292062328e-324", "4.9406564584124654e-324",
        "2.2250738585072011e-308", "2.2250738585072014e-308", "1.7976931348623158e308",
        "1.7976931348623159e308", "1e309", "-1e400", "1e-400", "1e-99999999999999999999",
        "0e99999999999999999999", "123456789012345678901234567890", "8.5e-320", "1e22", "1e23",
        "0.000000000000000000000000000000000000000000000000000000000000001e63",
        "1.000000000000000000e+00", "5.000000000000000000e-01", "3.333333333333333148e-01",
        "100000000000000000000000000000000000000000000000000000000000000000e-60", "6929495644600919.5",
        "+1.5", "  2.5", "\t-.5", "5.", "1e5", "1E+5", "-0", "0.0",
    };
    (void)state;
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        char *end;
        double x = ss_number_parse(text[i], &end), should = strtod(text[i], NULL);
        if (memcmp(&x, &should, sizeof x) != 0 || *end != '\0')
            fail_msg("%s read as %.17g, not %.17g", text[i], x, should);
    }
}

static void
stops_where_the_number_ends(void **state)
{
    static const struct { const char *text; size_t length; } row[] = {
        { "1.5x", 3 }, { "1,5", 1 }, { "1e", 1 }, { "1e+", 1 }, { "0x10", 1 }, { "1.e3 ", 4 },
        { "", 0 }, { "-", 0 }, { ".", 0 }, { "e5", 0 }, { "inf", 0 }, { "nan", 0 }, { " ", 0 },
        { "-.e1", 0 }, { "1..2", 2 }, { "1-2", 1 },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char *end;
        ss_number_parse(row[i].text, &end);
        if ((size_t)(end - row[i].text) != row[i].length)
            fail_msg("'%s' ends at %d", row[i].text, (int)(end - row[i].text));
    }
}

static void
does_not_care_about_the_locale(void **state)
{
    char text[SS_NUMBER_MAX];
    const char *made = getenv("LOCALES");       /* a folder with de_DE, by run.sh */
    (void)state;
    if (made != NULL)
        setenv("LOCPATH", made, 1);
    int found = setlocale(LC_ALL, "de_DE.UTF-8") != NULL && localeconv()->decimal_point[0] == ',';
    if (!found) {
        print_message("skipped: no locale with a decimal comma is installed\n");
        skip();
    }
    ss_number_format(text, 1234.5);
    double fast = ss_number_parse("0.25", NULL), slow = ss_number_parse("8.5e-320", NULL);
    setlocale(LC_ALL, "C");
    assert_string_equal(text, "1234.5");
    assert_true(fast == 0.25 && slow == 8.5e-320);
}

/* A number longer than its room is written otherwise, not cut. */
static void
a_fixed_number_is_never_cut(void **state)
{
    static const double x[] = { 0, 99.98, -1e20, 1.5e28, -1e29, 1e40, -1.25e300, DBL_MAX, DBL_MIN };
    (void)state;
    for (size_t i = 0; i < sizeof x / sizeof *x; i++)
        for (int decimals = 0; decimals <= 40; decimals += 2) {
            char text[SS_NUMBER_MAX];
            double least = 0.5000001 * pow(10, -decimals);
            assert_true(fabs(ss_number_parse(ss_number_fixed(text, x[i], decimals), NULL) - x[i])
                        <= fmax(least, 1e-8 * fabs(x[i])));
        }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(writes_the_fewest_digits_of_any_bit_pattern),
        cmocka_unit_test(writes_the_extremes),
        cmocka_unit_test(lays_numbers_out_as_percent_g_does),
        cmocka_unit_test(reads_any_number_of_digits_as_strtod_does),
        cmocka_unit_test(reads_fixed_decimals),
        cmocka_unit_test(reads_hard_cases),
        cmocka_unit_test(stops_where_the_number_ends),
        cmocka_unit_test(a_fixed_number_is_never_cut),
        cmocka_unit_test(does_not_care_about_the_locale),
    };
    return cmocka_run_group_tests_name("number", tests, NULL, NULL);
}
