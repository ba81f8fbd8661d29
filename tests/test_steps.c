/* Rate and state from velocity steps: friction against published digits, and recordings whose truth is known. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <stickslip.h>

#include "fit/slider.h"
#include "fit/wander.h"
#include "near.h"
#include "pulled_rock.h"
#include "uniform.h"
#include "unit.h"

#define STEPS_OPTS .size = sizeof(ss_steps_opts), .normal = -1

/* mu0 .6, k 1e-3/um, Dc 10 um, load 1 -> 10 um/s at 10 s; by two independent methods, all digits shown agree, and the
 * first eight are rsfmodel's. */
static void
slides_as_two_methods_say(void **state)
{
    static const double t[] = { 0, 10, 11, 12, 13, 14, 16, 40 }, a[] = { .005, .01 }, b[] = { .01, .005 };
    static const double truth[2][6] = {
        { .607204852468, .601866371928, .584009097426, .585630963968, .589981860446, .588487083179 },
        { .608392994345, .614628800246, .616633352407, .614514235827, .611525592465, .611512925466 } };
    double load[8], g[8];
    (void)state;
    for (int i = 0; i < 8; i++)
        load[i] = t[i] < 10 ? t[i] * 1e-6 : 10e-6 + (t[i] - 10) * 10e-6;
    for (int law = 0; law < 2; law++) {
        const slider s = { law, b[law] / a[law], 10e-6, 1e3 / a[law], 1e-6 };
        assert_int_equal(ss_slider_run(g, &s, t, load, 8, 1e-13), SS_OK);
        for (int i = 2; i < 8; i++)             /* 5e-13 of the digits, 40 Dc at 1e-13 of the speed, in a / Dc */
            near(law == 0 ? "aging" : "slip", 0.6 + a[law] * g[i], truth[law][i - 2], 1e-12);
    }
}

/* Below the critical stiffness, (b - a)/Dc, friction runs away. */
static void
a_soft_spring_runs_away(void **state)
{
    static const double t[] = { 0, 10, 60 }, load[] = { 0, 10e-6, 510e-6 };
    double g[3];
    (void)state;
    const slider soft = { 0, 2, 10e-6, 0.2 * 1e5, 1e-6 }, stiff = { 0, 2, 10e-6, 1.2 * 1e5, 1e-6 };
    assert_int_equal(ss_slider_run(g, &soft, t, load, 3, 1e-9), SS_EDATA);
    assert_int_equal(ss_slider_run(g, &stiff, t, load, 3, 1e-9), SS_OK);
}

/* Whitened noise of the right memory is white: AR(1) beside its closed form. */
static void
whitens_what_wanders(void **state)
{
    enum { N = 5 };
    const double t[N] = { 0, 1, 2.5, 3, 7 }, y[N] = { 1, .5, -2, .25, 3 };
    const wander by_time = { 1, 2, 0 }, by_rows = { 1, 2, 1 };
    double white[N], logarithms = 0;
    (void)state;
    double got = ss_wander_whiten(white, &by_time, t, y, N, 1);
    assert_true(fabs(white[0] - y[0]) < 1e-15);
    for (int i = 1; i < N; i++) {
        double keep = exp((t[i - 1] - t[i]) / 2), rest = 1 - keep * keep;
        logarithms += log(rest);
        assert_true(fabs(white[i] - (y[i] - keep * y[i - 1]) / sqrt(rest)) < 1e-14);
    }
    assert_true(fabs(got - logarithms) < 1e-14);
    ss_wander_whiten(white, &by_rows, t, y, N, 1);
    assert_true(fabs(white[4] - (3 - exp(-.5) * .25) / sqrt(1 - exp(-1))) < 1e-14);
}

/* A noise of the first order whose memory is three rows, or three seconds, in rows that are .5 and 5 s apart: of n =
 * 4,000 rows, phi = exp(-h/3) is known to ((1 - phi^2)/n)^1/2, and the memory to 9/(h phi) times that: .14 by rows, and
 * .16 by time. */
static void
knows_whether_a_memory_counts_rows(void **state)
{
    enum { N = 4000 };
    double t[N], y[N];
    uint64_t seed = 3;
    (void)state;
    for (int by_rows = 0; by_rows < 2; by_rows++) {
        wander found;
        for (int i = 0; i < N; i++) {
            t[i] = i / 2 * 5.5 + i % 2 * 0.5;
            double normal = sqrt(-2 * log(1 - uniform(&seed))) * cos(2 * M_PI * uniform(&seed));
            double keep = i == 0 ? 0 : exp((by_rows ? -1 : t[i - 1] - t[i]) / 3);
            y[i] = (i == 0 ? 0 : keep * y[i - 1]) + sqrt(1 - keep * keep) * normal;
        }
        assert_int_equal(ss_wander_find(&found, t, y, N, 1), SS_OK);
        assert_int_equal(found.by_rows, by_rows);
        near("memory", found.memory, 3, 4 * .16);
        near("the part that wanders", found.part, 1, .05);
    }
}

