/* test_models.c -- which model a scene requires.
 *
 * Truth: errors of Coulomb in place of compliant contact from two other programs (closed forms in
 * Python, and the oracle's), to the digits given; errors and maps recomputed here from runs of an
 * integrator; the limits of the laws of friction. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <stickslip.h>
#include "map/map.h"
#include "shipped.h"
#include "unit.h"
#include "scene/key.h"
#include "study/trade/trade.h"

/* Times are made up, so that no busy machine decides what is cheapest. */
static ss_models *
models_of(const ss_scene *scene)
{
    ss_models *models = NULL;
    ss_error err = { 0 };
    if (ss_models_measure(&models, scene, NULL, &err) != SS_OK)
        fail_msg("%s", err.text);
    for (size_t i = 0; i < models->n; i++)
        models->row[i].seconds = strcmp(models->row[i].name, "coulomb") == 0 ? 1 : 2;
    return models;
}

static const ss_models_row *
row_of(const ss_models *models, const char *name)
{
    for (size_t i = 0; i < models->n; i++)
        if (strcmp(models->row[i].name, name) == 0)
            return &models->row[i];
    fail_msg("no row %s", name);
    return NULL;
}

static double
error_of(const ss_models_row *row, const char *name)
{
    for (size_t i = 0; ss_compared_name(i) != NULL; i++)
        if (strcmp(ss_compared_name(i), name) == 0)
            return row->error[i];
    fail_msg("no error %s", name);
    return NAN;
}

static ss_scene
settled_light(double stiffer)
{
    ss_scene scene = read_shipped_named("compliant-light");
    scene.settle = 20;
    ss_scene_set(&scene, "contact_stiffness", ss_scene_get(&scene, "contact_stiffness") * stiffer, NULL);
    return scene;
}

/* The answer to a list of needs is this sentence. */
static void
assert_answer(const ss_models *models, const char *list, const char *expected)
{
    ss_need need[SS_COMPARED_MOST];
    size_t n;
    char *sentence = NULL;
    assert_int_equal(ss_needs_parse(need, &n, list, NULL), SS_OK);
    assert_int_equal(ss_models_answer(&sentence, models, need, n, NULL), SS_OK);
    assert_string_equal(sentence, expected);
    free(sentence);
}

static void
coulomb_in_place_of_a_contact(void **state)
{
    static const struct { double stiffer, x, v, a; } known[] = {
        { 1, .409, .418, 1.0 }, { 10, .035, .0442, 1.0 }, { 100, .0035, .0135, .96 },
        { 1000, .00027, .0043, .96 } };
    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const ss_scene scene = settled_light(known[i].stiffer);
        ss_models *models = models_of(&scene);
        const ss_models_row *row = row_of(models, "coulomb");
        assert_true(fabs(error_of(row, "x") / known[i].x - 1) < 0.02);
        assert_true(fabs(error_of(row, "v") / known[i].v - 1) < 0.01);
        assert_true(fabs(error_of(row, "a") / known[i].a - 1) < 0.005);
        assert_int_equal(row->events, 30);          /* a stop and a slip each half-cycle */
        assert_int_equal(row->microslips, 0);
        ss_models_free(models);
    }
}

/* A sweep says the same of the periodic state, at 2000 samples a cycle: truth at 5 kHz. */
static void
sweeps_measure_the_error_of_a_model(void **state)
{
    static const struct { double stiffer, x, v, a; } known[] = {
        { 1, .409, .418, 1.0 }, { 10, .035, .0446, 1.0 }, { 100, .0035, .0139, .99 } };
    const unsigned all = 1u << SS_MODEL_ERROR_X | 1u << SS_MODEL_ERROR_V | 1u << SS_MODEL_ERROR_A
        | 1u << SS_MODEL_ERROR_X_RMS;
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_steady found;
    (void)state;
    opts.measures = all;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const ss_scene scene = settled_light(known[i].stiffer);
        ss_models *models = models_of(&scene);
        assert_int_equal(ss_steady_find(&found, &scene, &opts, NULL), SS_OK);
        assert_true(fabs(found.value[SS_MODEL_ERROR_X] / known[i].x - 1) < 0.02);
        assert_true(fabs(found.value[SS_MODEL_ERROR_V] / known[i].v - 1) < 0.01);
        assert_true(fabs(found.value[SS_MODEL_ERROR_A] / known[i].a - 1) < 0.005);
        double rms = error_of(row_of(models, "coulomb"), "x_rms");
        assert_true(fabs(found.value[SS_MODEL_ERROR_X_RMS] / rms - 1) < 1e-3);
        ss_models_free(models);
    }
    const ss_scene coulomb = read_shipped_named("coulomb");
    assert_int_equal(ss_steady_find(&found, &coulomb, &opts, NULL), SS_EINVAL);
}

