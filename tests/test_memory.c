/* test_memory.c -- every allocation of the library's own fails once, alone and with all after it:
 * the call says SS_ENOMEM, nothing crashes and nothing is lost.
 *
 * The linker leads the library's calls of malloc and its kin through here (--wrap), and those that make an object
 * of GSL; what libc, GSL, FFTW and HDF5 allocate within stays their own.  So does a permutation of GSL, without which
 * a fit only takes longer.  What the library leaves to its caller is freed as a caller would, so that whatever is
 * still there at the end of a run has been lost. */
#include <fftw3.h>
#include <hdf5.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_interp.h>
#include <gsl/gsl_multifit.h>
#include <gsl/gsl_multilarge_nlinear.h>
#include <gsl/gsl_multimin.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_qrng.h>
#include <gsl/gsl_rng.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <stickslip.h>
#include "map/map.h"
#include "signal/source.h"

#include "find/drops.h"
#include "find/events.h"
#include "find/maxima.h"
#include "store_samples.h"
#include "unit.h"
#include "read_opts.h"
#include "scene/scene.h"
#include "signal/header.h"
#include "signal/noise.h"
#include "morlet_point.h"

/* --- the allocator ------------------------------------------------------------------------- */

enum { MOST = 1 << 16 };
static struct {
    pthread_mutex_t lock;
    int counting;
    size_t calls, fail_at;      /* the call that fails, from 1; 0: none */
    int and_all_after;
    size_t live;
    void *block[MOST];          /* there since counting began */
} heap = { .lock = PTHREAD_MUTEX_INITIALIZER };

/* May this call have memory? */
static int
grant(void)
{
    pthread_mutex_lock(&heap.lock);
    size_t call = heap.counting ? ++heap.calls : 0;
    int refused = call != 0 && heap.fail_at != 0
                  && (call == heap.fail_at || (heap.and_all_after && call > heap.fail_at));
    pthread_mutex_unlock(&heap.lock);
    return !refused;
}

static void *
gave(void *p)
{
    pthread_mutex_lock(&heap.lock);
    if (heap.counting && p != NULL && heap.live < MOST)
        heap.block[heap.live++] = p;
    pthread_mutex_unlock(&heap.lock);
    return p;
}

static void
took(void *p)
{
    pthread_mutex_lock(&heap.lock);
    for (size_t i = heap.live; i-- > 0; )
        if (heap.block[i] == p) {
            heap.block[i] = heap.block[--heap.live];
            break;
        }
    pthread_mutex_unlock(&heap.lock);
}

void *__real_malloc(size_t);
void *__real_calloc(size_t, size_t);
void *__real_realloc(void *, size_t);
char *__real_strdup(const char *);
char *__real_strndup(const char *, size_t);
FILE *__real_open_memstream(char **, size_t *);
void *__real_fftw_malloc(size_t);
void __real_fftw_free(void *);
void __real_free(void *);
void *__wrap_malloc(size_t);
void *__wrap_calloc(size_t, size_t);
void *__wrap_realloc(void *, size_t);
char *__wrap_strdup(const char *);
char *__wrap_strndup(const char *, size_t);
FILE *__wrap_open_memstream(char **, size_t *);
void *__wrap_fftw_malloc(size_t);
void __wrap_fftw_free(void *);
void __wrap_free(void *);

void *
__wrap_malloc(size_t size)
{
    return grant() ? gave(__real_malloc(size)) : NULL;
}

void *
__wrap_calloc(size_t n, size_t size)
{
    return grant() ? gave(__real_calloc(n, size)) : NULL;
}

void *
__wrap_realloc(void *p, size_t size)
{
    if (!grant())
        return NULL;
    took(p);
    return gave(__real_realloc(p, size));
}

char *
__wrap_strdup(const char *text)
{
    return grant() ? gave(__real_strdup(text)) : NULL;
}

char *
__wrap_strndup(const char *text, size_t n)
{
    return grant() ? gave(__real_strndup(text, n)) : NULL;
}

FILE *
__wrap_open_memstream(char **text, size_t *size)
{
    return grant() ? __real_open_memstream(text, size) : NULL;
}

void *
__wrap_fftw_malloc(size_t size)
{
    return grant() ? gave(__real_fftw_malloc(size)) : NULL;
}

void
__wrap_fftw_free(void *p)
{
    took(p);
    __real_fftw_free(p);
}

void
__wrap_free(void *p)
{
    took(p);
    __real_free(p);
}

/* What GSL makes: one call, whatever it allocates within. */
#define WRAP(type, name, parameters, arguments) \
    type *__real_##name##_alloc parameters; \
    type *__wrap_##name##_alloc parameters; \
    void __real_##name##_free(type *p); \
    void __wrap_##name##_free(type *p); \
    type *__wrap_##name##_alloc parameters { return grant() ? gave(__real_##name##_alloc arguments) : NULL; } \
    void __wrap_##name##_free(type *p) { took(p); __real_##name##_free(p); }

WRAP(gsl_vector, gsl_vector, (size_t n), (n))
WRAP(gsl_matrix, gsl_matrix, (size_t n, size_t m), (n, m))
WRAP(gsl_interp, gsl_interp, (const gsl_interp_type *type, size_t n), (type, n))
WRAP(gsl_rng, gsl_rng, (const gsl_rng_type *type), (type))
WRAP(gsl_qrng, gsl_qrng, (const gsl_qrng_type *type, unsigned n), (type, n))
WRAP(gsl_multimin_fminimizer, gsl_multimin_fminimizer, (const gsl_multimin_fminimizer_type *type, size_t n), (type, n))
WRAP(gsl_multilarge_nlinear_workspace, gsl_multilarge_nlinear,
     (const gsl_multilarge_nlinear_type *type, const gsl_multilarge_nlinear_parameters *how, size_t n, size_t p),
     (type, how, n, p))