static const rock usual = { .is_slip = 0, .a = .006, .b = .0085, .Dc = 8e-6, .k = 1500, .drift = 3,
    .speed = { 1e-6, 10e-6 }, .until = { 150, 175 }, .noise = 3e-5, .memory = .7, .n = 1500 };

static void
within(const char *what, ss_value v, double truth, double errors)
{
    if (!(fabs(v.value - truth) <= errors * v.error))
        fail_msg("%s: %g +- %g, not %g", what, v.value, v.error, truth);
}

/* The steps of a recording, all of whose numbers are within five errors of the truth. */
static void
answers(const char *what, const rock *r, uint64_t seed, size_t n, double stiffness)
{
    ss_signal *s = rock_signal(r, &seed);
    ss_steps *steps = NULL;
    ss_error err = { 0 };
    if (ss_steps_find(&steps, s, 0, 1, &(ss_steps_opts){ STEPS_OPTS, .stiffness = stiffness }, &err) != SS_OK)
        fail_msg("%s: %s", what, err.text);
    assert_int_equal(steps->n, n);
    for (size_t i = 0; i < n; i++) {
        const ss_step_law *l = &steps->step[i].law[r->is_slip];
        print_message("%s: a %g +- %g, b %g +- %g, Dc %g +- %g, k %g +- %g, ahead %g\n", what, l->direct_effect.value,
                      l->direct_effect.error, l->evolution_effect.value, l->evolution_effect.error,
                      l->critical_slip_distance.value, l->critical_slip_distance.error, l->stiffness.value,
                      l->stiffness.error, l->log_likelihood - steps->step[i].law[!r->is_slip].log_likelihood);
        assert_true(steps->step[i].answer == (ss_step_answer)r->is_slip || steps->step[i].answer == SS_STEP_UNDECIDED);
        within(what, l->direct_effect, r->a, 5);
        within(what, l->evolution_effect, r->b, 5);
        within(what, l->critical_slip_distance, r->Dc, 5);
        within(what, l->drift, r->drift, 5);
        if (stiffness > 0)
            assert_true(l->stiffness.value == stiffness && l->stiffness.error == 0);
        else
            within(what, l->stiffness, r->k, 5);
        assert_true(l->direct_effect.error < 0.1 * r->a);
        for (size_t row = 0; row < steps->step[i].n; row++)
            if (!(fabs(l->model[row] - steps->step[i].friction[row]) <= 6 * r->noise + r->step[1]))
                fail_msg("%s: row %zu is %g, not %g", what, row, l->model[row], steps->step[i].friction[row]);
    }
    ss_steps_free(steps);
    ss_signal_free(s);
}

