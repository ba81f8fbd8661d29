/* test_arguments.c -- NULL where something is needed is refused, and so is what is no known choice;
 * both change nothing.  tests/build/arguments.sh sees that no public function is left out. */
#include <stdint.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <stickslip.h>
#include "map/map.h"

#include "base/error.h"
#include "unit.h"
#include "read_opts.h"
#include "find/events.h"
#include "find/numbers.h"
#include "study/sweep/grid.h"
#include "io/record.h"
#include "scene/key.h"
#include "scene/scene.h"
#include "signal/gaps.h"
#include "signal/header.h"
#include "signal/noise.h"
#include "study/trade/trade.h"

static ss_scene scene = { .mass = 1, .stiffness = 1, .friction = 1, .base_amplitude = 1,
    .base_frequency = 1, .duration = 1, .rate = 8 };

/* Refused, with a text where there is room for one. */
static void
assert_refused(ss_status status, ss_error *err)
{
    assert_int_equal(status, SS_EINVAL);
    if (err == NULL)
        return;
    assert_string_equal(err->text, "an argument is NULL");
    err->text[0] = '\0';
}

static void
readers_refuse_null(void **state)
{
    FILE *in = tmpfile();
    ss_error e = { 0 };
    ss_scene read;
    ss_reader *reader;
    ss_signal *signal;
    ss_coefficients *c;
    double row;
    size_t n;
    (void)state;
    assert_refused(ss_scene_read(NULL, in, "in", NULL, 0, &e), &e);
    assert_refused(ss_scene_read(&read, in, NULL, NULL, 0, &e), &e);
    assert_refused(ss_scene_read(&read, in, "in", NULL, 1, &e), &e);
    assert_refused(ss_scene_read(NULL, NULL, "coulomb", NULL, 0, &e), &e);
    assert_refused(ss_scene_read(&read, NULL, NULL, NULL, 0, &e), &e);
    assert_refused(ss_scene_read(&read, NULL, "coulomb", NULL, 1, &e), &e);
    assert_refused(ss_scene_check(NULL, &e), &e);
    ss_base *base;
    assert_refused(ss_base_load(NULL, &read, "a", &e), &e);
    assert_refused(ss_base_load(&base, NULL, "a", &e), &e);
    assert_refused(ss_base_load(&base, &read, NULL, &e), &e);
    ss_base_free(NULL);
    assert_refused(ss_reader_new(NULL, in, "in", NULL, &e), &e);
    assert_refused(ss_reader_new(&reader, in, NULL, NULL, &e), &e);
    assert_refused(ss_reader_rows(NULL, (double *[]){ &row }, 1, &n, &e), &e);
    assert_refused(ss_signal_read(NULL, in, "in", NULL, &e), &e);
    assert_refused(ss_coefficients_read(NULL, in, "in", &e), &e);
    assert_refused(ss_reader_new(NULL, NULL, "x", NULL, &e), &e);
    assert_refused(ss_reader_new(&reader, NULL, NULL, NULL, &e), &e);
    assert_refused(ss_coefficients_read(NULL, NULL, "x.h5", &e), &e);
    assert_refused(ss_coefficients_read(&c, NULL, NULL, &e), &e);
    assert_refused(ss_signal_read(NULL, NULL, "x", NULL, &e), &e);
    assert_refused(ss_signal_read(&signal, NULL, NULL, NULL, &e), &e);
    assert_int_equal(ftell(in), 0);
    fclose(in);
}

static void
makers_and_writers_refuse_null(void **state)
{
    static const ss_record record;
    ss_error e = { 0 };
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    ss_signal *signal;
    ss_writer *writer;
    ss_coefficients *c;
    (void)state;
    assert_refused(ss_header_add_column(NULL, "x", "", &e), &e);
    assert_refused(ss_header_add_column(head, NULL, "", &e), &e);
    assert_refused(ss_header_note(NULL, "key", "value", &e), &e);
    assert_refused(ss_header_note(head, NULL, "value", &e), &e);
    assert_refused(ss_signal_new(NULL, head, 1, &e), &e);
    assert_refused(ss_signal_new(&signal, NULL, 1, &e), &e);
    assert_refused(ss_record_write(&(ss_record){ .signal = NULL }, stdout, NULL, SS_TSV, NULL), NULL);
    assert_refused(ss_writer_new(NULL, stdout, NULL, SS_TSV, &(ss_contents){ .signal = head }, NULL), NULL);
    assert_refused(ss_writer_new(&writer, NULL, NULL, SS_TSV, &(ss_contents){ .signal = head }, NULL), NULL);
    assert_refused(ss_writer_new(&writer, stdout, NULL, SS_TSV, &(ss_contents){ .signal = NULL }, NULL), NULL);
    assert_refused(ss_writer_rows(NULL, NULL, 0, &e), &e);
    assert_refused(ss_scene_write(NULL, stdout, NULL), NULL);
    assert_refused(ss_scene_write(&scene, NULL, NULL), NULL);
    assert_refused(ss_record_write(&(ss_record){ .coefficients = &(ss_coefficients){ .head = head } }, stdout,
                                   NULL, SS_TSV, NULL),
                   NULL);
    assert_refused(ss_morlet_transform(&c, NULL, 0, &ss_morlet_defaults, &e), &e);
    assert_refused(ss_record_write(&record, NULL, NULL, SS_H5, &e), &e);
    assert_refused(ss_record_write(NULL, NULL, "x.h5", SS_H5, &e), &e);
    ss_writer *store = NULL;
    const ss_coefficients grid = { .head = NULL };
    const ss_contents both = { head, &grid, 0, 0 };
    assert_refused(ss_writer_new(NULL, NULL, "x.h5", SS_H5, &both, &e), &e);
    assert_refused(ss_writer_new(&store, NULL, NULL, SS_H5, &both, &e), &e);
    assert_refused(ss_writer_new(&store, NULL, "x.h5", SS_H5, NULL, &e), &e);
    assert_refused(ss_writer_new(&store, NULL, "x.h5", SS_H5, &both, &e), &e);
    assert_null(store);
    assert_refused(ss_writer_rows(NULL, (double *[]){ &(double){ 0 } }, 1, &e), &e);
    assert_refused(ss_writer_coefficients(NULL, NULL, 0, 0, NULL, 0, &e), &e);
    assert_refused(ss_writer_note(NULL, "a", "b", &e), &e);
    assert_refused(ss_writer_end(NULL, 1, &e), &e);
    ss_writer_free(NULL);
    ss_coefficients *map = NULL;
    assert_refused(ss_coefficients_read(&map, NULL, NULL, &e), &e);
    assert_refused(ss_map_read(NULL, NULL, 0, &e), &e);
    assert_int_equal(head->n_columns + head->n_notes, 0);
    ss_header_free(head);
}

