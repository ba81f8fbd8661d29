/* test_chaos.c -- Lyapunov exponents, multipliers and stroboscopic points against a second way.
 *
 * Truth are two neighbouring motions of the oracle, which shares no code with the library: closed forms
 * between events, in long double.  Over some tens of cycles a chaotic motion can be followed in both, and the
 * growth of a difference is compared digit by digit, not in the mean. */
#include <math.h>

#include "oracle.h"
#include "near.h"
#include "shipped.h"
#include "unit.h"

#define BIT(m) (1u << (m))

typedef struct place {
    double x, v;
} place;

/* One cycle on, by the oracle. */
static place
map(const ss_scene *scene, place from)
{
    ss_scene s = *scene;
    long double out[3], T = 1 / (long double)s.base_frequency;
    s.x0 = from.x;
    s.v0 = from.v;
    oracle *o = oracle_new(&s, (double)T);
    size_t piece = o->n - 1;
    while (piece > 0 && o->piece[piece].t0 > T)
        piece--;
    oracle_at(o, piece, T, out);
    oracle_free(o);
    return (place){ (double)out[0], fabsl(out[1]) < 1e-15L ? 0 : (double)out[1] };
}

static ss_scene
rig(double r)
{
    ss_scene s = read_shipped_named("chaos");
    s.base_frequency = r;
    return s;
}

static ss_status
find(ss_steady *out, const ss_scene *s, const ss_steady_opts *opts)
{
    ss_error err = { 0 };
    ss_status st = ss_steady_find(out, s, opts, &err);
    if (st != SS_OK && st != SS_EDATA)
        fail_msg("%s", err.text);
    return st;
}

/* --- exponents ------------------------------------------------------------------------------- */

/* The growth of a difference, in the library's units of x and v, over `cycles` after so many to settle and
 * so many to turn it. */
static double
growth(const ss_scene *s, int settle, int turn, int cycles)
{
    double sum = 0, unit[2] = { 2, 4 * M_PI }, d[2] = { 1, 1 };
    place at = { s->x0, s->v0 };
    for (int i = 0; i < settle; i++)
        at = map(s, at);
    for (int i = 0; i < turn + cycles; i++) {
        const double small = 1e-7;
        place moved = { at.x + small * d[0] * unit[0], at.v == 0 ? 0 : at.v + small * d[1] * unit[1] };
        place next = map(s, at), end = map(s, moved);
        d[0] = (end.x - next.x) / small / unit[0];
        d[1] = (end.v - next.v) / small / unit[1];
        double size = hypot(d[0], d[1]);
        sum += i < turn ? 0 : log(size);
        d[0] /= size;
        d[1] /= size;
        at = next;
    }
    return sum * s->base_frequency / cycles;
}

static void
exponents_are_those_of_two_neighbours(void **state)
{
    static const double r[] = { 0.56, 0.58, 0.6, 0.62, 0.64 };
    (void)state;
    for (size_t i = 0; i < sizeof r / sizeof *r; i++) {
        ss_scene s = rig(r[i]);
        ss_steady_opts opts;
        ss_steady_opts_init(&opts, sizeof opts);
        ss_steady at;
        opts.measures = BIT(SS_LYAPUNOV) | BIT(SS_LYAPUNOV_ERROR);
        opts.settle = 20;               /* and 2 to turn the difference, and 20 */
        double truth = growth(&s, 20, 2, 20);
        assert_int_equal(find(&at, &s, &opts), SS_EDATA);
        near("exponent", at.value[SS_LYAPUNOV], truth, 1e-5);
        opts.method = "taylor";
        assert_int_equal(find(&at, &s, &opts), SS_EDATA);
        near("of a series, by differences", at.value[SS_LYAPUNOV], truth, 1e-5);
        opts.method = "rk8pd";          /* by differences, without saltation */
        assert_int_equal(find(&at, &s, &opts), SS_EDATA);
        near("by differences", at.value[SS_LYAPUNOV], truth, 1e-4);
    }
}

/* An elastic contact has a third direction, along which a stick does not forget, and its deflection is small
 * beside x. */
static void
contacts_have_their_multipliers_by_all_ways(void **state)
{
    static const char *const method[] = { "exact", "taylor", "rk8pd" };        /* the last two by differences */
    (void)state;
    for (double r = 0.55; r < 0.61; r += 0.01) {
        ss_scene s = rig(r);
        ss_steady_opts opts;
        ss_steady_opts_init(&opts, sizeof opts);
        ss_steady at[3];
        ss_scene_set_text(&s, "model", "compliant", NULL);
        ss_scene_set(&s, "contact_stiffness", 300, NULL);
        ss_scene_set(&s, "contact_damping", 0.02, NULL);
        opts.measures = BIT(SS_LYAPUNOV) | BIT(SS_FLOQUET) | BIT(SS_FLOQUET_ANGLE);
        for (int i = 0; i < 3; i++) {
            opts.method = method[i];
            assert_int_equal(find(&at[i], &s, &opts), SS_OK);
            near("multiplier", at[i].value[SS_FLOQUET], at[0].value[SS_FLOQUET], 3e-6);
            near("angle", at[i].value[SS_FLOQUET_ANGLE], at[0].value[SS_FLOQUET_ANGLE], 1e-5);
        }
    }
}