WRAP(gsl_multifit_linear_workspace, gsl_multifit_linear, (size_t n, size_t p), (n, p))
WRAP(gsl_odeiv2_step, gsl_odeiv2_step, (const gsl_odeiv2_step_type *type, size_t n), (type, n))
WRAP(gsl_eigen_nonsymm_workspace, gsl_eigen_nonsymm, (size_t n), (n))
WRAP(gsl_integration_fixed_workspace, gsl_integration_fixed,
     (const gsl_integration_fixed_type *type, size_t n, double a, double b, double alpha, double beta),
     (type, n, a, b, alpha, beta))

static int closing_fails;
herr_t __real_H5Fclose(hid_t);
herr_t __wrap_H5Fclose(hid_t);

herr_t
__wrap_H5Fclose(hid_t file)
{
    herr_t done = __real_H5Fclose(file);
    return closing_fails ? -1 : done;
}

/* --- what is called ------------------------------------------------------------------------ */

/* Made before, with all the memory that it takes. */
enum { COULOMB, STATE_VARIABLE, COMPLIANT };    /* as in the list of models */
static ss_scene scene[3];
static ss_signal *signal, *cycles;      /* a tenth of a second; some slips in noise */
static ss_signal *pulled;               /* a few slips of a pulled mass */
static ss_scene pull;
static ss_table *sweep;
static ss_coefficients *coefficients;
static ss_trade *trade;
static char text[2][20000], path[64];   /* as text, as AU; an HDF5 file */
static size_t length[2];
static char coefficient_text[200000];
static size_t coefficient_length;
static char sweep_text[] = "# stickslip sweep 1\n# scene: s\n"
    "# columns: index mass/kg friction/N amplitude/m period status\n"
    "0\t1\t1\t1\t1\tok\n1\t1\t2\t2\t2\tok\n2\t1\t3\t3\taperiodic\tok\n"
    "3\t2\t1\t4\t1\tok\n4\t2\t2\t5\t2\tok\n5\t2\t3\t6\t1\tok\n"
    "6\t3\t1\t7\t1\tok\n7\t3\t2\t8\t2\tok\n8\t3\t3\t9\t1\tok\n"
    "9\t4\t1\t10\t1\tok\n10\t4\t2\t11\t2\tok\n11\t4\t3\t12\t1\tok\n";
static FILE *scrap;
static ss_error err;

typedef ss_status call(int variant);

static ss_status
headers(int variant)
{
    (void)variant;
    static const size_t pick[] = { 1, 0, 1 };
    ss_header *copy = NULL, *head = NULL;
    ss_header_new(&head, 1, 0, NULL);
    ss_status st = head == NULL ? SS_ENOMEM : ss_header_add_column(head, "x", "m", NULL);
    if (st == SS_OK)
        st = ss_header_add_column(head, "x", NULL, NULL);
    if (st == SS_OK)
        st = ss_header_note(head, "key", "value", NULL);
    if (st == SS_OK)
        st = ss_header_note(head, "key", "another", NULL);
    if (st == SS_OK)
        st = ss_header_select(&copy, head, pick, 3, 5, NULL);
    ss_header_free(copy);
    copy = NULL;
    if (st == SS_OK)
        st = ss_header_select(&copy, head, NULL, head->n_columns, 0, NULL);
    ss_header_free(copy);
    ss_header_free(head);
    return st;
}

static ss_status
read_streams(int variant)
{
    static char array[400];                     /* .npy with a header of 288 bytes, no NUL among them */
    snprintf(array, sizeof array, "\223NUMPY\1 %c%c%-288sabcd", 288 & 255, 288 >> 8,
             "{'descr': [('t', '|u1'), ('x', '|u1')], 'shape': (2,), 'fortran_order': False}");
    const char *const table[] = {
        "time (ms);\"x\";f\ns;m;N\n0,0;1,5;2\n1,0;2,5;3\n2,0;3;4\n",
        "# x y\n 0 1\n 0.25 2\n 0.5 4\n",
        "\"t\",\"Kraft \xe4\"\n0,1\n1,2\n",
        "1\t2\n2\tx\n",             /* three are malformed, and memory fails before that is found */
        "t;x\n0;1\n0,1;2\n7;3\n",
        "t;x\n0;1\n1;\n2;3\n4;5\n",
        "t;x\n0;1\n1;2\n1,5;3\n3;4\n4;5\n",
        "t,x,label\n0,1,ok\n0.1,2,ok\n0.2,3,\n",
        "2024-02-28T23:59:59,1\n2024-02-29T00:00:00,2\n",
        "LabVIEW Measurement\nX_Columns\tMulti\n***End_of_Header***\nY_Unit_Label\tN\tm\nX_Dimension\tTime\tTime\n"
        "X0\t0\t0\nDelta_X\t0,1\t0,1\n***End_of_Header***\nX_Value\ta\tX_Value\tb\tComment\n0\t1\t0\t2\tnow\n0,1\t3\t0,1\t4\n",
        "t,x\n0,1\nStep 2\nt,y\n0,1\n0.1,2\n",
        array,
        "time,x\n44197.5,1\n44197.50000011574,2\n44197.50000023148,3\n44197.500009,4\n",
        "time,x\n44197.5,1\n44197.50000011574,2\n44197.50000023148,3\n",
    };
    static const ss_calibration first = { "1", 2, "N" };
    static const ss_read_opts gaps = { READ_OPTS, .gaps = SS_GAPS_SPLIT }, uneven = { READ_OPTS, .resample = 7 },
        days = { READ_OPTS, .time_unit = "d" },
        second = { READ_OPTS, .table = 2, .from = 0, .to = 1, .calibration = &first, .n_calibrations = 1 };
    ss_signal *back = NULL;
    const ss_read_opts *opts = variant == 7 ? &gaps : variant == 8 ? &uneven : variant == 12 ? &second
        : variant == 15 ? &days : NULL;
    const char *from = variant < 2 ? text[variant] : table[variant - 2];
    FILE *in = fmemopen((void *)from, variant < 2 ? length[variant] : strlen(from), "r");
    ss_status st = ss_signal_read(&back, in, "in", opts, &err);
    fclose(in);
    ss_signal_free(back);
    return st >= SS_EDATA && st <= SS_ETABLES ? SS_OK : st;
}