static void
answers_in_a_sentence(void **state)
{
    const ss_scene stiff = settled_light(100), light = settled_light(1);
    (void)state;
    ss_models *models = models_of(&stiff);
    assert_answer(models, "x=1e-2,a=0.1", "coulomb suffices for x within 1 %; a within 10 % needs compliant");
    assert_answer(models, "x=1e-2,v=0.02", "coulomb suffices for x within 1 % and v within 2 %");
    assert_answer(models, "a=0.1,map=3dB,a_rms=1e-2",
                  "a within 10 %, map within 3 dB and a_rms within 1 % need compliant");
    ss_models_free(models);
    models = models_of(&light);
    assert_int_equal(models->row[0].microslips, 15);        /* one a half-cycle in the settled motion */
    assert_answer(models, "x=50%,events=30", "coulomb suffices for x within 50 % and events within 30");
    assert_answer(models, "transition_frequency=1e-3,x=0.5",
                  "coulomb suffices for x within 50 %; contact_damping=0 suffices for transition_frequency within 0.1 %");
    ss_models_free(models);
}

static void
refuses_what_the_scene_has_not(void **state)
{
    static const char *const wrong[] = { "", "x", "x=", "y=1", "x=-1", "x=1,x=2", "map=3db", "x=1dB", "x=nan",
        "x=%", "x=1%%", "events=1%", "map=1%" };
    ss_scene scene = read_shipped_named("state-variable");
    ss_need need[SS_COMPARED_MOST];
    size_t n;
    char *sentence = NULL;
    ss_error err = { 0 };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(ss_needs_parse(need, &n, wrong[i], &err), SS_EINVAL);
    scene.duration = 1;
    ss_models *models = models_of(&scene);
    assert_int_equal(ss_needs_parse(need, &n, "microslips", NULL), SS_OK);
    assert_int_equal(ss_models_answer(&sentence, models, need, n, &err), SS_EDATA);
    assert_string_equal(err.text, "microslips cannot be kept: the scene has none");
    ss_models_free(models);
    scene.duration = 0;
    assert_int_equal(ss_models_measure(&models, &scene, NULL, &err), SS_EINVAL);
}

/* --- each error by another way --------------------------------------------------------------- */

static double
level(const ss_coefficients *c, size_t i, double top)
{
    return fmax(-80, 20 * log10(hypot(c->w[2 * i], c->w[2 * i + 1]) / top));
}

static void
the_errors_are_those_of_the_records(void **state)
{
    ss_scene scene = read_shipped_named("compliant-heavy"), simpler;
    ss_signal *a = NULL, *b = NULL;
    ss_coefficients *p = NULL, *q = NULL;
    double most = 0, max = 0, far = 0;
    (void)state;
    ss_models *models = models_of(&scene);
    assert_string_equal(ss_scene_simpler(&simpler, &scene, 0), "contact_damping=0");
    const ss_models_row *row = row_of(models, "contact_damping=0");
    assert_int_equal(ss_sim_signal(&a, &scene, NULL), SS_OK);
    assert_int_equal(ss_sim_signal(&b, &simpler, NULL), SS_OK);
    for (size_t i = 2 * a->n; i < 3 * a->n; i++) {
        most = fmax(most, fabs(a->values[i] - b->values[i]));
        max = fmax(max, fabs(a->values[i]));
    }
    assert_true(fabs(error_of(row, "a") * max / most - 1) < 1e-6);
    assert_int_equal(ss_morlet_transform(&p, a, 2, &ss_morlet_defaults, NULL), SS_OK);
    assert_int_equal(ss_morlet_transform(&q, b, 2, &ss_morlet_defaults, NULL), SS_OK);
    const double top[] = { ss_coefficients_max(p), ss_coefficients_max(q) };
    for (size_t i = 0; i < p->n_scales; i++)
        for (size_t k = 0; k < p->scale[i].n; k++) {
            size_t at = p->scale[i].offset + k;
            if (!ss_coefficients_edge(p, i, k))
                far = fmax(far, fabs(level(p, at, top[0]) - level(q, at, top[1])));
        }
    assert_true(far > 1 && fabs(error_of(row, "map") - far) < 1e-3);
    assert_true(error_of(row, "map_rms") > 0 && error_of(row, "map_rms") < far);
    ss_coefficients_free(p);
    ss_coefficients_free(q);
    ss_signal_free(a);
    ss_signal_free(b);
    ss_models_free(models);
}