static int
no_coefficients(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples,
                void *user)
{
    (void)scale, (void)first, (void)n, (void)w, (void)samples, (void)user;
    return 1;
}

static int
no_rows(const ss_sweep_row *row, void *user)
{
    (void)row, (void)user;
    return 1;
}

static void
headers_and_samples_refuse_null(void **state)
{
    ss_header *head = NULL, *copy;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    ss_signal *signal = NULL;
    ss_noise_opts noise;
    ss_noise_done done = { .rms = NULL };
    ss_reader *reader = NULL;
    double x[2] = { 1, 2 };
    ss_error e = { 0 };
    (void)state;
    assert_null(ss_header_find_note(NULL, "key"));
    assert_null(ss_header_find_note(head, NULL));
    assert_int_equal(ss_header_column(NULL, "x"), -1);
    assert_true(ss_unit_size(NULL, &(char){ 0 }, &(int){ 0 }) == 0);
    assert_int_equal(ss_header_column(head, NULL), -1);
    assert_int_equal(ss_header_row(NULL, 1), 0);
    assert_refused(ss_header_select(NULL, head, NULL, 0, 0, &e), &e);
    assert_refused(ss_header_select(&copy, NULL, NULL, 0, 0, &e), &e);
    assert_int_equal(ss_header_select(&copy, head, NULL, 1, 0, &e), SS_EINVAL);      /* it has no column */
    assert_int_equal(ss_gaps_near(NULL, 1, 0, 1), 0);
    assert_null(ss_reader_header(NULL));
    assert_int_equal(ss_reader_waits(NULL), 0);
    assert_int_equal(ss_reader_piece(NULL), 1);
    assert_refused(ss_writer_end(NULL, 0, NULL), NULL);
    assert_refused(ss_reader_filter(NULL, NULL, &e), &e);
    assert_refused(ss_signal_of_reader(NULL, NULL, &e), &e);
    assert_refused(ss_signal_of_reader(&signal, NULL, &e), &e);
    ss_filter_opts filter;
    ss_filter_opts_init(&filter, sizeof filter);
    filter.size = 1;
    const ss_signal none = { .head = head };
    assert_int_equal(ss_reader_of_signal(&reader, &none, &e), SS_OK);
    assert_int_equal(ss_reader_filter(reader, &filter, &e), SS_EINVAL);
    ss_noise_opts_init(&noise, sizeof noise);
    e.text[0] = '\0';
    assert_refused(ss_reader_noise(NULL, &noise, &done, &e), &e);
    assert_refused(ss_reader_noise(reader, &noise, NULL, &e), &e);
    noise.snr = noise.rms = 1;
    assert_int_equal(ss_reader_noise(reader, &noise, &done, &e), SS_EINVAL);
    noise.snr = NAN;
    noise.column = &(size_t){ 0 };
    noise.n_columns = 1;
    assert_int_equal(ss_reader_noise(reader, &noise, &done, &e), SS_EINVAL);     /* it has no column */
    noise.column = NULL;
    assert_int_equal(ss_reader_noise(reader, &noise, &done, &e), SS_EINVAL);
    noise.n_columns = 0;
    noise.bits = 53;
    assert_int_equal(ss_reader_noise(reader, &noise, &done, &e), SS_EINVAL);
    ss_reader_free(reader);
    e.text[0] = '\0';
    assert_refused(ss_reader_rewind(NULL, &e), &e);
    assert_refused(ss_wave_new(NULL, SS_SINE, &ss_wave_defaults, &e), &e);
    ss_wave_opts wave;
    ss_wave_opts_init(&wave, sizeof wave);
    wave.size = 1;
    assert_int_equal(ss_wave_new(&signal, SS_SINE, &wave, &e), SS_EINVAL);
    assert_int_equal(ss_number_format(NULL, 1), 0);
    assert_true(ss_number_parse(NULL, NULL) == 0);
    assert_int_equal(x[0] + x[1], 3);
    assert_null(signal);
    ss_header_free(head);
}

static void
simulations_refuse_null(void **state)
{
    ss_error e = { 0 };
    ss_scene copy = scene;
    ss_signal *signal = NULL;
    ss_header *head = NULL;
    ss_sim_columns columns;
    ss_trade *trade = NULL;
    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
    static const ss_sample sample;
    double row = 7;
    (void)state;
    assert_int_equal(ss_scene_set(NULL, "mass", 1, &e), SS_EINVAL);
    assert_int_equal(ss_scene_set(&copy, NULL, 1, &e), SS_EINVAL);
    assert_int_equal(ss_scene_set(&copy, "release", 1, &e), SS_EINVAL);
    assert_int_equal(ss_scene_set_text(&copy, "release", "totally", &e), SS_EINVAL);
    assert_int_equal(ss_scene_set_text(&copy, "model", "?", &e), SS_EINVAL);
    assert_true(isnan(ss_scene_get(NULL, "mass")) && isnan(ss_scene_get(&scene, NULL))
                && isnan(ss_scene_get(&scene, "release")) && isnan(ss_scene_get(&scene, "alpha")));
    e.text[0] = '\0';
    assert_refused(ss_scene_set_text(NULL, "mass", "1", &e), &e);
    assert_refused(ss_scene_set_text(&copy, "mass", NULL, &e), &e);
    assert_int_equal(ss_scene_samples(NULL), 0);
    assert_refused(ss_sim_run(NULL, &opts, NULL, &e), &e);
    assert_refused(ss_sim_signal(NULL, &scene, &e), &e);
    assert_refused(ss_sim_signal(&signal, NULL, &e), &e);
    assert_refused(ss_sim_columns_parse(NULL, "x", &e), &e);
    assert_refused(ss_sim_columns_parse(&columns, NULL, &e), &e);
    assert_int_equal(ss_sim_columns_parse(&columns, "x", &e), SS_OK);
    assert_refused(ss_sim_header(NULL, &scene, &columns, &e), &e);
    assert_refused(ss_sim_header(&head, NULL, &columns, &e), &e);
    assert_refused(ss_sim_header(&head, &scene, NULL, &e), &e);
    ss_sim_rows(NULL, &sample, 1, &(double *){ &row });
    ss_sim_rows(&columns, NULL, 1, &(double *){ &row });
    ss_sim_rows(&columns, &sample, 1, NULL);
    assert_true(row == 7);
    assert_null(ss_sim_method_for(NULL, NULL));
    assert_null(ss_sim_method_name(SIZE_MAX));
    assert_refused(ss_trade_measure(NULL, &scene, NULL, &e), &e);
    assert_refused(ss_trade_measure(&trade, NULL, NULL, &e), &e);
    assert_refused(ss_trade_choose(NULL, &scene, 1e-6, &e), &e);
    assert_refused(ss_trade_choose(&opts, NULL, 1e-6, &e), &e);
    assert_null(ss_trade_cheapest(NULL, 1));
    ss_models *models = NULL;
    ss_need need[SS_COMPARED_MOST] = { { 0, 0 } };
    size_t n;
    assert_refused(ss_models_measure(NULL, &scene, NULL, &e), &e);
    assert_refused(ss_models_measure(&models, NULL, NULL, &e), &e);
    assert_refused(ss_needs_parse(NULL, &n, "x=1", &e), &e);
    assert_refused(ss_needs_parse(need, NULL, "x=1", &e), &e);
    assert_refused(ss_needs_parse(need, &n, NULL, &e), &e);
}