/* As text, as AU, and as delimited text, which goes back without being kept. */
static ss_status
read_twice(int variant)
{
    static const char table[] = "t,x\n0,1\n0.1,\n0.2,3\n";
    static const ss_read_opts opts[] = { { READ_OPTS, .rewinds = 1 },
                                         { READ_OPTS, .gaps = SS_GAPS_INTERPOLATE, .rewinds = 1 } };
    double row[64], *column[16];
    for (int c = 0; c < 16; c++)
        column[c] = row + 4 * c;
    size_t n;
    ss_reader *reader = NULL;
    const char *from = variant < 2 ? text[variant] : table;
    FILE *in = fmemopen((void *)from, variant < 2 ? length[variant] : sizeof table - 1, "r");
    ss_status st = ss_reader_new(&reader, in, "in", &opts[variant >= 2], &err);
    for (int again = 0; st == SS_OK && again < 2; again++) {
        st = ss_reader_rows(reader, column, 4, &n, &err);
        if (st == SS_OK)
            st = ss_reader_rewind(reader, &err);
    }
    ss_reader_free(reader);
    fclose(in);
    return st;
}

static ss_status
write_streams(int variant)
{
    rewind(scrap);
    return ss_record_write(&(ss_record){ .signal = signal }, scrap, NULL, (ss_format)variant, NULL);
}

static ss_status
signals(int variant)
{
    static const size_t pick[] = { 0 };
    ss_signal *made = NULL;
    if (variant == 7) {
        ss_source *s = ss_source_of_signal(signal, "signal", NULL);
        ss_status resampled = s != NULL ? ss_source_resample(&s, 700, 0, INFINITY, NULL) : SS_ENOMEM;
        if (resampled == SS_OK)
            resampled = ss_source_all(&made, s, NULL);
        ss_source_free(s);
        ss_signal_free(made);
        return resampled;
    }
    if (variant == 8) {
        ss_filter_opts filter;
        ss_filter_opts_init(&filter, sizeof filter);
        filter.order = -1;
        filter.low_pass = signal->head->rate / 4;       /* a short one */
        ss_reader *reader = NULL;
        ss_status filtered = ss_reader_of_signal(&reader, signal, NULL);
        if (filtered == SS_OK)
            filtered = ss_reader_filter(reader, &filter, NULL);
        ss_status read = reader != NULL ? ss_signal_of_reader(&made, reader, NULL) : SS_OK;
        filtered = filtered == SS_OK ? read : filtered;
        ss_reader_free(reader);
        ss_signal_free(made);
        return filtered;
    }
    ss_wave_opts opts = ss_wave_defaults;
    opts.duration = 0.01;
    ss_status st = variant < 6 ? ss_wave_new(&made, (ss_wave)variant, &opts, &err)
                   : ss_signal_select(&made, signal, pick, 1, 3, 7, NULL);
    ss_signal_free(made);
    return st;
}

static ss_status
noises(int variant)
{
    ss_reader *reader = NULL;
    ss_noise_opts opts;
    ss_noise_done done = { .rms = NULL };
    double x[4], *to[16];
    size_t n;
    for (size_t c = 0; c < sizeof to / sizeof *to; c++)
        to[c] = x;
    ss_noise_opts_init(&opts, sizeof opts);
    opts.snr = variant == 0 ? 20 : NAN;
    opts.rms = variant == 0 ? NAN : 1;
    if (variant == 2)
        opts.band = (ss_range){ 0, signal->head->rate / 4 };
    opts.bits = 8;
    opts.range = 1;
    ss_status st = ss_reader_of_signal(&reader, signal, &err);
    if (st == SS_OK)
        st = ss_reader_noise(reader, &opts, &done, &err);
    ss_status read = reader != NULL ? ss_reader_rows(reader, to, 4, &n, &err) : SS_OK;  /* after a failure, too */
    ss_reader_free(reader);
    return st == SS_OK ? read : st;
}

static ss_status
bases(int variant)
{
    ss_base *base = NULL;
    ss_status st = ss_base_new(&base, signal, (size_t)variant, &err);
    ss_base_free(base);
    return st;
}

static ss_status
simulations(int variant)
{
    ss_signal *made = NULL;
    ss_status st = ss_sim_signal(&made, &scene[variant], &err);
    ss_signal_free(made);
    return st;
}

static ss_status
closed_forms(int variant)
{
    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
    opts.method = "exact";
    return ss_sim_run(&scene[variant == 0 ? COULOMB : COMPLIANT], &opts, NULL, &err);
}