static void
finds_the_truth_of_simulated_rocks(void **state)
{
    (void)state;
    rock r = usual;
    answers("up", &r, 1, 1, 0);
    r.is_slip = 1;
    answers("slip", &r, 2, 1, 0);
    answers("stiffness given", &r, 3, 1, r.k);
    r.uneven = 2;
    answers("fast rows behind", &r, 4, 1, 0);
    r.uneven = 1;
    r.by_time = 1;
    r.memory = .3;
    answers("random times", &r, 5, 1, 0);
    r = usual;
    r.ramp = 0.02 * 400e-6 / 10e-6;
    answers("ramp", &r, 6, 1, 0);
    r = usual;
    r.path_noise = 1e-7;
    r.jump = 1.5e-6;
    answers("a sensor jumps", &r, 10, 1, 0);
    r = (rock){ .is_slip = 1, .a = .006, .b = .0045, .Dc = 8e-6, .k = 1500, .drift = -3, .speed = { 10e-6, 1e-6 },
                .until = { 20, 220 }, .noise = 3e-5, .memory = .7, .n = 1500 };
    answers("down", &r, 7, 1, 0);
    r = usual;
    r.speed[1] = 0;
    r.speed[2] = 1e-6;
    r.until[1] = 250;
    r.until[2] = 400;
    answers("slide, hold, slide", &r, 8, 1, 0);
    r.until[0] = 95;                            /* two lines fit it best if the first ends in the middle of the hold */
    r.until[1] = 195;
    r.until[2] = 290;
    r.n = 837;
    answers("as long a hold", &r, 9, 1, 0);
    r = usual;
    r.speed[2] = 1e-6;
    r.speed[3] = 10e-6;
    r.until[2] = 425;
    r.until[3] = 450;
    r.n = 4500;
    answers("three steps", &r, 9, 3, 0);
    r = (rock){ .a = .0086, .b = .0075, .Dc = 16e-6, .k = 1900, .drift = 3.5, .speed = { 5e-6, 5e-7, 5e-6 },
                .until = { 75.25, 1131, 1236.4 }, .noise = 3e-5, .n = 745, .digits = 8 };
    answers("changes between rows half a Dc apart", &r, 12, 2, 0);
    r.until[2] = 0, r.n = 7000;
    answers("means of rows", &r, 13, 1, 0);
    r = (rock){ .a = .0126, .b = .00668, .Dc = 1.7e-6, .k = 6210, .drift = 2.7,
                .speed = { 7.485e-6, 74.85e-6, 7.485e-6 }, .until = { 7.34, 8.423, 19.25 },
                .noise = 1.85e-4, .n = 300 };
    answers("laws of one noise", &r, 260, 2, 0);
    r = (rock){ .a = .003, .b = .0019, .Dc = 12.5e-6, .k = 4800, .drift = -4, .speed = { 1e-6, 13.3e-6 },
                .until = { 283.7, 326.2 }, .ramp = .85, .noise = 1e-4, .memory = .6, .n = 827 };
    answers("a ramp of two rows", &r, 15, 1, 0);
    r = (rock){ .is_slip = 1, .a = .0055, .b = .00466, .Dc = 40e-6, .k = 300,
                .speed = { 2.55e-7, 2.55e-6, 2.55e-7, 2.55e-6 }, .until = { 6480, 7406, 16664, 17590 },
                .noise = 3.6e-4, .n = 2237, .step = { 20 } };
    answers("a path in steps of half a Dc", &r, 16, 3, 0);
    r = (rock){ .a = .0122, .b = .0116, .Dc = 57e-6, .k = 530, .speed = { 1.05e-6, 31.5e-6 },
                .until = { 2800, 2894 }, .noise = 1e-4, .n = 3000, .step = { 1.1, .004 } };
    answers("friction in ten steps", &r, 17, 1, 0);
    r = (rock){ .a = .016, .b = .0175, .Dc = 2.5e-6, .k = 1600, .speed = { 3e-6, 30e-6, 3e-6, 30e-6 },
                .until = { 30, 34, 76, 80 }, .noise = 3e-5, .n = 6000, .digits = 9 };
    answers("slides too short for a soft spring", &r, 14, 3, 0);
    r = usual;                                  /* a shear stress in MPa, of 150 MPa of normal stress */
    r.mean = 90;
    r.a *= 250, r.b *= 250, r.k *= 250, r.drift *= 250, r.noise *= 250;
    answers("a stress", &r, 11, 1, 0);
}

/* Three steps that share a, b, Dc and k show them as well as three answers do together, and name one law. */
static void
shares_what_steps_have_in_common(void **state)
{
    (void)state;
    uint64_t seed = 18;
    rock r = usual;
    r.speed[2] = 1e-6;
    r.speed[3] = 10e-6;
    r.until[2] = 425;
    r.until[3] = 450;
    r.noise = 2e-4;
    r.n = 2400;
    ss_signal *s = rock_signal(&r, &seed);
    ss_steps *each = NULL, *all = NULL;
    assert_int_equal(ss_steps_find(&each, s, 0, 1, NULL, NULL), SS_OK);
    assert_int_equal(ss_steps_find(&all, s, 0, 1, &(ss_steps_opts){ STEPS_OPTS, .shared = 1 }, NULL), SS_OK);
    assert_true(each->n == 3 && all->n == 3);
    const double truth[4] = { r.a, r.b, r.Dc, r.k };
    double weights[4] = { 0 }, ahead = 0;
    for (int i = 0; i < 3; i++) {
        const ss_step_law *l = &each->step[i].law[0], *both = all->step[i].law;
        const ss_value v[4] = { l->direct_effect, l->evolution_effect, l->critical_slip_distance, l->stiffness };
        for (int k = 0; k < 4; k++)
            weights[k] += 1 / (v[k].error * v[k].error);
        within("drift", both->drift, r.drift, 3);
        ahead += both[0].log_likelihood - both[1].log_likelihood;
    }
    for (int i = 0; i < 3; i++) {
        const ss_step_law *l = &all->step[i].law[0], *first = &all->step[0].law[0];
        const ss_value v[4] = { l->direct_effect, l->evolution_effect, l->critical_slip_distance, l->stiffness };
        assert_int_equal(all->step[i].answer, SS_STEP_AGING);
        near("ahead", all->step[i].ahead, ahead, 1e-9);
        assert_true(fabs(v[2].value / first->critical_slip_distance.value - 1) < 1e-12);
        for (int k = 0; k < 4; k++) {
            print_message("%g +- %g, by each +- %g\n", v[k].value, v[k].error, 1 / sqrt(weights[k]));
            within("shared", v[k], truth[k], 3);
            near("error", v[k].error * sqrt(weights[k]), 1, .15);
        }
    }
    ss_steps_free(each);
    ss_steps_free(all);
    ss_signal_free(s);
}

