/* test_bernstein.c -- the first zero of a guard in a step, for guards whose zeros are known.
 *
 * A guard is given as a polynomial by its factors, so its zeros are known without computing them, and
 * whose Taylor series the library has.  Three errors and no fourth:
 * blur, the width over which the guard is lost in the rounding of its coefficients, rounding of the
 * result, and the width 2^-50 that an event at the start is given. */
#include <float.h>
#include <math.h>
#include <stdint.h>

#include "motion/bernstein.h"
#include "random_scene.h"
#include "unit.h"

enum { MOST = 9 };

/* scale times the product of (x - zero[i]), plus lift, at x = s / h */
typedef struct product {
    double scale, lift;
    int n;
    double zero[MOST];
} product;

/* Taylor coefficients at x, of order 0 to most: each factor multiplies the series. */
static void
expand(const product *p, long double x, int most, long double c[])
{
    for (int i = 0; i <= most; i++)
        c[i] = i == 0 ? p->scale : 0;
    for (int k = 0; k < p->n; k++)
        for (int i = most; i >= 0; i--)
            c[i] = c[i] * (x - p->zero[k]) + (i > 0 ? c[i - 1] : 0);
    c[0] += p->lift;
}

static int
find_by(int degree, const product *p, double level, int either_side, double h, double *x,
        int *unresolved)
{
    step_guard g = { .level = level, .either_side = either_side, .h = h };
    *unresolved = 0;
    double c[MOST_DEGREE + 1];
    long double exact[MOST_DEGREE + 1] = { 0 };
    expand(p, 0, degree, exact);
    for (int i = 0; i <= degree; i++)
        c[i] = (double)exact[i];
    if (!either_side && ss_guard_is_clear(&g, degree, c))
        return 0;
    ss_guard_by_series(&g, degree, c);
    int found = ss_first_zero(&g, x, unresolved);
    *x /= h;
    return found;
}

static int
find(const product *p, double level, int either_side, double h, double *x, int *unresolved)
{
    return find_by(MOST, p, level, either_side, h, x, unresolved);
}

/* Blur by the largest coefficient and the slope at the zero: coefficients are sums of differences, of
 * which those of order i are at most 2^i of the largest and come 4 over i times, each rounded by
 * half an ulp, which makes 3^4 halves; 2^-50 is what is taken for undecided. */
#define BLUR(largest, slope) ((81 * DBL_EPSILON / 2 + 0x1p-50) * (largest) / (slope))