static ss_status
trades(int variant)
{
    ss_trade *made = NULL;
    ss_trade_opts opts;
    ss_trade_opts_init(&opts, sizeof opts);
    ss_sim_opts chosen;
    ss_sim_opts_init(&chosen, sizeof chosen);
    ss_scene brief = scene[COULOMB];     /* as every allocation repeats what came before */
    opts.budget = 1e-3;
    chosen.method = NULL;
    brief.duration = 0.003;
    ss_status st = variant == 0 ? ss_trade_measure(&made, &brief, &opts, &err)
                   : ss_trade_choose(&chosen, &brief, 1e-6, &err);
    ss_trade_free(made);
    return st;
}

static ss_status
model_trades(int variant)
{
    ss_models *made = NULL;
    ss_scene brief = scene[COMPLIANT];
    const ss_need need = { 0, 0.1 };
    char *sentence = NULL;
    (void)variant;
    brief.settle = 0;
    brief.duration = 0.02;
    ss_status st = ss_models_measure(&made, &brief, NULL, &err);
    if (st == SS_OK)
        st = ss_models_answer(&sentence, made, &need, 1, &err);
    free(sentence);
    ss_models_free(made);
    return st;
}

static ss_status
transforms(int variant)
{
    ss_coefficients *made = NULL;
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.voices = 2;
    opts.engine = variant < 2 ? SS_ENGINE_QUADRATURE : SS_ENGINE_FFT;
    opts.threads = 1 + 2 * (variant % 2);
    opts.dense = variant >= 4;
    opts.detrend = variant == 5 ? SS_DETREND_LINEAR : SS_DETREND_NONE;
    opts.force = 1;
    ss_status st = ss_morlet_transform(&made, signal, 2, &opts, &err);
    ss_coefficients_free(made);
    return st;
}

static ss_status
comparisons(int variant)
{
    ss_morlet *plan = NULL;
    ss_morlet_opts opts = ss_morlet_defaults;
    double difference, point[2], *w = NULL, *x = signal->values + 2 * signal->n;
    opts.voices = 1;
    opts.engine = variant == 0 ? SS_ENGINE_FFT : SS_ENGINE_QUADRATURE;
    ss_status st = ss_morlet_new(&plan, signal->n, signal->head->rate, &opts, &err);
    if (st == SS_OK)
        st = (w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *w)) != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK)
        st = ss_morlet_execute(plan, x, w, &err);
    if (st == SS_OK)
        st = ss_morlet_compare(plan, x, w, 3, &difference, &err);
    if (st == SS_OK)
        st = point_at(x, signal->n, signal->head->rate, &opts, 0.01, 0.01,
                             point, &err);
    ss_morlet_free(plan);
    free(w);
    return st;
}

static int
drop_rows(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples,
          void *user)
{
    (void)scale, (void)first, (void)n, (void)w, (void)samples, (void)user;
    return 0;
}

static ss_status
streams(int variant)
{
    ss_stream *stream = NULL;
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.voices = 2;
    opts.fmin = 20;
    opts.threads = 1 + variant % 2;
    opts.dense = variant / 2;
    const double *x = signal->values;
    ss_status st = ss_stream_new(&stream, signal->head->rate, &opts, drop_rows, NULL, &err);
    if (st == SS_OK)
        st = ss_stream_push(stream, x, signal->n / 2, &err);
    if (st == SS_OK)
        st = ss_stream_drain(stream, &err);
    if (st == SS_OK)
        st = ss_stream_push(stream, x + signal->n / 2, signal->n - signal->n / 2, &err);
    if (st == SS_OK)
        st = ss_stream_end(stream, &err);
    ss_stream_free(stream);
    return st;
}

/* Scale by scale, into nothing. */
static ss_status
each_scale(int variant)
{
    ss_morlet *plan = NULL;
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.voices = 1;
    opts.threads = 1 + variant;
    ss_status st = ss_morlet_new(&plan, signal->n, signal->head->rate, &opts, &err);
    if (st == SS_OK)
        st = ss_morlet_each(plan, signal->values, drop_rows, NULL, &err);
    ss_morlet_free(plan);
    return st;
}

static ss_status
inverses(int variant)
{
    ss_signal *made = NULL;
    (void)variant;
    ss_status st = ss_morlet_inverse(&made, coefficients, 1e-2, NULL, (ss_progress){ NULL, NULL }, &err);
    ss_signal_free(made);
    return st;
}

static ss_status
read_coefficients(int variant)
{
    (void)variant;
    ss_coefficients *back = NULL;
    FILE *in = fmemopen(coefficient_text, coefficient_length, "r");
    ss_status st = ss_coefficients_read(&back, in, "in", &err);
    fclose(in);
    ss_coefficients_free(back);
    return st;
}

/* Made before, as it takes memory of FFTW's. */
static ss_status
features(int variant)
{
    ss_maximum *maxima = NULL;
    size_t n;
    double top;
    const maxima_kind kind = { .prominence = 1, .range = 60 };
    ss_status st = variant == 0 ? ss_maxima_of(&maxima, &n, coefficients, &kind, &top)
                   : ss_maxima_of_row(&maxima, &n, coefficients, 1, &kind, ss_coefficients_max(coefficients));
    free(maxima);
    return st;
}