/* A first step of little way tells next to nothing alone; the longer ones behind it show what all three share. */
static void
a_poor_first_step_does_not_lead_the_others(void **state)
{
    (void)state;
    uint64_t seed = 1;
    rock r = usual;
    const double speed[] = { 1e-6, 10e-6, 1e-6, 10e-6 }, until[] = { 15, 16, 166, 186 };
    memcpy(r.speed, speed, sizeof speed);
    memcpy(r.until, until, sizeof until);
    r.noise = 5e-4;
    ss_signal *s = rock_signal(&r, &seed);
    ss_steps *all = NULL;
    assert_int_equal(ss_steps_find(&all, s, 0, 1, &(ss_steps_opts){ STEPS_OPTS, .shared = 1 }, NULL), SS_OK);
    assert_int_equal(all->n, 3);
    assert_int_equal(all->step[0].answer, SS_STEP_AGING);
    const ss_step_law *l = &all->step[0].law[SS_STEP_AGING];
    within("a", l->direct_effect, r.a, 3);
    within("b", l->evolution_effect, r.b, 3);
    within("Dc", l->critical_slip_distance, r.Dc, 3);
    within("k", l->stiffness, r.k, 3);
    assert_true(l->critical_slip_distance.error < r.Dc / 5);
    ss_steps_free(all);
    ss_signal_free(s);
}

/* The same friction along a fault that is a million times as long. */
static void
scales_do_not_matter(void **state)
{
    const double by = 1e6;
    uint64_t seed = 5;
    ss_steps *small = NULL, *large = NULL;
    (void)state;
    ss_signal *s = rock_signal(&usual, &seed);
    assert_int_equal(ss_steps_find(&small, s, 0, 1, NULL, NULL), SS_OK);
    for (size_t i = 0; i < s->n; i++)
        s->values[i] *= by;
    assert_int_equal(ss_steps_find(&large, s, 0, 1, NULL, NULL), SS_OK);
    assert_int_equal(large->n, small->n);
    const ss_step_law *is = large->step[0].law, *was = small->step[0].law;
    near("a", is->direct_effect.value, was->direct_effect.value, 1e-3 * was->direct_effect.error);
    near("Dc", is->critical_slip_distance.value, by * was->critical_slip_distance.value,
         1e-3 * by * was->critical_slip_distance.error);
    near("k", is->stiffness.value, was->stiffness.value / by, 1e-3 * was->stiffness.error / by);
    ss_steps_free(small);
    ss_steps_free(large);
    ss_signal_free(s);
}

/* A record that begins with a hold knows of no slide before it. */
static void
begins_in_a_hold(void **state)
{
    rock r = usual;
    uint64_t seed = 18;
    ss_steps *steps = NULL;
    (void)state;
    const double speed[] = { 1e-6, 0, 1e-6, 10e-6 }, until[] = { 100, 150, 400, 440 };
    memcpy(r.speed, speed, sizeof speed);
    memcpy(r.until, until, sizeof until);
    r.n = 2200;
    ss_signal *s = rock_signal(&r, &seed);
    const size_t first = 500 + 10, n = s->n - first;    /* in the hold */
    for (size_t c = 0; c < 3; c++)
        memmove(s->values + c * n, s->values + c * s->n + first, n * sizeof *s->values);
    s->n = n;
    assert_int_equal(ss_steps_find(&steps, s, 0, 1, NULL, NULL), SS_OK);
    assert_int_equal(steps->n, 1);
    within("a", steps->step[0].law[0].direct_effect, r.a, 5);
    within("Dc", steps->step[0].law[0].critical_slip_distance, r.Dc, 5);
    within("k", steps->step[0].law[0].stiffness, r.k, 5);
    assert_true(steps->step[0].law[0].direct_effect.error < 0.1 * r.a);
    ss_steps_free(steps);
    ss_signal_free(s);
}