static void
transforms_refuse_null(void **state)
{
    const ss_morlet_opts *const opts = &ss_morlet_defaults;
    static const ss_scale scale;
    ss_error e = { 0 };
    ss_header *head = NULL, *made;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    ss_morlet *plan = NULL;
    ss_stream *stream = NULL;
    ss_signal *signal;
    ss_writer *writer;
    static const ss_coefficients none;
    double x[64] = { 0 }, w[2], difference;
    (void)state;
    assert_refused(ss_morlet_new(NULL, 64, 1, opts, &e), &e);
    assert_int_equal(ss_morlet_new(&plan, 64, 1, &(ss_morlet_opts){ .size = 1 }, &e), SS_EINVAL);
    assert_int_equal(ss_morlet_new(&plan, 64, 1, opts, &e), SS_OK);
    assert_null(ss_morlet_grid(NULL));
    ss_trade *trade = NULL;
    assert_refused(ss_trade_transform(NULL, x, 4, 1, &ss_morlet_defaults, NULL, &e), &e);
    assert_refused(ss_trade_transform(&trade, NULL, 4, 1, &ss_morlet_defaults, NULL, &e), &e);
    assert_null(trade);
    assert_refused(ss_morlet_execute(NULL, x, w, &e), &e);
    assert_refused(ss_morlet_execute(plan, NULL, w, &e), &e);
    assert_refused(ss_morlet_execute(plan, x, NULL, &e), &e);
    assert_refused(ss_morlet_each(NULL, x, no_coefficients, NULL, &e), &e);
    assert_refused(ss_morlet_each(plan, NULL, no_coefficients, NULL, &e), &e);
    assert_refused(ss_morlet_each(plan, x, NULL, NULL, &e), &e);
    assert_refused(ss_morlet_compare(NULL, x, w, 1, &difference, &e), &e);
    assert_refused(ss_morlet_compare(plan, NULL, w, 1, &difference, &e), &e);
    assert_refused(ss_morlet_compare(plan, x, NULL, 1, &difference, &e), &e);
    assert_refused(ss_morlet_compare(plan, x, w, 1, NULL, &e), &e);
    ss_morlet_free(plan);
    assert_true(isnan(ss_scale_b(NULL, 1)));
    assert_int_equal(ss_scale_edge(NULL, 1, 1, 1), 1);

    ss_morlet_opts with_fmin;
    ss_morlet_opts_init(&with_fmin, sizeof with_fmin);
    with_fmin.fmin = 0.1;
    assert_refused(ss_stream_new(NULL, 1, &with_fmin, no_coefficients, NULL, &e), &e);
    assert_int_equal(ss_stream_new(&stream, 1, NULL, no_coefficients, NULL, &e), SS_EINVAL);     /* no fmin */
    assert_refused(ss_stream_new(&stream, 1, &with_fmin, NULL, NULL, &e), &e);
    assert_int_equal(ss_stream_new(&stream, 1, &with_fmin, no_coefficients, NULL, &e), SS_OK);
    assert_null(ss_stream_grid(NULL));
    assert_int_equal(ss_stream_samples(NULL), 0);
    assert_int_equal(ss_stream_window(NULL, 0), 0);
    assert_refused(ss_stream_push(NULL, x, 1, &e), &e);
    assert_refused(ss_stream_push(stream, NULL, 1, &e), &e);
    assert_refused(ss_stream_drain(NULL, &e), &e);
    assert_refused(ss_stream_end(NULL, &e), &e);
    ss_stream_free(stream);

    assert_refused(ss_morlet_inverse(NULL, &none, 1e-6, NULL, (ss_progress){ NULL, NULL }, &e), &e);
    assert_refused(ss_morlet_inverse(&signal, NULL, 1e-6, NULL, (ss_progress){ NULL, NULL }, &e), &e);
    assert_refused(ss_coefficients_header(NULL, head, 0, 1, opts, &e), &e);
    assert_refused(ss_coefficients_header(&made, NULL, 0, 1, opts, &e), &e);
    assert_true(isnan(ss_coefficients_max(NULL)));
    const ss_contents of_grid = { .grid = &(ss_coefficients){ .head = head } };
    assert_refused(ss_writer_new(NULL, stdout, NULL, SS_TSV, &of_grid, NULL), NULL);
    assert_refused(ss_writer_new(&writer, NULL, NULL, SS_TSV, &of_grid, NULL), NULL);
    assert_refused(ss_writer_new(&writer, stdout, NULL, SS_TSV, &(ss_contents){ .grid = &none }, NULL), NULL);
    assert_refused(ss_writer_coefficients(NULL, &scale, 0, 0, w, 1, NULL), NULL);
    FILE *out = tmpfile();
    assert_int_equal(ss_writer_new(&writer, out, NULL, SS_TSV, &of_grid, NULL), SS_OK);
    assert_refused(ss_writer_coefficients(writer, &scale, 0, 1, NULL, 1, NULL), NULL);
    ss_writer_free(writer);
    fclose(out);
    assert_refused(ss_writer_end(NULL, 1, NULL), NULL);
    ss_header_free(head);
}