static ss_status
feature_streams(int variant)
{
    ss_reader *reader = NULL;
    ss_features_opts opts;
    ss_features_opts_init(&opts, sizeof opts);
    opts.fmin = 20;
    rewind(scrap);
    ss_status st = ss_reader_of_signal(&reader, cycles, &err);
    if (st == SS_OK)
        st = ss_features_follow(reader, 2, &opts, scrap, variant ? SS_JSON : SS_TSV, &err);
    ss_reader_free(reader);
    return st;
}

static ss_status
searches(int variant)
{
    ss_spikes *spikes = NULL;
    ss_bursts bursts = { .n = 0 };
    ss_drop *drops = NULL;
    size_t n;
    const double *a = cycles->values + 2 * cycles->n, *f = cycles->values + 3 * cycles->n;
    row_source source;
    ss_row_source_init(&source, a, cycles->n, cycles->head->rate, NULL, 0);
    ss_status st = variant == 0 ? ss_spikes_find(&spikes, &source)
        : variant == 1 ? ss_bursts_find(&bursts, &source, 20)
        : ss_drops_find(&drops, &n, f, cycles->n, 1, 0.25);
    ss_spikes_free(spikes);
    free(bursts.burst);
    free(drops);
    return st;
}

static ss_status
transitions(int variant)
{
    ss_features *found = NULL;
    ss_features_opts opts;
    ss_features_opts_init(&opts, sizeof opts);
    opts.drop = variant;
    opts.mass = scene[0].mass;
    opts.stiffness = scene[0].stiffness;
    opts.displacement = 0;
    opts.force = 3;
    ss_status st = ss_features_find(&found, cycles, variant == 0 ? 2 : 3, &opts, &err);
    ss_features_free(found);
    return st;
}

static ss_status
pulls(int variant)
{
    ss_pull *made = NULL;
    ss_ranking *ranked = NULL;
    ss_rank_opts opts;
    ss_rank_opts_init(&opts, sizeof opts);
    opts.quantity = SS_SPRING;
    ss_status st = variant == 0 ? ss_pull_fit(&made, pulled, SS_SPRING, &pull, &opts, &err)
        : ss_ranking_new(&ranked, pulled, SS_SPRING, &pull, 1, &opts, &err);
    ss_pull_free(made);
    ss_ranking_free(ranked);
    return st;
}

static ss_status
rankings(int variant)
{
    ss_ranking *made = NULL;
    (void)variant;
    ss_status st = ss_ranking_new(&made, cycles, 2, &scene[COULOMB], 1, NULL, &err);
    ss_ranking_free(made);
    return st;
}

/* A law of a motion and a force that is made of them.  The signal is not on the heap that fails. */
static ss_status
motions(int variant)
{
    enum { ROWS = 400 };
    static const char *const without[] = { "coulomb", "stribeck", "lugre", "compliant-gap", "bouc-wen-gap", NULL };
    static double values[2 * ROWS];
    static ss_column column[2] = { { (char *)"x", (char *)"m" }, { (char *)"f", (char *)"N" } };
    static ss_header head = { .rate = 100, .n_columns = 2, .column = column };
    const ss_signal moved = { &head, ROWS, values };
    ss_motion_ranking *made = NULL;
    ss_motion_opts opts;
    (void)variant;
    for (int i = 0; i < ROWS; i++) {
        values[i] = sin(0.1 * i) + 0.3 * sin(0.13 * i);
        values[ROWS + i] = fmax(-1, fmin(2 * cos(0.1 * i), 1)) + 0.01 * sin(i * i);
    }
    ss_motion_opts_init(&opts, sizeof opts);
    opts.without = without;
    ss_status st = ss_motion_ranking_new(&made, &moved, 0, 1, &opts, &err);
    if (st == SS_OK && made->rows == 0)
        fail_msg("%s", made->answer);
    ss_motion_ranking_free(made);
    return st;
}

/* A decay, one with a mode beside it, and the level of one. */
static ss_status
decays(int variant)
{
    enum { ROWS = 1500 };
    static double values[ROWS];
    static ss_column column = { (char *)"x", (char *)"m" };
    static ss_header head = { .rate = 100, .n_columns = 1, .column = &column };
    const ss_signal decay = { &head, ROWS, values };
    ss_backbone *made = NULL;
    ss_backbone_opts opts;
    ss_backbone_opts_init(&opts, sizeof opts);
    opts.level_frequency = variant == 2 ? 10 : 0;
    opts.mode = variant == 1 ? 7 : 0;
    for (int i = 0; i < ROWS; i++)
        values[i] = variant == 2 ? -0.01 * i + 0.1 * sin(i * i)
            : exp(-0.003 * i) * (cos(0.44 * i) + variant * 2 * cos(0.6 * i)) + 0.001 * sin(i * i);
    ss_status st = ss_backbone_find(&made, &decay, 0, &opts, &err);
    if (st == SS_OK && made->n < 3)
        fail_msg("%s", made->why);
    ss_backbone_free(made);
    return st;
}

/* A step of a load point; as a path in steps, beside which one at the speeds of the slides is tried. */
static ss_status
steps(int variant)
{
    enum { ROWS = 60 };
    static double values[3 * ROWS];
    static ss_column column[] = { { (char *)"x", (char *)"um" }, { (char *)"mu", (char *)"" },
                                  { (char *)"t", (char *)"s" } };
    static ss_header head = { .rate = 1, .n_columns = 3, .column = column };
    const ss_signal slid_rock = { &head, ROWS, values };
    ss_steps *made = NULL;
    for (int i = 0; i < ROWS; i++) {
        const double x = i < 30 ? i : 30 + 10 * (i - 30), slid = x > 30 ? x - 30 : 0;
        values[i] = variant == 0 ? x : 5 * floor(x / 5);
        values[ROWS + i] = 0.6 + 0.006 * (exp(-slid / 20) - exp(-slid / 8)) - 0.002 * (1 - exp(-slid / 20))
            + 1e-5 * sin(i * i);
        values[2 * ROWS + i] = i;
    }
    ss_status st = ss_steps_find(&made, &slid_rock, 0, 1,
                                 &(ss_steps_opts){ sizeof(ss_steps_opts), .normal = -1, .shared = variant }, &err);
    if (st == SS_OK && made->n != 1)
        fail_msg("%zu steps", made->n);
    ss_steps_free(made);
    return st;
}