/* The settled state is the same record after many more whole cycles. */
static void
the_settled_state_is_that_of_later(void **state)
{
    ss_scene scene = read_shipped_named("compliant-light"), later = scene;
    ss_signal *a = NULL, *b = NULL;
    double most = 0, max = 0;
    (void)state;
    scene.settle = 0.3;                             /* three quarters of a cycle */
    later.settle = 0.3 + 150 / later.base_frequency;
    ss_models *models = models_of(&scene);
    assert_int_equal(ss_sim_signal(&a, &scene, NULL), SS_OK);
    assert_int_equal(ss_sim_signal(&b, &later, NULL), SS_OK);
    for (size_t i = 0; i < a->n; i++) {
        most = fmax(most, fabs(a->values[i] - b->values[i]));
        max = fmax(max, fabs(a->values[i]));
    }
    assert_true(most > 0.1 * max);
    assert_true(fabs(error_of(row_of(models, "settled"), "x") * max / most - 1) < 1e-6);
    ss_signal_free(a);
    ss_signal_free(b);
    ss_models_free(models);
}

/* The error of x with Coulomb in place of the state variable of this law, as it gets steeper. */
static double
error_of_limit(const char *law, double alpha)
{
    ss_scene scene = read_shipped_named("state-variable");
    ss_scene_set(&scene, "alpha", alpha, NULL);
    ss_scene_set(&scene, "gamma", alpha / 10, NULL);
    ss_scene_set_text(&scene, "law", law, NULL);
    scene.friction = 1.1;
    scene.settle = 1;
    scene.duration = 1;
    ss_models *models = models_of(&scene);
    const ss_models_row *row = row_of(models, "coulomb");
    assert_true(row->scene.friction == (strcmp(law, "literal") == 0 ? 1 : 1.1));
    assert_true(error_of(row_of(models, "friction=0"), "x") > 1);
    double error = error_of(row, "x");
    ss_models_free(models);
    return error;
}

/* A law that follows at once is Coulomb's, of the friction that it settles to: the error falls as the
 * width of its front does. */
static void
laws_come_to_their_limits(void **state)
{
    (void)state;
    static const char *const law[] = { "scaled", "literal" };
    for (int i = 0; i < 2; i++) {
        double wide = error_of_limit(law[i], 1e4), narrow = error_of_limit(law[i], 5e4);
        assert_true(narrow < 0.02 && wide / narrow > 4 && wide / narrow < 6);
    }
}

static void
lists_what_a_scene_may_lose(void **state)
{
    static const char *const all[] = { "damping=0", "static_friction=0", "contact_damping=0", "coulomb",
                                       "friction=0", NULL };
    ss_scene scene = read_shipped_named("compliant-light"), simpler;
    (void)state;
    scene.damping = 3;
    scene.static_friction = 1.5;
    for (size_t i = 0; all[i] != NULL; i++) {
        assert_string_equal(ss_scene_simpler(&simpler, &scene, i), all[i]);
        assert_int_equal(ss_scene_check(&simpler, NULL), SS_OK);
    }
    assert_null(ss_scene_simpler(&simpler, &scene, 5));
    ss_scene_set_text(&scene, "model", "stribeck", NULL);
    assert_string_equal(ss_scene_simpler(&simpler, &scene, 2), "coulomb");
    assert_true(simpler.static_friction == 1.5);    /* which holds the mass until it slips */
    scene = read_shipped_named("coulomb");
    assert_string_equal(ss_scene_simpler(&simpler, &scene, 0), "friction=0");
    assert_true(simpler.friction == 0 && simpler.model == scene.model);
    assert_null(ss_scene_simpler(&simpler, &scene, 1));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coulomb_in_place_of_a_contact),
        cmocka_unit_test(sweeps_measure_the_error_of_a_model),
        cmocka_unit_test(answers_in_a_sentence),
        cmocka_unit_test(refuses_what_the_scene_has_not),
        cmocka_unit_test(the_errors_are_those_of_the_records),
        cmocka_unit_test(the_settled_state_is_that_of_later),
        cmocka_unit_test(laws_come_to_their_limits),
        cmocka_unit_test(lists_what_a_scene_may_lose),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