static void
conclusions_refuse_null(void **state)
{
    static const ss_coefficients none;
    ss_error e = { 0 };
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    ss_signal *signal = NULL;
    ss_features *features;
    ss_ranking *ranking;
    ss_fit fit;
    ss_steps *steps = NULL;
    ss_pull *pull;
    (void)state;
    assert_int_equal(ss_signal_new(&signal, head, 2, NULL), SS_OK);
    assert_refused(ss_features_find(NULL, signal, 0, NULL, &e), &e);
    ss_reader *reader = NULL;
    assert_int_equal(ss_reader_of_signal(&reader, signal, &e), SS_OK);
    assert_refused(ss_features_follow(NULL, 0, NULL, stdout, SS_TSV, &e), &e);
    assert_refused(ss_features_follow(reader, 0, NULL, NULL, SS_TSV, &e), &e);
    assert_int_equal(ss_features_follow(reader, 0, NULL, stdout, SS_TSV, &e), SS_EINVAL);
    ss_reader_free(reader);
    e.text[0] = '\0';
    assert_refused(ss_features_find(&features, NULL, 0, NULL, &e), &e);
    ss_backbone *backbone;
    ss_backbone none_found = { .why = "nothing" };
    assert_refused(ss_backbone_find(NULL, signal, 0, NULL, &e), &e);
    assert_refused(ss_backbone_find(&backbone, NULL, 0, NULL, &e), &e);
    assert_int_equal(ss_backbone_find(&backbone, signal, 0, NULL, &e), SS_EINVAL);  /* no column */
    assert_refused(ss_backbone_write(NULL, signal, 0, stdout, SS_TSV, NULL), NULL);
    assert_refused(ss_backbone_write(&none_found, NULL, 0, stdout, SS_TSV, NULL), NULL);
    assert_refused(ss_backbone_write(&none_found, signal, 0, NULL, SS_TSV, NULL), NULL);
    assert_int_equal(ss_backbone_write(&none_found, signal, 0, stdout, SS_TSV, NULL), SS_EINVAL);
    assert_refused(ss_backbone_scene(NULL, &none_found, signal, 0, 1, NULL), NULL);
    assert_refused(ss_backbone_scene(&scene, NULL, signal, 0, 1, NULL), NULL);
    assert_refused(ss_backbone_scene(&scene, &none_found, NULL, 0, 1, NULL), NULL);
    assert_refused(ss_ridge_write(&none, NULL, NULL, NULL, SS_TSV, NULL), NULL);
    assert_refused(ss_ridge_write(NULL, NULL, NULL, stdout, SS_TSV, NULL), NULL);
    assert_refused(ss_plot_backbone(NULL, &none_found, signal, 0, NULL, NULL), NULL);
    assert_refused(ss_plot_backbone(stdout, NULL, signal, 0, NULL, NULL), NULL);
    assert_refused(ss_plot_backbone(stdout, &none_found, NULL, 0, NULL, NULL), NULL);
    ss_backbone_free(NULL);
    e.text[0] = '\0';
    assert_refused(ss_ranking_new(NULL, signal, 0, &scene, 1, NULL, &e), &e);
    assert_refused(ss_ranking_new(&ranking, NULL, 0, &scene, 1, NULL, &e), &e);
    assert_refused(ss_ranking_new(&ranking, signal, 0, NULL, 1, NULL, &e), &e);
    ss_motion_ranking *law;
    ss_motion_opts motion;
    assert_refused(ss_motion_ranking_new(NULL, signal, 0, 0, NULL, &e), &e);
    assert_refused(ss_motion_ranking_new(&law, NULL, 0, 0, NULL, &e), &e);
    assert_int_equal(ss_motion_ranking_new(&law, signal, 0, 9, NULL, &e), SS_EINVAL);
    ss_motion_opts_init(&motion, sizeof motion);
    motion.delay = -1;
    assert_int_equal(ss_motion_ranking_new(&law, signal, 0, 0, &motion, &e), SS_EINVAL);
    motion.size = 0;
    assert_int_equal(ss_motion_ranking_new(&law, signal, 0, 0, &motion, &e), SS_EINVAL);
    assert_refused(ss_plot_motion(NULL, signal, 0, 0, &(ss_motion_ranking){ .n = 0 }, NULL, &e), &e);
    assert_refused(ss_plot_motion(stdout, NULL, 0, 0, &(ss_motion_ranking){ .n = 0 }, NULL, &e), &e);
    assert_refused(ss_plot_motion(stdout, signal, 0, 0, NULL, NULL, &e), &e);
    assert_int_equal(ss_plot_motion(stdout, signal, 0, 0, &(ss_motion_ranking){ .n = 0 }, NULL, &e), SS_EINVAL);
    assert_refused(ss_motion_ranking_write(NULL, stdout, SS_TSV, &e), &e);
    assert_refused(ss_motion_ranking_write(&(ss_motion_ranking){ .n = 0 }, NULL, SS_TSV, &e), &e);
    assert_refused(ss_scene_fit(NULL, signal, 0, &scene, NULL, &e), &e);
    assert_refused(ss_scene_fit(&fit, NULL, 0, &scene, NULL, &e), &e);
    assert_refused(ss_scene_fit(&fit, signal, 0, NULL, NULL, &e), &e);
    ss_steps_opts how;
    ss_steps_opts_init(&how, sizeof how);
    assert_true(how.size == sizeof how && how.normal == -1);
    assert_refused(ss_steps_find(NULL, signal, 0, 0, NULL, &e), &e);
    assert_refused(ss_steps_find(&steps, NULL, 0, 0, NULL, &e), &e);
    for (size_t i = 0; i < 3; i++) {
        how.stiffness = ((const double[]){ INFINITY, -1, NAN })[i];
        assert_int_equal(ss_steps_find(&steps, signal, 0, 0, &how, &e), SS_EINVAL);
    }
    assert_refused(ss_steps_write(NULL, stdout, SS_TSV, &e), &e);
    assert_refused(ss_plot_steps(stdout, NULL, NULL, &e), &e);
    ss_steps_free(NULL);
    assert_refused(ss_pull_fit(NULL, signal, 0, &scene, NULL, &e), &e);
    assert_refused(ss_pull_fit(&pull, NULL, 0, &scene, NULL, &e), &e);
    assert_refused(ss_pull_fit(&pull, signal, 0, NULL, NULL, &e), &e);
    assert_int_equal(ss_scene_is_pulled(NULL), 0);
    ss_pull_free(NULL);
    ss_signal_free(signal);
    ss_header_free(head);
}