static ss_status
fits(int variant)
{
    ss_fit fit;
    (void)variant;
    return ss_scene_fit(&fit, cycles, 2, &scene[COMPLIANT], NULL, &err);
}

static int
drop_row(const ss_sweep_row *r, void *user)
{
    (void)r, (void)user;
    return 0;
}

static ss_status
sweeps(int variant)
{
    static const ss_axis axis[] = { { "friction", 1, 2, 2, 0 }, { "mass", 2, 3, 2, 0 } };
    ss_steady_opts how;
    ss_steady_opts_init(&how, sizeof how);
    ss_sweep_opts opts = { .size = sizeof opts, .steady = &how, .axis = axis, .n_axes = 2, .shards = 1,
                           .threads = 1 + variant % 2, .sink = drop_row };
    how.measures = 1u << SS_AMPLITUDE | 1u << SS_PERIOD;
    how.max_cycles = 20;
    how.search = variant / 2 == 1 ? SS_SEARCH_SHOOT : SS_SEARCH_AUTO;
    if (variant / 2 == 2)
        how.method = "rk8pd";
    return ss_sweep_run(&scene[COMPLIANT], &opts, &err);
}

static ss_status
read_tables(int variant)
{
    static char rows[] = "# stickslip events 1\n# scene: s\n# columns: t/s kind\n0.5\tslip\n";
    char *from = variant == 0 ? sweep_text : rows;
    ss_table *table = NULL;
    FILE *in = fmemopen(from, strlen(from), "r");
    ss_status st = ss_table_read(&table, in, "in", variant == 0 ? SS_KIND_SWEEP : SS_KIND_EVENTS, &err);
    fclose(in);
    ss_table_free(table);
    return st;
}

static ss_status
read_overlays(int variant)
{
    static char features[] = "# stickslip features 1\n# spike: 1 jump 0 0\n0\t1\t2\t0.5\t40\n",
        events[] = "# stickslip events 1\n0.5\tslip\n";
    ss_overlay *overlay = NULL;
    FILE *in = variant == 0 ? fmemopen(features, sizeof features - 1, "r")
                            : fmemopen(events, sizeof events - 1, "r");
    ss_status st = ss_overlay_read(&overlay, in, "in", variant == 0 ? SS_KIND_FEATURES : SS_KIND_EVENTS, &err);
    fclose(in);
    ss_overlay_free(overlay);
    return st;
}

/* The spectrum of a signal that is read; one column over another; and all over time, with another signal and what
 * the first differs by from it. */
static ss_status
reductions(int variant)
{
    const size_t column[] = { 0, 1 };
    ss_plot_opts opts;
    ss_reader *reader = NULL, *over = NULL;
    ss_plot_opts_init(&opts, sizeof opts);
    opts.decibels = 1;
    FILE *in = fmemopen(text[1], length[1], "r");
    ss_status st = ss_reader_new(&reader, in, "in", &(ss_read_opts){ READ_OPTS, .rewinds = 1 }, &err);
    if (st == SS_OK && variant == 2)
        st = ss_reader_of_signal(&over, signal, &err);
    opts.over = &over;
    opts.n_over = opts.difference = variant == 2;
    if (st == SS_OK)
        st = variant == 0 ? ss_plot_spectrum(scrap, reader, column, 1, &opts, &err)
            : variant == 3 ? ss_spectrum_write(reader, column, 1, &opts, scrap, SS_TSV, &err)
            : variant == 1 ? ss_plot_xy(scrap, reader, 0, 1, &opts, &err)
            : ss_plot_signal(scrap, reader, NULL, 0, &opts, &err);
    ss_reader_free(over);
    ss_reader_free(reader);
    fclose(in);
    return st;
}

static ss_status
plots(int variant)
{
    ss_contour_opts contour;
    ss_reader *reader = NULL;
    ss_status st;
    ss_contour_opts_init(&contour, sizeof contour);
    contour.signal = signal;
    rewind(scrap);
    switch (variant) {
    case 0:
    case 1:
        st = ss_reader_of_signal(&reader, signal, &err);
        if (st == SS_OK)
            st = variant == 0 ? ss_plot_signal(scrap, reader, NULL, 0, NULL, &err)
                : ss_plot_xy(scrap, reader, 0, 1, NULL, &err);
        ss_reader_free(reader);
        return st;
    case 2: return ss_plot_contour(scrap, coefficients, &contour, NULL, &err);
    case 3: return ss_plot_sweep(scrap, sweep, (const size_t[]){ 1, 2, 3, 4 }, 4, NULL, &err);
    case 5: contour.fill = contour.ridge = 1;
            return ss_plot_contour(scrap, coefficients, &contour, NULL, &err);
    }
    return ss_plot_trade(scrap, trade, NULL, &err);
}