static const struct row {
    const char *what;
    product p;
    double level;
    int either_side, found;
    double x, blur;
} row[] = {
    { "no zero", { 1, 1, 2, { .5, .5 } }, 0, 0, 0, 0, 0 },
    { "a minimum just above 0", { 1, 1e-14, 2, { .5, .5 } }, 0, 0, 0, 0, 0 },
    { "a minimum just below 0", { 1, 0, 2, { .5 - 1e-6, .5 + 1e-6 } }, 0, 0, 1, .5 - 1e-6,
      BLUR(.25, 2e-6) },
    { "a falling line", { -1, 0, 1, { .25 } }, 0, 0, 1, .25, BLUR(.75, 1) },
    { "a rising line", { 1, 0, 1, { -.25 } }, 0, 0, 0, 0, 0 },
    { "two zeros", { 1, 0, 2, { .3, .4 } }, 0, 0, 1, .3, BLUR(1, .1) },
    { "three zeros", { -1, 0, 3, { .2, .3, .7 } }, 0, 0, 1, .2, BLUR(1, .05) },
    { "two close and a third", { -1, 0, 3, { .6, .6 + 1e-5, .7 } }, 0, 0, 1, .6,
      BLUR(1, 1e-6) },
    { "two close after a first", { -1, 0, 3, { .1, .6, .6 + 1e-5 } }, 0, 0, 1, .1, BLUR(1, .25) },
    { "nine zeros", { -1, 0, 9, { .1, .2, .3, .4, .5, .6, .7, .8, .9 } }, 0, 0, 1, .1,
      BLUR(4e-4, 4e-4) },
    { "eight zeros and none in the step", { 1, 0, 8, { -.1, -.1, -.2, -.3, 1.1, 1.1, 1.2, 2 } }, 0, 0,
      0, 0, 0 },
    { "a start at 0 that rises", { -1, 0, 2, { 0, .5 } }, 0, 0, 1, .5, BLUR(.5, .5) },
    { "a start at 0 that rises, rounded below 0", { -1, -1e-17, 2, { 0, .5 } }, 0, 0, 1, .5,
      BLUR(.5, .5) },
    { "a start at 0 that rises to the end", { 1, 0, 1, { 0 } }, 0, 0, 0, 0, 0 },
    { "a start at 0 with a triple zero", { 1, 0, 3, { 0, 0, 0 } }, 0, 0, 0, 0, 0 },
    { "a start at 0 that falls", { -1, 0, 1, { 0 } }, 0, 0, 1, 0, BLUR(1, 1) },
    { "a start at 0 that falls and rises", { 1, 0, 2, { 0, .5 } }, 0, 0, 1, 0, BLUR(.5, .5) },
    { "just after the start", { -1, 0, 1, { 1e-9 } }, 0, 0, 1, 1e-9, BLUR(1, 1) },
    { "just before the end", { -1, 0, 1, { 1 - 1e-9 } }, 0, 0, 1, 1 - 1e-9, BLUR(1, 1) },
    { "at the end: the next step's", { -1, 0, 1, { 1 } }, 0, 0, 0, 0, 0 },
    { "just after the end", { -1, 0, 1, { 1 + 1e-9 } }, 0, 0, 0, 0, 0 },
    { "a dip that ends at 0", { 1, 0, 2, { .5, 1 } }, 0, 0, 1, .5, BLUR(.5, .5) },
    { "the upper limit", { 1.5, 0, 1, { 0 } }, 1, 1, 1, 2. / 3, BLUR(2.5, 1.5) },
    { "the lower limit", { -1.5, 0, 1, { 0 } }, 1, 1, 1, 2. / 3, BLUR(2.5, 1.5) },
    { "both limits, the lower first", { -16, 0, 3, { 0, .5, 1 } }, .5, 1, 1, 0.081217282358338486,
      BLUR(2, 4) },
    { "from the limit to the other", { 2.5, -1, 1, { 0 } }, 1, 1, 1, .8, BLUR(2.5, 2.5) },
    { "within the limits", { 4, 0, 2, { 0, 1 } }, 1.0001, 1, 0, 0, 0 },
};

static void
finds_known_zeros(void **unused)
{
    static const double h[] = { 1, 1e-9, 3e7 };
    (void)unused;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        for (size_t k = 0; k < sizeof h / sizeof *h; k++) {
            const struct row *r = &row[i];
            int unresolved;
            double x, allow = r->blur + 4 * DBL_EPSILON * r->x + 0x1p-50;
            int found = find(&r->p, r->level, r->either_side, h[k], &x, &unresolved);
            if (found != r->found || unresolved != 0)
                fail_msg("%s: found %d, unresolved %d", r->what, found, unresolved);
            if (found && !(fabs(x - r->x) <= allow))
                fail_msg("%s: %.17g, not %.17g +- %.1e", r->what, x, r->x, allow);
        }
}

