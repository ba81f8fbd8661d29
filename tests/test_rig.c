/* test_rig.c -- the independent simulator of rig.h, against events of the paper's scenes by other programs,
 * which were checked with 34 digits. */
#include <math.h>
#include <string.h>
#include "rig.h"
#include "unit.h"

typedef struct known {
    const char *what;
    long double f_s, f_k, d, K_y, c;
    int is_total;
    long double end;
    size_t events;              /* after t = 0 */
    long double last;           /* [s] of the last of them; 0: not known */
} known;

static const known table[] = {
    { "coulomb", 1.28L, 1.28L, 0, 0, 0, 0, 10, 100, 9.920291043500L },
    { "coulomb, f_s 1.30", 1.30L, 1.10L, 0, 0, 0, 0, 10, 100, 9.891359409654L },
    { "coulomb, f_s 1.35", 1.35L, 1.10L, 0, 0, 0, 0, 10, 100, 9.892812287267L },
    { "coulomb, d 5", 1.28L, 1.28L, 5, 0, 0, 0, 10, 100, 9.941036060042L },
    { "compliant, c 80", 1.28L, 1.28L, 0, 209900, 80, 0, 10, 151, 0 },
    { "compliant, c 25", 1.28L, 1.28L, 0, 209900, 25, 0, 10, 193, 0 },
    { "compliant, c 25, total", 1.28L, 1.28L, 0, 209900, 25, 1, 10, 193, 0 },
    { "compliant, c 80, 100 s", 1.28L, 1.28L, 0, 209900, 80, 1, 100, 1951, 0 },
};

static rig
rig_of(const known *k)
{
    return (rig){ .m = 2.42L, .k = 2310, .d = k->d, .f_k = k->f_k, .f_s = k->f_s, .is_elastic = k->K_y > 0,
                  .is_total = k->is_total, .K_y = k->K_y, .c = k->c, .n_harmonics = 1, .A = { 0.0006L }, .f = { 2.5L } };
}

static void
has_the_published_events(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        rig r = rig_of(&table[i]);
        rig_motion m;
        assert_true(rig_run(&m, &r, table[i].end, 100000));
        if (m.n - 1 != table[i].events)
            fail_msg("%s: %zu events", table[i].what, m.n - 1);
        if (table[i].last > 0 && fabsl(m.piece[m.n - 1].t - table[i].last) > 1e-12L)
            fail_msg("%s: the last at %.15Lf", table[i].what, m.piece[m.n - 1].t);
        rig_free(&m);
    }
}

/* x and v are continuous at every event; a and f obey the equation of motion between. */
static void
obeys_the_equation_of_motion(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        rig r = rig_of(&table[i]);
        rig_motion m;
        assert_true(rig_run(&m, &r, table[i].end, 100000));
        for (size_t j = 1; j < m.n; j++) {
            double before[4], after[4];
            size_t at = j - 1;
            long double t = m.piece[j].t;
            rig_at(&m, nextafterl(t, 0), &at, before);
            rig_at(&m, t, &at, after);
            assert_true(at >= j || m.piece[at].t == t);
            assert_true(fabs(before[0] - after[0]) < 1e-15 && fabs(before[1] - after[1]) < 1e-11);
            if (m.piece[j].mode != 0)
                assert_true(fabs(after[3] - m.piece[j].mode * (double)r.f_k) < 1e-12);
        }
        rig_free(&m);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(has_the_published_events),
        cmocka_unit_test(obeys_the_equation_of_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