static ss_status
overviews(int variant)
{
    ss_overview *overview = NULL;
    ss_reader *reader = NULL;
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.voices = 2;
    opts.fmin = signal->head->rate / 10;
    opts.detrend = variant == 0 ? SS_DETREND_NONE : SS_DETREND_MEAN;
    ss_status st = ss_reader_of_signal(&reader, signal, &err);
    if (st == SS_OK)
        st = ss_overview_read(&overview, reader, 0, &opts, &err);
    ss_overview_free(overview);
    ss_reader_free(reader);
    return st;
}

static ss_status
stores(int variant)
{
    static const ss_event event = { 0.1, 0, 0, SS_SLIP, 1 };
    char other[80];
    ss_record whole = { signal, &event, 1, 1, variant == 0 ? coefficients : NULL };
    snprintf(other, sizeof other, "%s.new", path);
    ss_status st = ss_record_write(&whole, NULL, other, SS_H5, &err);
    if (st != SS_OK)
        assert_int_not_equal(access(other, F_OK), 0);
    unlink(other);
    return st;
}

/* Piece by piece, of a known length or not. */
static ss_status
store_pieces(int variant)
{
    char other[80];
    ss_writer *writer = NULL;
    ss_coefficients grid = *coefficients;
    size_t n = signal->n;
    snprintf(other, sizeof other, "%s.new", path);
    grid.n = variant == 0 ? n : 0;
    ss_status st = ss_writer_new(&writer, NULL, other, SS_H5, &(ss_contents){ signal->head, &grid, 0, grid.n },
                                 &err);
    if (st == SS_OK)
        st = store_samples(writer, signal, 0, n, &err);
    for (size_t i = 0; st == SS_OK && i < grid.n_scales; i++)
        st = ss_writer_coefficients(writer, &grid.scale[i], 0, grid.scale[i].n,
                                  grid.w + 2 * grid.scale[i].offset, n, &err);
    if (st == SS_OK)
        st = ss_writer_note(writer, "late", "note", &err);
    if (st == SS_OK)
        st = ss_writer_end(writer, n, &err);
    ss_writer_free(writer);
    if (st != SS_OK)
        assert_int_not_equal(access(other, F_OK), 0);
    unlink(other);
    return st;
}

static ss_status
loads(int variant)
{
    static const ss_read_opts timed = { READ_OPTS, .time = "t" };
    ss_signal *back = NULL;
    ss_coefficients *c = NULL;
    char member[80];
    snprintf(member, sizeof member, "%s:/signal/a", path);
    ss_status st = variant == 0 ? ss_signal_read(&back, NULL, path, NULL, &err)
                   : variant == 1 ? ss_signal_read(&back, NULL, member, NULL, &err)
                   : variant == 2 ? ss_signal_read(&back, NULL, member, &timed, &err)
                   : ss_coefficients_read(&c, NULL, path, &err);
    if (st == SS_OK && variant > 2) {
        static double w[2 * 100000];
        assert_true(c->scale[0].n > 1 && c->scale[0].n <= 100000);
        for (size_t n = 1; st == SS_OK && n <= c->scale[0].n; n += c->scale[0].n - 1)
            st = ss_map_read(c, &(ss_map_part){ 0, 0, n, w, NULL }, 1, &err);
    }
    ss_signal_free(back);
    ss_coefficients_free(c);
    return st;
}

static const struct row {
    const char *what;
    call *call;
    int variants;
    size_t most;                /* allocations that fail in turn, spread over all; 20 times that
                                   with LONG=1, which is all of them for most rows */
} row[] = {
    { "headers", headers, 1, 100 }, { "reading streams", read_streams, 16, 100 },
    { "reading twice", read_twice, 3, 100 },
    { "writing streams", write_streams, 3, 100 }, { "signals", signals, 9, 100 },
    { "noises", noises, 3, 100 }, { "bases", bases, 1, 100 },
    { "simulations", simulations, 3, 100 },
    { "closed forms", closed_forms, 2, 100 }, { "trades", trades, 2, 20 },
    { "simpler models", model_trades, 1, 20 },
    { "transforms", transforms, 6, 30 }, { "streams", streams, 4, 30 },
    { "inverses", inverses, 1, 30 }, { "comparisons", comparisons, 2, 30 },
    { "reading coefficients", read_coefficients, 1, 30 },
    { "features", features, 2, 30 },
    { "streams of features", feature_streams, 2, 10 },
    { "searches", searches, 3, 20 }, { "transitions", transitions, 2, 10 },
    { "rankings", rankings, 1, 4 }, { "motions", motions, 1, 10 }, { "decays", decays, 3, 20 }, { "steps", steps, 2, 20 },
    { "fits", fits, 1, 4 }, { "pulls", pulls, 2, 10 }, { "sweeps", sweeps, 6, 20 },
    { "reading tables", read_tables, 2, 100 }, { "reading overlays", read_overlays, 2, 100 }, { "plots", plots, 6, 30 },
    { "reductions", reductions, 4, 100 },
    { "overviews", overviews, 2, 30 },
    { "each scale", each_scale, 2, 30 }, { "stores", stores, 2, 30 },
    { "storing pieces", store_pieces, 2, 30 }, { "loads", loads, 5, 60 },
};

/* --- the tests ----------------------------------------------------------------------------- */