/* Noise without an effect of speed, and a path without a step. */
static void
says_what_is_none(void **state)
{
    rock r = usual;
    uint64_t seed = 3;
    ss_steps *steps = NULL;
    ss_error err = { 0 };
    (void)state;
    ss_signal *s = rock_signal(&r, &seed);
    for (size_t i = 0; i < s->n; i++)
        s->values[s->n + i] = 0.6 + 1e-3 * rock_gauss(&seed);
    assert_int_equal(ss_steps_find(&steps, s, 0, 1, NULL, &err), SS_OK);
    assert_int_equal(steps->step[0].answer, SS_STEP_NONE);
    assert_non_null(strstr(steps->step[0].why, "straight line"));
    ss_steps_free(steps);
    for (size_t i = 0; i < s->n; i++)
        s->values[i] = 3 * s->values[2 * s->n + i];
    assert_int_equal(ss_steps_find(&steps, s, 0, 1, NULL, &err), SS_EDATA);
    assert_null(steps);
    assert_string_equal(err.text, "the speed of column load has no step behind a steady slide");
    assert_int_equal(ss_steps_find(&steps, s, 1, 0, NULL, &err), SS_EDATA);
    assert_string_equal(err.text, "column mu: '' is not a unit of length, as m, mm or um is");
    s->values[s->n + 3] = NAN;
    assert_int_equal(ss_steps_find(&steps, s, 0, 1, NULL, &err), SS_EDATA);
    ss_signal_free(s);
}

/* The basalt of Giacomel et al. (2021): both steps have an answer with errors. */
static void
answers_the_basalt(void **state)
{
    static const char *const name[] = { "velstep4_BRAVA_expb819_basalt.txt",
                                        "velstep7_BRAVA_expb819_basalt_Giacomel_et_al_2021.txt" };
    ss_read_opts opts;
    (void)state;
    ss_read_opts_init(&opts, sizeof opts);
    opts.stamps = 1;
    for (int i = 0; i < 2; i++) {
        char path[200];
        ss_signal *s = NULL;
        ss_steps *steps = NULL;
        snprintf(path, sizeof path, "../shared/data/steps/%s", name[i]);
        FILE *in = fopen(path, "r");
        if (in == NULL) {
            print_message("skipped: no ../shared/data/steps\n");
            skip();
        }
        assert_int_equal(ss_signal_read(&s, in, path, &opts, NULL), SS_OK);
        fclose(in);
        assert_int_equal(ss_steps_find(&steps, s, 0, 1, NULL, NULL), SS_OK);
        assert_int_equal(steps->n, 1);
        const ss_step *step = &steps->step[0];
        assert_int_not_equal(step->answer, SS_STEP_NONE);
        for (int law = 0; law < SS_STEP_LAWS; law++) {
            const ss_step_law *l = &step->law[law];
            print_message("%s %s: a %.4f +- %.4f, b %.4f +- %.4f, Dc %.3g +- %.2g\n", name[i], law == 0 ? "aging" : "slip",
                          l->direct_effect.value, l->direct_effect.error, l->evolution_effect.value,
                          l->evolution_effect.error, l->critical_slip_distance.value, l->critical_slip_distance.error);
            assert_true(l->direct_effect.error < l->direct_effect.value / 5);
            assert_true(l->evolution_effect.error < l->evolution_effect.value / 5);
            assert_true(l->critical_slip_distance.error < l->critical_slip_distance.value / 5);
        }
        ss_steps_free(steps);
        ss_signal_free(s);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slides_as_two_methods_say),
        cmocka_unit_test(a_soft_spring_runs_away),
        cmocka_unit_test(whitens_what_wanders),
        cmocka_unit_test(knows_whether_a_memory_counts_rows),
        cmocka_unit_test(finds_the_truth_of_simulated_rocks),
        cmocka_unit_test(shares_what_steps_have_in_common),
        cmocka_unit_test(a_poor_first_step_does_not_lead_the_others),
        cmocka_unit_test(scales_do_not_matter),
        cmocka_unit_test(begins_in_a_hold),
        cmocka_unit_test(says_what_is_none),
        cmocka_unit_test(answers_the_basalt),
    };
    return cmocka_run_group_tests_name("steps", tests, NULL, NULL);
}