/* Options of a caller whose header had fewer fields get defaults for the rest. */
static void
options_know_their_size(void **state)
{
    ss_features_opts features;
    ss_steady_opts steady;
    ss_sweep_opts sweep;
    ss_trade_opts trade;
    ss_error e = { 0 };
    (void)state;
    ss_features_opts_init(&features, sizeof features);
    ss_backbone_opts backbone;
    ss_backbone_opts_init(&backbone, sizeof backbone);
    assert_true(backbone.size == sizeof backbone && backbone.mode == 0);
    ss_steady_opts_init(&steady, sizeof steady);
    ss_sweep_opts_init(&sweep, sizeof sweep);
    ss_trade_opts_init(&trade, sizeof trade);
    assert_true(features.size == sizeof features && features.displacement == -1 && features.threads == 1);
    assert_true(steady.size == sizeof steady && steady.max_period == 8);
    assert_true(sweep.size == sizeof sweep && sweep.shards == 1 && sweep.steady == NULL);
    assert_true(trade.size == sizeof trade && trade.budget == 10 && trade.span == 80);
    steady.max_steps = 0;
    ss_steady_opts_init(&steady, offsetof(ss_steady_opts, max_steps));
    assert_true(steady.size == offsetof(ss_steady_opts, max_steps) && steady.max_steps == 0);
    sweep.steady = &steady;
    assert_int_equal(ss_sweep_check(&scene, &sweep, &e), SS_OK);
    steady.size = sizeof steady + 1;
    assert_int_equal(ss_sweep_check(&scene, &sweep, &e), SS_EINVAL);
    assert_non_null(strstr(e.text, "initialised"));
    ss_steady_opts_init(&steady, sizeof steady.size - 1);       /* no room for the size: nothing is written */
    assert_true(steady.size == sizeof steady + 1);
    ss_steady_opts_init(NULL, sizeof steady);
}

static void
sweeps_refuse_null(void **state)
{
    ss_error e = { 0 };
    FILE *in = tmpfile();
    ss_axis axis = { .n = 0 };
    ss_steady steady = { .n_strobes = 0 };
    ss_steady_opts how;
    ss_steady_opts_init(&how, sizeof how);
    ss_sweep_opts opts = { .size = sizeof opts, .steady = &how, .axis = &axis, .n_axes = 1, .shards = 1,
                           .threads = 1, .sink = no_rows }, no_axis = opts, no_sink = opts;
    (void)state;
    no_axis.axis = NULL;
    no_sink.sink = NULL;
    assert_refused(ss_axis_parse(NULL, "mass=1:2:3", &e), &e);
    assert_refused(ss_axis_parse(&axis, NULL, &e), &e);
    assert_refused(ss_steady_find(NULL, &scene, NULL, &e), &e);
    assert_refused(ss_steady_find(&steady, NULL, NULL, &e), &e);
    assert_int_equal(ss_steady_find(&steady, &scene, &(ss_steady_opts){ .size = 1 }, &e), SS_EINVAL);
    ss_scene light = scene;
    light.mass = 0;
    assert_int_equal(ss_steady_find(&steady, &light, NULL, &e), SS_EINVAL);
    assert_string_equal(e.text, "mass = 0 is out of range, it must be > 0");
    assert_int_equal(ss_sweep_check(&scene, &(ss_sweep_opts){ .shards = 1 }, &e), SS_EINVAL);
    assert_refused(ss_sweep_check(NULL, &opts, &e), &e);
    assert_refused(ss_sweep_check(&scene, NULL, &e), &e);
    assert_refused(ss_sweep_check(&scene, &no_axis, &e), &e);
    assert_refused(ss_sweep_run(NULL, &opts, &e), &e);
    assert_refused(ss_sweep_run(&scene, NULL, &e), &e);
    assert_refused(ss_sweep_run(&scene, &no_sink, &e), &e);
    ss_sweep_text text = { "x", &scene, &opts, NULL, 1, SS_TSV }, none = { .name = "x" },
        numbers = { "x", &scene, &opts, NULL, 0, SS_AU };
    ss_sweep_done done;
    assert_refused(ss_sweep_write(&numbers, NULL, NULL, &done, &e), &e);
    assert_refused(ss_sweep_write(&numbers, in, NULL, NULL, &e), &e);
    assert_int_equal(ss_sweep_write(NULL, in, NULL, &done, NULL), SS_EINVAL);
    assert_int_equal(ss_sweep_write(&text, in, NULL, &done, NULL), SS_EINVAL);
    assert_int_equal(ss_sweep_write(&none, in, NULL, &done, NULL), SS_EINVAL);
    assert_int_equal(ss_sweep_write(&numbers, in, NULL, &done, NULL), SS_EINVAL);
    assert_int_equal(ss_sweep_write(&numbers, in, "in", &done, NULL), SS_EINVAL);
    const ss_measure second[] = { SS_PERIOD, (ss_measure)SS_MEASURES };
    ss_axis mass = { .key = "mass", .from = 1, .to = 2, .n = 2 };
    ss_sweep_opts two = opts;
    two.axis = &mass;
    ss_sweep_text wrong = { "x", &scene, &two, second, 2, SS_TSV };
    char said[40];
    snprintf(said, sizeof said, "no measure %d", SS_MEASURES);
    assert_int_equal(ss_sweep_write(&wrong, in, NULL, &done, &e), SS_EINVAL);
    assert_string_equal(e.text, said);
    assert_int_equal(ftell(in), 0);
    assert_int_equal(axis.n, 0);
    fclose(in);
}

static void
rankings_refuse_null(FILE *out)
{
    static const char *const names[] = { "mine" };
    static ss_rank_row row;
    const ss_ranking ranking = { .n = 1, .row = &row }, empty = { .n = 0 };
    const ss_ranking_text about = { "s", "a", "its name", names, 0 };
    ss_rank_opts of_none, no_size = { .size = 0 };
    ss_error e = { 0 };
    ss_rank_opts_init(&of_none, sizeof unknown);
    of_none.quantity = (ss_quantity)SS_QUANTITIES;
    assert_refused(ss_ranking_write(NULL, &about, NULL, out, SS_TSV, &e), &e);
    assert_int_equal(ss_ranking_write(&empty, &about, NULL, out, SS_TSV, &e), SS_EINVAL);
    assert_refused(ss_ranking_write(&ranking, NULL, NULL, out, SS_TSV, &e), &e);
    assert_refused(ss_ranking_write(&ranking, &(ss_ranking_text){ "s", "a", "its name", NULL, 0 }, NULL,
                                    out, SS_TSV, &e), &e);
    assert_int_equal(ss_ranking_write(&ranking, &about, &of_none, out, SS_TSV, &e), SS_EINVAL);
    assert_int_equal(ss_ranking_write(&ranking, &about, &no_size, out, SS_TSV, &e), SS_EINVAL);
    assert_refused(ss_ranking_write(&ranking, &about, NULL, NULL, SS_TSV, &e), &e);
    assert_int_equal(ss_ranking_write(&ranking, &about, NULL, out, SS_AU, &e), SS_EINVAL);
}

