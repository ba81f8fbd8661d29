/* test_catalogue.c -- the numbers of stickslip-catalogue(7): shipped scenes against published results.
 *
 * Truth is each source's formula, evaluated here; what is compared and how closely is printed, and the
 * page states the bounds that are asserted. */
#include <math.h>

#include "extremes/runs.h"
#include "near.h"
#include "shipped.h"
#include "unit.h"

#define BIT(m) (1u << (m))

static run
run_of(const ss_scene *scene)
{
    run r = run_with(scene, NULL, 1e-12, 0);
    if (r.status != SS_OK)
        fail_msg("%s", r.err.text);
    return r;
}

static ss_steady
steady_of(const ss_scene *scene)
{
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_steady out;
    ss_error err = { 0 };
    opts.tol = 1e-12;
    opts.measures = BIT(SS_STOPS) | BIT(SS_STICK_FRACTION) | BIT(SS_AMPLITUDE) | BIT(SS_X_MAX)
        | BIT(SS_PERIOD) | BIT(SS_FLOQUET) | BIT(SS_LYAPUNOV);
    if (ss_steady_find(&out, scene, &opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    return out;
}

/* --- Den Hartog (1931): no stops ------------------------------------------------------------ */

static void
den_hartog_amplitude(void **state)
{
    static const double row[][2] = { { .8, .5 }, { 1.25, .5 }, { 2, .3 } };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        double r = row[i][0], beta = row[i][1];
        double U = sin(M_PI / r) / (r * (1 + cos(M_PI / r))), V = 1 / (1 - r * r);
        ss_scene s = read_shipped_named("den-hartog");
        s.base_frequency = r;
        s.friction = beta;
        ss_steady at = steady_of(&s);
        near("amplitude", at.value[SS_X_MAX], sqrt(V * V - beta * beta * U * U), 1e-13);
        assert_true(at.value[SS_STOPS] == 0 && at.value[SS_PERIOD] == 1);
    }
}

/* --- two stops a cycle ----------------------------------------------------------------------- */

/* In units of Z_e, with tau = Omega t: r, f_k / (k Z_e), f_s / (k Z_e), and where a slip leaves and
 * arrives. */
typedef struct two_stops {
    long double r, f_k, f_s, leaves, arrives;
} two_stops;

/* The mass sticks at -a until the spring reaches f_s, slips to the right until it stands, and is held
 * there: the place, from the solution of the linear equation of slip. */
static long double
slip_from(two_stops *q, long double a)
{
    long double V = 1 / (1 - q->r * q->r), from = -acosl(q->f_s - a);
    long double A = -a - V * cosl(from) + q->f_k, B = q->r * V * sinl(from), low = .01L, high;
#define SPEED(s) (-V * sinl(from + (s)) + (B * cosl((s) / q->r) - A * sinl((s) / q->r)) / q->r)
    while (SPEED(low + .01L) > 0)
        low += .01L;
    high = low + .01L;
    for (int i = 0; i < 70; i++) {
        long double middle = (low + high) / 2;
        if (SPEED(middle) > 0)
            low = middle;
        else
            high = middle;
    }
#undef SPEED
    q->leaves = from;
    q->arrives = from + low;
    return V * cosl(q->arrives) - q->f_k + A * cosl(low / q->r) + B * sinl(low / q->r);
}

/* The symmetric motion: a slip from -a to a.  Newton's method from a guess. */
static long double
symmetric(two_stops *q, long double a)
{
    for (int i = 0; i < 20; i++) {
        long double rest = slip_from(q, a) - a, slope = (slip_from(q, a + 1e-8L) - a - 1e-8L - rest) / 1e-8L;
        a -= rest / slope;
    }
    assert_true(fabsl(slip_from(q, a) - a) < 1e-15L);
    return a;
}

/* How a slip passes on a change of where it starts; a cycle has two. */
static long double
slope_at(two_stops *q, long double a)
{
    return (slip_from(q, a + 1e-6L) - slip_from(q, a - 1e-6L)) / 2e-6L;
}

static void
two_stops_a_cycle(void **state)
{
    ss_scene s = read_shipped_named("den-hartog-stops");
    two_stops q = { .r = s.base_frequency, .f_k = s.friction, .f_s = s.friction };
    (void)state;
    long double a = symmetric(&q, .1L), slope = slope_at(&q, a);
    ss_steady at = steady_of(&s);
    near("amplitude", at.value[SS_AMPLITUDE], (double)slip_from(&q, a), 1e-13);
    near("stick", at.value[SS_STICK_FRACTION], 1 - (double)((q.arrives - q.leaves) / M_PI), 1e-13);
    near("floquet", at.value[SS_FLOQUET], (double)(slope * slope), 1e-10);
    assert_true(at.value[SS_STOPS] == 2);
}

/* --- Hong and Liu (2000): how many stops a cycle ---------------------------------------------- */

static int
count_stops(const ss_sweep_row *row, void *user)
{
    double stops = row->steady.value[SS_STOPS];
    size_t *seen = user;
    assert_true(stops >= 0 && stops < 64 && stops == floor(stops));
    seen[(int)stops]++;
    return 0;
}

static void
stops_come_in_the_published_numbers(void **state)
{
    ss_scene s = read_shipped_named("den-hartog-stops");
    ss_axis axis[2];
    ss_error err = { 0 };
    size_t seen[64] = { 0 };
    (void)state;
    assert_int_equal(ss_axis_parse(&axis[0], "base_frequency=0.05:0.95:91", &err), SS_OK);
    assert_int_equal(ss_axis_parse(&axis[1], "friction=0.02:0.98:49", &err), SS_OK);
    ss_steady_opts how;
    ss_steady_opts_init(&how, sizeof how);
    ss_sweep_opts opts = { .size = sizeof opts, .steady = &how, .axis = axis, .n_axes = 2, .shards = 1,
                           .threads = 1, .sink = count_stops, .user = seen };
    how.measures = BIT(SS_STOPS);
    assert_int_equal(ss_sweep_run(&s, &opts, &err), SS_OK);
    for (int i = 0; i < 64; i++) {
        int published = i == 0 || i == 1 || (i % 2 == 0 && i <= 14);
        if (seen[i] > 0)
            print_message("%d stops: %zu\n", i, seen[i]);
        assert_true(published || seen[i] == 0);
        assert_true(seen[i] > 0 || i % 2 == 1 || i > 10);
    }
}

/* The r between these where the symmetric motion, of about this amplitude, loses its stability: a slip turns
 * a change into its opposite. */
static long double
broken_symmetry(two_stops *q, long double a, long double low, long double high)
{
    for (int i = 0; i < 40; i++) {
        q->r = (low + high) / 2;
        a = symmetric(q, a);
        if (slope_at(q, a) > -1)
            low = q->r;
        else
            high = q->r;
    }
    return low;
}

/* --- static above kinetic friction: Shaw (1986) ------------------------------------------------ */

static void
symmetry_breaks(void **state)
{
    ss_scene s = read_shipped_named("shaw");
    two_stops q = { .r = .45L, .f_k = s.friction, .f_s = s.static_friction };
    (void)state;
    /* on the symmetric side */
    long double a = symmetric(&q, 1.31L), slope = slope_at(&q, a);
    s.base_frequency = .45;
    ss_steady at = steady_of(&s);
    near("amplitude", at.value[SS_AMPLITUDE], (double)a, 1e-13);
    near("max|x|", at.value[SS_X_MAX], (double)a, 1e-13);
    near("floquet", at.value[SS_FLOQUET], (double)(slope * slope), 1e-9);

    long double low = broken_symmetry(&q, a, .45L, .47L);
    near("r", (double)low, .459753, 5e-7);
    for (int side = -1; side <= 1; side += 2) {
        s.base_frequency = (double)low + side * 1e-4;
        at = steady_of(&s);
        assert_true(at.value[SS_STOPS] == 2 && at.value[SS_FLOQUET] < 1);
        assert_int_equal(at.value[SS_X_MAX] - at.value[SS_AMPLITUDE] > 1e-3, side > 0);
    }

    /* with f_s just above f_k only near r = 1/2 */
    s.static_friction = .305;
    for (int i = 0; i < 3; i++) {
        s.base_frequency = .47 + .03 * i;
        at = steady_of(&s);
        assert_int_equal(at.value[SS_X_MAX] - at.value[SS_AMPLITUDE] > 1e-3, i == 1);
    }
}

static void
unsymmetric_motions_come_in_pairs(void **state)
{
    ss_scene s = read_shipped_named("shaw");
    two_stops q = { .r = s.base_frequency, .f_k = s.friction, .f_s = s.static_friction };
    (void)state;
    long double a = 1.5L, b = 0, slopes;
    for (int i = 0; i < 1000; i++) {
        b = slip_from(&q, a);
        a = slip_from(&q, b);
    }
    slopes = slope_at(&q, a) * slope_at(&q, b);
    for (int side = -1; side <= 1; side += 2) {
        s.x0 = 2 * side;
        ss_steady at = steady_of(&s);
        near("amplitude", at.value[SS_AMPLITUDE], (double)(a + b) / 2, 1e-13);
        near("max|x|", at.value[SS_X_MAX], (double)fmaxl(a, b), 1e-13);
        near("floquet", at.value[SS_FLOQUET], (double)slopes, 1e-9);
        assert_true(at.value[SS_STOPS] == 2);
        s.duration = 10 / s.base_frequency;
        run r = run_of(&s);
        double most = 0, least = 0;
        for (size_t i = 0; i < r.n; i++) {
            most = fmax(most, r.sample[i].x);
            least = fmin(least, r.sample[i].x);
        }
        near("to one side", most, (double)(side > 0 ? fmaxl(a, b) : fminl(a, b)), 1e-11);
        near("to the other", -least, (double)(side > 0 ? fminl(a, b) : fmaxl(a, b)), 1e-11);
        run_free(&r);
    }
}

/* --- the way to chaos: the rig of Csernak and Licsko (2021) -------------------------------------- */

static void
chaos_begins_with_a_broken_symmetry(void **state)
{
    ss_scene s = read_shipped_named("chaos");
    two_stops q = { .r = .46L, .f_k = s.friction, .f_s = s.static_friction };
    (void)state;
    long double a = symmetric(&q, 1.76L), slope = slope_at(&q, a);
    s.base_frequency = .46;
    ss_steady at = steady_of(&s);
    near("amplitude", at.value[SS_AMPLITUDE], (double)a, 1e-13);
    near("floquet", at.value[SS_FLOQUET], (double)(slope * slope), 1e-9);
    near("lyapunov", at.value[SS_LYAPUNOV], (double)(q.r * logl(slope * slope)), 1e-9);
    long double low = broken_symmetry(&q, a, .46L, .47L);
    near("r", (double)low, .461652, 5e-7);
    for (int side = -1; side <= 1; side += 2) {
        s.base_frequency = (double)low + side * 1e-4;
        at = steady_of(&s);
        assert_int_equal(at.value[SS_X_MAX] - at.value[SS_AMPLITUDE] > 1e-3, side > 0);
    }
}

/* --- Csernak, Stepan and Shaw (2007): at half the natural frequency --------------------------- */

/* A motion that turns at x0 when tau = 0 slips as V cos tau + f_k + (x0 - V - f_k) cos 2 tau, stands at
 * x0 - 2 V when tau = pi and comes back to x0: all have the amplitude V = 4/3, and none attracts.  It
 * does not stop on its way while |x0 - V| <= 1/3 - f_k / (k Z_e). */
static void
motions_stand_side_by_side(void **state)
{
    ss_scene s = read_shipped_named("subharmonic");
    double room = 1. / 3 - s.friction;
    (void)state;
    for (int i = -9; i <= 9; i++) {
        s.x0 = 4. / 3 + i * .1 * room;
        ss_steady at = steady_of(&s);
        near("amplitude", at.value[SS_AMPLITUDE], 4. / 3, 1e-13);
        near("max|x|", at.value[SS_X_MAX], fmax(s.x0, 8. / 3 - s.x0), 1e-13);
        near("floquet", at.value[SS_FLOQUET], 1, 1e-9);
        assert_true(at.value[SS_STOPS] == 0 && at.value[SS_PERIOD] == 1);
    }
    s.x0 = 3;                           /* from outside it comes to the last of them */
    near("the last", steady_of(&s).value[SS_X_MAX], 4. / 3 + room, 1e-6);
}

/* --- without forcing --------------------------------------------------------------------------- */

static void
free_decay(void **state)
{
    ss_scene s = read_shipped_named("free-decay");
    run r = run_of(&s);
    double lost = 2 * s.friction / s.stiffness, half = M_PI * sqrt(s.mass / s.stiffness);
    size_t n = 0;
    (void)state;
    for (size_t i = 0; i < r.n_events; i++) {
        if (r.event[i].t == 0)
            continue;                   /* the start */
        n++;
        near("time of a turn", r.event[i].t, half * (double)n, 1e-12);
        near("place of a turn", r.event[i].x, (n % 2 ? -1 : 1) * (s.x0 - (double)n * lost), 1e-12);
        assert_int_equal(r.event[i].kind, n < 17 ? SS_REVERSE : SS_STICK);
    }
    assert_int_equal(n, 17);
    run_free(&r);
}

static void
pulled_slider(void **state)
{
    ss_scene s = read_shipped_named("pulled-slider");
    double U = s.base_velocity, drop = s.static_friction - s.friction, w = sqrt(s.stiffness / s.mass);
    double q = drop * w / (s.stiffness * U), slip = 2 * (M_PI - atan(q)) / w, fastest = 0;
    run r = run_of(&s);
    (void)state;
    assert_int_equal(r.n_events, 10);
    for (size_t i = 0; i + 1 < r.n_events; i++)
        near(i % 2 ? "stick" : "slip", r.event[i + 1].t - r.event[i].t,
             i % 2 ? 2 * drop / (s.stiffness * U) : slip, 1e-13);
    near("drop", s.stiffness * (U * (r.event[0].t - r.event[1].t) + r.event[1].x - r.event[0].x),
         2 * drop, 1e-14);
    s.settle = r.event[0].t;            /* the first slip, finely */
    s.duration = slip;
    s.rate = 1e6;
    run_free(&r);
    r = run_of(&s);
    for (size_t i = 0; i < r.n; i++)
        fastest = fmax(fastest, r.sample[i].v);
    near("greatest speed", fastest, U * (1 + sqrt(1 + q * q)), 1e-8 * fastest);
    run_free(&r);
}

static void
falling_friction(void **state)
{
    ss_scene s = read_shipped_named("leine");
    run r = run_of(&s);
    (void)state;
    assert_true(r.n_events >= 6);
    for (size_t i = 0; i + 2 < r.n_events; i++) {
        int stick = r.event[i].kind == SS_STICK;
        near(stick ? "stick" : "slip", r.event[i + 1].t - r.event[i].t,
             stick ? 7.705031769350 : 4.295999525480, 2e-12);
        near("period", r.event[i + 2].t - r.event[i].t, 12.001031294831, 2e-12);
    }
    run_free(&r);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(den_hartog_amplitude),
        cmocka_unit_test(two_stops_a_cycle),
        cmocka_unit_test(stops_come_in_the_published_numbers),
        cmocka_unit_test(symmetry_breaks),
        cmocka_unit_test(unsymmetric_motions_come_in_pairs),
        cmocka_unit_test(chaos_begins_with_a_broken_symmetry),
        cmocka_unit_test(motions_stand_side_by_side),
        cmocka_unit_test(free_decay),
        cmocka_unit_test(pulled_slider),
        cmocka_unit_test(falling_friction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