static void
says_where_rounding_decides(void **unused)
{
    const struct { product p; int found; double x, blur; } touch[] = {
        { { 1, 0, 2, { .3, .3 } }, 0, 0, 0 },               /* inside */
        { { 1, 0, 2, { .5, .5 } }, 0, 0, 0 },               /* where the step is divided */
        { { 1, 0, 2, { 1, 1 } }, 0, 0, 0 },                 /* at the end */
        { { 1, 1e-17, 2, { .3, .3 } }, 0, 0, 0 },
        { { 1, -1e-17, 2, { .3, .3 } }, 0, 0, 0 },
        { { 1, 0, 4, { .3, .3, .7, .7 } }, 0, 0, 0 },
        { { -1, 0, 3, { .3, .3, .7 } }, 1, .7, BLUR(1, .16) },      /* the zero after it is found */
        { { -1, 0, 3, { .5, .5, .5 } }, 1, .5, cbrt(BLUR(.125, 1)) }    /* three zeros or one */
    };
    (void)unused;
    for (size_t i = 0; i < sizeof touch / sizeof *touch; i++) {
        int unresolved;
        double x;
        int found = find(&touch[i].p, 0, 0, 1, &x, &unresolved);
        assert_int_equal(unresolved, 1);
        assert_int_equal(found, touch[i].found);
        assert_true(!found || fabs(x - touch[i].x) <= touch[i].blur + DBL_EPSILON);
    }
}

/* Zeros in [-.5, 1.5], some of them in close pairs; the sign is that of a mode that lasts at 0. */
static product
random_product(rng *s)
{
    product p = { .n = 1 + (int)(MOST * uniform(s)) };
    double at_0 = 1;
    for (int i = 0; i < p.n; i++) {
        p.zero[i] = 2 * uniform(s) - .5;
        if (i > 0 && uniform(s) < .3)
            p.zero[i] = p.zero[i - 1] + pow(10, -6 * uniform(s));
        at_0 *= -p.zero[i];
    }
    p.scale = at_0 > 0 ? 1 : -1;
    return p;
}

/* A series is known to the rounding of its terms, 14 ulp of the sum of their sizes. */
static void
finds_zeros_of_series(void **unused)
{
    static const int degree[] = { MOST, 12, 20, MOST_DEGREE };
    rng s = { 2 };
    int hits = 0, misses = 0;
    (void)unused;
    for (int i = 0; i < 40000; i++) {
        product p = random_product(&s);
        double first = 2, second = 2, slope = 1, size = 1, near = 1, x;
        int unresolved;
        for (int k = 0; k < p.n; k++) {
            double z = p.zero[k];
            second = z <= 0 || z > second ? second : z < first ? first : z;
            first = z > 0 && z < first ? z : first;
            size *= 1 + fabs(z);
            near = fmin(near, fmin(fabs(z), fabs(z - 1)));
        }
        for (int k = 0; k < p.n; k++)
            slope *= p.zero[k] == first ? 1 : fabs(p.zero[k] - first);
        double allow = 2 * (14 * DBL_EPSILON + 0x1p-50) * size / slope + 8 * DBL_EPSILON;
        if (allow > (second - first) / 10 || near < 1e-4)
            continue;
        int found = find_by(degree[i % 4], &p, 0, 0, 1, &x, &unresolved);
        assert_int_equal(found, first < 1);
        if (found && !(fabs(x - first) <= allow))
            fail_msg("number %d: %.17g, not %.17g +- %.1e", i, x, first, allow);
        hits += found;
        misses += !found;
    }
    assert_true(hits > 4000 && misses > 400);
}

static void
refuses_what_is_not_finite(void **unused)
{
    static const double bad[] = { NAN, INFINITY };
    (void)unused;
    for (int i = 0; i <= MOST_DEGREE; i++)
        for (int k = 0; k < 2; k++) {
            step_guard g = { .h = 1 };
            double s, broken[MOST_DEGREE + 1] = { 1 };
            int unresolved = 0;
            ss_guard_by_series(&g, MOST_DEGREE, broken);
            assert_int_equal(ss_first_zero(&g, &s, &unresolved), 0);
            broken[i] = bad[k];
            ss_guard_by_series(&g, MOST_DEGREE, broken);
            assert_int_equal(ss_first_zero(&g, &s, &unresolved), -1);
        }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_known_zeros),
        cmocka_unit_test(says_where_rounding_decides),
        cmocka_unit_test(finds_zeros_of_series),
        cmocka_unit_test(refuses_what_is_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