static int
set_up(void **state)
{
    static const struct { const char *key; double value; } own[] = {
        { "alpha", 3000 }, { "gamma", 100 }, { "contact_stiffness", 209900 }, { "contact_damping", 25 } };
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    gsl_set_error_handler_off();
    for (int m = 0; m < 3; m++) {
        scene[m] = (ss_scene){ .model = ss_model_at((size_t)m), .mass = 2.42, .stiffness = 2310,
            .friction = 1.28, .base_amplitude = 6e-4, .base_frequency = 2.5, .duration = 0.1, .rate = 1000 };
        for (size_t i = 0; i < sizeof own / sizeof *own; i++)
            ss_scene_set(&scene[m], own[i].key, own[i].value, NULL);    /* if the model has the key */
    }
    ss_scene slips = scene[COMPLIANT];
    ss_trade_opts brief = { .size = sizeof brief, .budget = 1e-3 };
    pull = scene[COULOMB];
    pull.base_amplitude = 0;
    pull.base_velocity = 1e-3;
    pull.static_friction = 1.5;
    pull.settle = 1;
    pull.duration = 2;
    slips.settle = 2;
    slips.duration = 2;
    strcpy(path, "/tmp/test_memory.XXXXXX");
    int fd = mkstemp(path);
    opts.voices = 2;
    opts.force = 1;
    if (fd < 0 || close(fd) != 0 || (scrap = tmpfile()) == NULL
        || ss_sim_signal(&signal, &scene[COMPLIANT], NULL) != SS_OK
        || ss_sim_signal(&cycles, &slips, NULL) != SS_OK
        || ss_sim_signal(&pulled, &pull, NULL) != SS_OK
        || ss_noise_add_once(cycles->values + 2 * cycles->n, cycles->n, 1e-3, 1, NULL) != SS_OK
        || ss_header_note(signal->head, "key", "value", NULL) != SS_OK
        || ss_morlet_transform(&coefficients, signal, 2, &opts, NULL) != SS_OK
        || ss_trade_measure(&trade, &scene[COULOMB], &brief, NULL) != SS_OK)
        return -1;
    for (int i = 0; i < 2; i++) {
        FILE *out = fmemopen(text[i], sizeof text[i], "w");
        if (ss_record_write(&(ss_record){ .signal = signal }, out, NULL, i == 0 ? SS_TSV : SS_AU, NULL) != SS_OK)
            return -1;
        length[i] = (size_t)ftell(out);
        fclose(out);
    }
    FILE *out = fmemopen(coefficient_text, sizeof coefficient_text, "w");
    if (ss_record_write(&(ss_record){ .coefficients = coefficients }, out, NULL, SS_TSV, NULL) != SS_OK)
        return -1;
    coefficient_length = (size_t)ftell(out);
    fclose(out);
    FILE *in = fmemopen(sweep_text, sizeof sweep_text - 1, "r");
    ss_status st = ss_table_read(&sweep, in, "in", SS_KIND_SWEEP, NULL);
    fclose(in);
    if (st != SS_OK)
        return -1;
    ss_record whole = { .signal = signal, .coefficients = coefficients };
    return ss_record_write(&whole, NULL, path, SS_H5, NULL) == SS_OK ? 0 : -1;
}

static int
tear_down(void **state)
{
    (void)state;
    unlink(path);
    fclose(scrap);
    ss_signal_free(signal);
    ss_signal_free(cycles);
    ss_signal_free(pulled);
    ss_table_free(sweep);
    ss_coefficients_free(coefficients);
    ss_trade_free(trade);
    return 0;
}

/* Run a call with the allocation fail_at failing; gives how many there were. */
static size_t
run(const struct row *r, int variant, size_t fail_at, int and_all_after)
{
    heap.calls = heap.live = 0;
    heap.fail_at = fail_at;
    heap.and_all_after = and_all_after;
    heap.counting = 1;
    ss_status status = r->call(variant);
    heap.counting = 0;
    int failed = fail_at != 0 && heap.calls >= fail_at;
    if (status != (failed ? SS_ENOMEM : SS_OK))
        fail_msg("%s %d, allocation %zu%s fails: %s: %s", r->what, variant, fail_at,
                 and_all_after ? " and all after it" : "", ss_strerror(status), err.text);
    if (heap.live != 0)
        fail_msg("%s %d, allocation %zu%s fails: %zu blocks are lost", r->what, variant, fail_at,
                 and_all_after ? " and all after it" : "", heap.live);
    return heap.calls;
}

enum { FIRST = 6 };

static void
every_allocation_may_fail(void **state)
{
    const char *every = getenv("LONG");
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        for (int variant = 0; variant < row[i].variants; variant++) {
            size_t calls = run(&row[i], variant, 0, 0);
            size_t most = (every && *every != 0 ? 20 : 1) * row[i].most;
            size_t step = 1 + calls / most;     /* or it takes minutes; the first ones, of what makes an object, each */
            for (size_t n = 1; n <= calls; n += n < FIRST ? 1 : step) {
                run(&row[i], variant, n, 0);
                run(&row[i], variant, n, 1);
            }
            run(&row[i], variant, 0, 0);        /* and nothing has been left in a bad state */
        }
}

/* What HDF5 cannot write as it closes a file, although no write has failed, is an error, and the file goes. */
static void
a_file_that_is_not_closed_is_not_written(void **state)
{
    char other[sizeof path + 2];
    (void)state;
    snprintf(other, sizeof other, "%s.2", path);
    for (int fails = 0; fails < 2; fails++) {
        closing_fails = fails;
        ss_status st = ss_record_write(&(ss_record){ .signal = signal }, NULL, other, SS_H5, NULL);
        closing_fails = 0;
        assert_int_equal(st, fails ? SS_EIO : SS_OK);
        assert_int_equal(unlink(other), fails ? -1 : 0);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(every_allocation_may_fail),
                                        cmocka_unit_test(a_file_that_is_not_closed_is_not_written) };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