static void
summaries_refuse_null(FILE *out)
{
    const ss_features features = { .n = 0 };
    ss_signal signal = { .head = NULL };
    assert_int_equal(ss_header_new(&signal.head, 1, 0, NULL), SS_OK);
    ss_table *table = NULL;
    FILE *in = tmpfile();
    assert_int_equal(ss_summary_write(NULL, &features, &signal, 0, NULL, out, NULL), SS_EINVAL);
    assert_int_equal(ss_summary_write("mine", &features, NULL, 0, NULL, out, NULL), SS_EINVAL);
    assert_int_equal(ss_summary_write("mine", &features, &signal, 0, NULL, out, NULL), SS_EINVAL);
    assert_int_equal(ss_summary_write("mine", NULL, NULL, 0, NULL, out, NULL), SS_EINVAL);
    assert_int_equal(ss_summary_write("mine", NULL, NULL, 0, "why", NULL, NULL), SS_EINVAL);
    assert_int_equal(ss_summary_write("mine", NULL, NULL, 0, "why", in, NULL), SS_OK);
    rewind(in);
    assert_int_equal(ss_table_read(&table, in, "in", SS_KIND_SUMMARIES, NULL), SS_OK);
    assert_int_equal(table->n, 1);
    assert_string_equal(table->cell[table->n_columns - 1], "why");
    for (size_t c = 1; c + 1 < table->n_columns; c++)
        assert_string_equal(table->cell[c], "-");
    assert_int_equal(ss_summaries_write(NULL, out, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_summaries_write(table, NULL, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_summaries_write(table, out, SS_AU, NULL), SS_EINVAL);
    table->n_columns--;
    assert_int_equal(ss_summaries_write(table, out, SS_TSV, NULL), SS_EDATA);
    table->n_columns++;
    ss_table_free(table);
    ss_header_free(signal.head);
    fclose(in);
}

/* Of what tools write as text: NULL, a column that is not there, a format that has no words. */
static void
writers_of_rows_refuse_null(void **state)
{
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    ss_writer *writer = NULL;
    const ss_contents events = { .signal = head, .events = 1 };
    ss_event event = { .kind = (ss_event_kind)7 };
    ss_features features = { .n = 0 };
    ss_signal signal = { .head = head };
    const ss_features_opts *const opts = NULL;
    static const ss_trade trade;
    static const ss_models models;
    char *sentence = NULL;
    ss_need need = { 0, 1 };
    FILE *out = tmpfile();
    (void)state;
    assert_int_equal(ss_writer_new(NULL, out, NULL, SS_TSV, &events, NULL), SS_EINVAL);
    assert_int_equal(ss_writer_new(&writer, NULL, NULL, SS_TSV, &events, NULL), SS_EINVAL);
    assert_int_equal(ss_writer_new(&writer, out, NULL, SS_TSV, &(ss_contents){ .events = 1 }, NULL), SS_EINVAL);
    assert_int_equal(ss_writer_new(&writer, out, NULL, SS_AU, &events, NULL), SS_EINVAL);
    assert_int_equal(ss_writer_new(&writer, out, NULL, (ss_format)9, &events, NULL), SS_EINVAL);
    assert_int_equal(ss_writer_events(NULL, &event, 1, NULL), SS_EINVAL);
    assert_int_equal(ss_writer_new(&writer, out, NULL, SS_TSV, &events, NULL), SS_OK);
    assert_int_equal(ss_writer_events(writer, NULL, 1, NULL), SS_EINVAL);
    assert_int_equal(ss_writer_events(writer, &event, 1, NULL), SS_EINVAL);
    assert_int_equal(ss_writer_end(NULL, 0, NULL), SS_EINVAL);
    ss_writer_free(writer);
    ss_writer_free(NULL);
    assert_int_equal(ss_features_write(NULL, &signal, 0, opts, out, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_features_write(&features, NULL, 0, opts, out, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_features_write(&features, &signal, 0, opts, out, SS_TSV, NULL), SS_EINVAL);
    summaries_refuse_null(out);
    assert_int_equal(ss_trade_write(NULL, "x", out, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_trade_write(&trade, NULL, out, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_trade_write(&trade, "x", NULL, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_trade_write(&trade, "x", out, SS_AU, NULL), SS_EINVAL);
    assert_int_equal(ss_models_write(NULL, "x", NULL, 0, out, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_models_write(&models, NULL, NULL, 0, out, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_models_write(&models, "x", NULL, 1, out, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_models_write(&models, "x", NULL, 0, NULL, SS_TSV, NULL), SS_EINVAL);
    assert_int_equal(ss_models_write(&models, "x", NULL, 0, out, SS_AU, NULL), SS_EINVAL);
    assert_int_equal(ss_models_answer(NULL, &models, &need, 1, NULL), SS_EINVAL);
    assert_int_equal(ss_models_answer(&sentence, NULL, &need, 1, NULL), SS_EINVAL);
    assert_int_equal(ss_models_answer(&sentence, &models, NULL, 1, NULL), SS_EINVAL);
    rankings_refuse_null(out);
    ss_table *table = NULL;
    ss_error e = { 0 };
    assert_refused(ss_table_read(NULL, out, "out", SS_KIND_EVENTS, &e), &e);
    assert_refused(ss_table_read(&table, NULL, "out", SS_KIND_EVENTS, &e), &e);
    assert_refused(ss_table_read(&table, out, NULL, SS_KIND_EVENTS, &e), &e);
    assert_int_equal(ss_table_read(&table, out, "out", SS_KIND_SIGNAL, &e), SS_EINVAL);
    assert_null(ss_table_note(NULL, "scene"));
    ss_table_free(NULL);
    assert_int_equal(ss_format_at(NULL, 0), 0);
    ss_header_free(head);
    fclose(out);
}

static void
overlays_refuse_null(void **state)
{
    FILE *in = tmpfile();
    ss_overlay *overlay = NULL;
    ss_error e;
    (void)state;
    for (ss_kind kind = SS_KIND_FEATURES; kind <= SS_KIND_EVENTS; kind++) {
        assert_refused(ss_overlay_read(NULL, in, "in", kind, &e), &e);
        assert_refused(ss_overlay_read(&overlay, NULL, "in", kind, &e), &e);
        assert_refused(ss_overlay_read(&overlay, in, NULL, kind, &e), &e);
    }
    assert_int_equal(ss_overlay_read(&overlay, in, "in", SS_KIND_SWEEP, &e), SS_EINVAL);
    ss_overlay_free(NULL);
    fclose(in);
}

static void
plots_refuse_null(void **state)
{
    static const ss_coefficients c;
    static const ss_models models;
    static const ss_trade trade;
    static const ss_table table;
    static const size_t y[2];
    static ss_plot_opts none;           /* they were not initialised */
    ss_plot_opts opts;
    ss_error e = { 0 };
    FILE *out = tmpfile();
    (void)state;
    ss_plot_opts_init(&opts, sizeof opts);
    static const ss_header head;
    ss_signal *signal;
    ss_reader *reader;
    assert_int_equal(ss_signal_new(&signal, &head, 1, &e), SS_OK);
    assert_refused(ss_reader_of_signal(NULL, signal, &e), &e);
    assert_refused(ss_reader_of_signal(&reader, NULL, &e), &e);
    assert_int_equal(ss_reader_of_signal(&reader, signal, &e), SS_OK);
    assert_refused(ss_plot_signal(NULL, reader, NULL, 0, &opts, &e), &e);
    assert_refused(ss_plot_signal(out, NULL, NULL, 0, &opts, &e), &e);
    assert_refused(ss_plot_signal(out, reader, NULL, 1, &opts, &e), &e);
    assert_int_equal(ss_plot_signal(out, reader, NULL, 0, &none, &e), SS_EINVAL);
    assert_int_equal(ss_plot_signal(out, reader, NULL, 0, &opts, &e), SS_EINVAL);
    assert_refused(ss_plot_xy(NULL, reader, 0, 0, &opts, &e), &e);
    assert_refused(ss_plot_xy(out, NULL, 0, 0, &opts, &e), &e);
    assert_int_equal(ss_plot_xy(out, reader, 0, 0, &none, &e), SS_EINVAL);
    assert_refused(ss_overview_read(NULL, reader, 0, &ss_morlet_defaults, &e), &e);
    assert_refused(ss_plot_spectrum(NULL, reader, y, 1, &opts, &e), &e);
    assert_refused(ss_plot_spectrum(out, NULL, y, 1, &opts, &e), &e);
    assert_refused(ss_plot_spectrum(out, reader, NULL, 1, &opts, &e), &e);
    assert_int_equal(ss_plot_spectrum(out, reader, y, 1, &none, &e), SS_EINVAL);
    assert_int_equal(ss_plot_spectrum(out, reader, y, 0, &opts, &e), SS_EINVAL);
    e.text[0] = '\0';
    assert_refused(ss_spectrum_write(reader, y, 1, &opts, NULL, SS_TSV, &e), &e);
    assert_refused(ss_spectrum_write(NULL, y, 1, &opts, out, SS_TSV, &e), &e);
    assert_refused(ss_spectrum_write(reader, NULL, 1, &opts, out, SS_TSV, &e), &e);
    assert_int_equal(ss_spectrum_write(reader, y, 1, &opts, out, SS_AU, &e), SS_EINVAL);
    assert_int_equal(ss_spectrum_write(reader, y, 0, &opts, out, SS_TSV, &e), SS_EINVAL);
    ss_reader_free(reader);
    ss_signal_free(signal);
    const double x[16] = { 0 };
    ss_overview *overview;
    ss_spectrum *spectrum;
    assert_refused(ss_spectrum_new(NULL, x, 16, 1, 0, &e), &e);
    assert_refused(ss_spectrum_new(&spectrum, NULL, 16, 1, 0, &e), &e);
    ss_spectrum_free(NULL);
    assert_refused(ss_overview_read(&overview, NULL, 0, &ss_morlet_defaults, &e), &e);
    ss_overview_free(NULL);
    ss_contour_opts plain;
    ss_contour_opts_init(&plain, sizeof plain);
    assert_refused(ss_plot_contour(NULL, &c, NULL, &opts, &e), &e);
    assert_refused(ss_plot_contour(out, NULL, NULL, &opts, &e), &e);
    plain.size = 1;
    assert_int_equal(ss_plot_contour(out, &c, &plain, &opts, &e), SS_EINVAL);
    assert_int_equal(ss_plot_contour(out, &c, NULL, &none, &e), SS_EINVAL);
    assert_refused(ss_plot_models(NULL, &models, &opts, &e), &e);
    assert_refused(ss_plot_models(out, NULL, &opts, &e), &e);
    assert_int_equal(ss_plot_models(out, &models, &none, &e), SS_EINVAL);
    assert_refused(ss_plot_trade(NULL, &trade, &opts, &e), &e);
    assert_refused(ss_plot_trade(out, NULL, &opts, &e), &e);
    assert_int_equal(ss_plot_trade(out, &trade, &none, &e), SS_EINVAL);
    assert_refused(ss_plot_sweep(NULL, &table, y, 2, &opts, &e), &e);
    assert_refused(ss_plot_sweep(out, NULL, y, 2, &opts, &e), &e);
    assert_refused(ss_plot_sweep(out, &table, NULL, 2, &opts, &e), &e);
    assert_int_equal(ss_plot_sweep(out, &table, y, 2, &none, &e), SS_EINVAL);
    assert_int_equal(ftell(out), 0);
    assert_non_null(ss_store_calls(&e));
    fclose(out);
}

/* A caller's stray integer in place of an enumeration, or a number that is none. */
/* They are refused, as a program that was compiled with a later header might count on what it set. */
static void
options_of_another_size_are_refused(void **state)
{
    struct { ss_read_opts known; double later; } opts;
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    (void)state;
    ss_read_opts_init(&opts.known, sizeof opts);
    assert_int_equal(ss_signal_read(&signal, NULL, "/dev/null", &opts.known, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "were they initialised?"));
    opts.known.size = 0;
    assert_int_equal(ss_signal_read(&signal, NULL, "/dev/null", &opts.known, &err), SS_EINVAL);
    ss_read_opts_init(&opts.known, offsetof(ss_read_opts, progress));
    assert_int_equal(ss_signal_read(&signal, NULL, "/dev/null", &opts.known, &err), SS_EDATA);
}

static void
refuses_what_is_no_known_choice(void **state)
{
    const int stray[] = { -1, 99 };
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    ss_signal *signal = NULL;
    FILE *in = tmpfile();
    (void)state;
    assert_int_equal(ss_header_add_column(head, "x", "m", NULL), SS_OK);
    assert_int_equal(ss_signal_new(&signal, head, 2, NULL), SS_OK);
    for (int i = 0; i < 2; i++) {
        int k = stray[i];
        ss_scene copy = scene;
        ss_morlet_opts norm = ss_morlet_defaults, detrend = norm, engine = norm;
        ss_rank_opts rank;
        ss_rank_opts_init(&rank, sizeof rank);
        ss_read_opts gaps = { READ_OPTS, .gaps = (ss_gaps)k };
        ss_morlet *plan;
        ss_reader *reader;
        ss_writer *writer;
        ss_signal *made;
        ss_ranking *ranking;
        ss_fit fit;
        copy.model = NULL;
        norm.norm = (ss_norm)k;
        detrend.detrend = (ss_detrend)k;
        engine.engine = (ss_engine)k;
        rank.quantity = (ss_quantity)k;
        assert_int_equal(ss_scene_check(&copy, NULL), SS_EINVAL);
        assert_int_equal(ss_scene_write(&copy, in, NULL), SS_EINVAL);
        assert_true(isnan(ss_scene_get(&copy, "mass")));
        assert_null(ss_model_named(NULL));
        assert_null(ss_model_at((size_t)k));
        assert_null(ss_sim_method_for(&copy, NULL));
        assert_int_equal(ss_steady_find(&(ss_steady){ .n_strobes = 0 }, &copy, NULL, NULL), SS_EINVAL);
        assert_int_equal(ss_morlet_new(&plan, 64, 1, &norm, NULL), SS_EINVAL);
        assert_int_equal(ss_morlet_new(&plan, 64, 1, &detrend, NULL), SS_EINVAL);
        assert_int_equal(ss_morlet_new(&plan, 64, 1, &engine, NULL), SS_EINVAL);
        assert_int_equal(ss_coefficients_header(&(ss_header *){ NULL }, head, 0, 2, &norm, NULL),
                         SS_EINVAL);
        assert_int_equal(ss_wave_new(&made, (ss_wave)k, &ss_wave_defaults, NULL), SS_EINVAL);
        assert_int_equal(ss_reader_new(&reader, in, "in", &gaps, NULL), SS_EINVAL);
        assert_int_equal(ss_format_at(&(ss_format_info){ .name = NULL }, (size_t)k), 0);
        assert_null(ss_time_unit_name((size_t)k));
        assert_int_equal(ss_writer_new(&writer, in, NULL, (ss_format)k,
                                       &(ss_contents){ .signal = head }, NULL), SS_EINVAL);
        assert_int_equal(ss_record_write(&(ss_record){ .signal = signal }, in, NULL, (ss_format)k, NULL),
                                         SS_EINVAL);
        assert_int_equal(ss_ranking_new(&ranking, signal, 0, &scene, 1, &rank, NULL), SS_EINVAL);
        assert_int_equal(ss_scene_fit(&fit, signal, 0, &scene, &rank, NULL), SS_EINVAL);
        assert_string_equal(ss_model_name(NULL), "?");
        assert_int_equal(ss_model_has_events(NULL), 0);
        assert_int_equal(ss_model_is_linear(NULL), 0);
        assert_string_equal(ss_event_kind_name((ss_event_kind)k), "?");
        assert_string_equal(ss_spike_kind_name((ss_spike_kind)k), "?");
        assert_null(ss_measure_label((ss_measure)k));
        assert_string_equal(ss_strerror((ss_status)k), "unknown status");
    }
    static const double no_rate[] = { -1, NAN, INFINITY };
    for (int i = 0; i < 3; i++) {
        ss_read_opts opts = { READ_OPTS, .rate = no_rate[i] };
        ss_reader *reader;
        assert_int_equal(ss_reader_new(&reader, in, "in", &opts, NULL), SS_EINVAL);
    }
    assert_int_equal(ftell(in), 0);
    assert_string_equal(ss_version(), SS_VERSION);
    fclose(in);
    ss_signal_free(signal);
    ss_header_free(head);
}

static void
nothing_is_freed_without_complaint(void **state)
{
    (void)state;
    ss_header_free(NULL);
    ss_reader_free(NULL);
    ss_signal_free(NULL);
    ss_writer_free(NULL);
    ss_morlet_free(NULL);
    ss_coefficients_free(NULL);
    ss_trade_free(NULL);
    ss_models_free(NULL);
    ss_stream_free(NULL);
    ss_writer_free(NULL);
    ss_features_free(NULL);
    ss_ranking_free(NULL);
    ss_motion_ranking_free(NULL);
}

static void
every_status_has_words_of_its_own(void **state)
{
    (void)state;
    for (int a = SS_OK; a <= SS_ERANGE; a++) {
        assert_string_not_equal(ss_strerror((ss_status)a), "unknown status");
        for (int b = SS_OK; b < a; b++)
            assert_string_not_equal(ss_strerror((ss_status)a), ss_strerror((ss_status)b));
    }
    ss_error err;
    assert_int_equal(ss_fail_memory(&err, NULL), SS_ENOMEM);
    assert_string_equal(err.text, ss_strerror(SS_ENOMEM));
    assert_int_equal(ss_fail_memory(&err, "run.tsv"), SS_ENOMEM);
    assert_memory_equal(err.text, "run.tsv: ", 9);
    assert_string_equal(err.text + 9, ss_strerror(SS_ENOMEM));
}

/* Letters of UTF-8 stay; what drives a terminal of 7 or 8 bits, or of UTF-8, does not. */
static void
a_printable_text_drives_no_terminal(void **state)
{
    static const struct { const char *text, *is; } row[] = {
        { "", "" }, { "a b~", "a b~" }, { "\033[2J\a\n\r\t\177", "?[2J?????" },
        { "\303\233 \342\200\233 \360\237\220\233", "\303\233 \342\200\233 \360\237\220\233" },
        { "\2332J", "?2J" }, { "\302\2332J", "??2J" }, { "a\237\233b", "a??b" },
        { "\302\240\302\251", "\302\240\302\251" }, { "\302", "\302" }, { "\302\302\233", "\302??" },
    };
    (void)state;
    assert_null(ss_printable(NULL));
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char text[32];
        strcpy(text, row[i].text);
        assert_ptr_equal(ss_printable(text), text);
        assert_string_equal(text, row[i].is);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_of_another_size_are_refused),
        cmocka_unit_test(readers_refuse_null),
        cmocka_unit_test(a_printable_text_drives_no_terminal),
        cmocka_unit_test(makers_and_writers_refuse_null),
        cmocka_unit_test(headers_and_samples_refuse_null),
        cmocka_unit_test(simulations_refuse_null),
        cmocka_unit_test(transforms_refuse_null),
        cmocka_unit_test(conclusions_refuse_null),
        cmocka_unit_test(sweeps_refuse_null),
        cmocka_unit_test(writers_of_rows_refuse_null),
        cmocka_unit_test(options_know_their_size),
        cmocka_unit_test(overlays_refuse_null),
        cmocka_unit_test(plots_refuse_null),
        cmocka_unit_test(refuses_what_is_no_known_choice),
        cmocka_unit_test(every_status_has_words_of_its_own),
        cmocka_unit_test(nothing_is_freed_without_complaint),
    };
    ss_scene_set_text(&scene, "model", "compliant", NULL);
    ss_scene_set(&scene, "contact_stiffness", 1, NULL);
    return cmocka_run_group_tests_name("arguments", tests, NULL, NULL);
}