/* Estimates from different starts scatter as their standard errors say. */
static void
errors_are_honest(void **state)
{
    enum { N = 30 };
    double value[N], mean = 0, error = 0, scatter = 0;
    (void)state;
    for (int i = 0; i < N; i++) {
        ss_scene s = rig(0.6);
        ss_steady_opts opts;
        ss_steady_opts_init(&opts, sizeof opts);
        ss_steady at;
        s.x0 = 1.9 + 0.01 * i;
        opts.measures = BIT(SS_LYAPUNOV) | BIT(SS_LYAPUNOV_ERROR);
        opts.max_cycles = 1000;
        opts.search = SS_SEARCH_SIMULATE;
        assert_int_equal(find(&at, &s, &opts), SS_EDATA);
        value[i] = at.value[SS_LYAPUNOV];
        mean += value[i] / N;
        error += pow(at.value[SS_LYAPUNOV_ERROR], 2) / N;
    }
    for (int i = 0; i < N; i++)
        scatter += pow(value[i] - mean, 2) / (N - 1);
    print_message("scatter %.2g, standard error %.2g\n", sqrt(scatter), sqrt(error));
    /* chi^2 of 29 degrees of freedom leaves 0.5 ... 1.7 once in 10^3 */
    assert_true(scatter / error > 0.5 && scatter / error < 1.7);
}

/* Without friction two incommensurate frequencies make a torus: its exponent is 0. */
static void
a_torus_has_none(void **state)
{
    ss_scene s = rig((sqrt(5) + 1) / 2);
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_steady at;
    (void)state;
    s.friction = s.static_friction = 0;
    opts.measures = BIT(SS_LYAPUNOV) | BIT(SS_LYAPUNOV_ERROR);
    opts.max_cycles = 2000;
    assert_int_equal(find(&at, &s, &opts), SS_EDATA);
    assert_true(at.value[SS_PERIOD] == 0);
    near("exponent", at.value[SS_LYAPUNOV], 0, 1e-3);
    assert_true(fabs(at.value[SS_LYAPUNOV]) <= 3 * at.value[SS_LYAPUNOV_ERROR]);
}

/* --- periods --------------------------------------------------------------------------------- */

/* The points of the strobe go over into each other, and a difference at one grows by the multiplier. */
static void
points_and_multipliers_are_those_of_the_map(void **state)
{
    static const struct { double r; int period; } row[] = { { 0.52, 1 }, { 0.54, 2 }, { 0.548, 2 },
        { 0.7, 3 } };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_scene s = rig(row[i].r);
        ss_steady_opts opts;
        ss_steady_opts_init(&opts, sizeof opts);
        ss_strobe strobe[64];
        ss_steady at = { .strobe = strobe };
        opts.measures = BIT(SS_PERIOD) | BIT(SS_FLOQUET) | BIT(SS_FLOQUET_ANGLE) | BIT(SS_LYAPUNOV)
            | BIT(SS_X_PHASE);
        opts.tol = 1e-12;
        opts.strobe = 64;
        assert_int_equal(find(&at, &s, &opts), SS_OK);
        assert_int_equal(at.value[SS_PERIOD], row[i].period);
        assert_int_equal(at.n_strobes, row[i].period);
        assert_true(strobe[0].x == at.value[SS_X_PHASE]);
        for (int k = 0; k < row[i].period; k++) {
            place next = map(&s, (place){ strobe[k].x, strobe[k].v });
            ss_strobe there = strobe[(k + 1) % row[i].period];
            assert_true(fabs(next.x - there.x) < 1e-11 && fabs(next.v - there.v) < 1e-10);
        }
        s.x0 = strobe[0].x;
        s.v0 = strobe[0].v;
        double grows = growth(&s, 0, 12, row[i].period);
        near("multiplier", at.value[SS_FLOQUET], exp(grows * row[i].period / row[i].r), 1e-6);
        near("exponent", at.value[SS_LYAPUNOV], grows, 1e-6);
    }
}

/* Near r = 2/3 a period of 3 cycles stands beside a chaotic motion that comes near it again and again. */
static void
periods_that_are_not_approached_are_not_found(void **state)
{
    (void)state;
    for (double r = 0.655; r < 0.685; r += 0.0029) {
        ss_scene s = rig(r);
        ss_steady_opts opts;
        ss_steady_opts_init(&opts, sizeof opts);
        ss_steady shot, run;
        opts.max_cycles = 300;
        assert_int_equal(find(&shot, &s, &opts), SS_EDATA);
        opts.search = SS_SEARCH_SIMULATE;
        assert_int_equal(find(&run, &s, &opts), SS_EDATA);
        assert_true(shot.value[SS_PERIOD] == run.value[SS_PERIOD]);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exponents_are_those_of_two_neighbours),
        cmocka_unit_test(contacts_have_their_multipliers_by_all_ways),
        cmocka_unit_test(errors_are_honest),
        cmocka_unit_test(a_torus_has_none),
        cmocka_unit_test(points_and_multipliers_are_those_of_the_map),
        cmocka_unit_test(periods_that_are_not_approached_are_not_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
