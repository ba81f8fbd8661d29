/* noise.c -- the errors of a measurement: white noise, noise of a band, a converter's steps.
 *
 * Numbers are drawn with GSL's mt19937 and its Ziggurat.  Noise of a band is made as a spectrum:
 * it has Gaussian numbers at the frequencies of the band and zeros elsewhere, and is scaled to the
 * given rms.  The number of samples of its inverse transform is a power of two; the record takes
 * the first of them. */
#include "signal/noise.h"

#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/fft.h"
#include "base/list.h"
#include "base/number.h"
#include "base/options.h"
#include "signal/source.h"

static const ss_noise_opts defaults = { .size = sizeof defaults, .snr = NAN, .rms = NAN, .band = { NAN, NAN },
                                        .seed = 1 };

SS_OPTIONS(ss_noise_opts, defaults)

static ss_status
refuse_sum(ss_error *err)
{
    return ss_fail(err, SS_ERANGE, "signal and noise exceed what a double holds");
}

/* --- in memory ----------------------------------------------------------------------------- */

ss_status
ss_noise_new(gsl_rng **out, unsigned long seed, ss_error *err)
{
    gsl_rng *rng = *out = gsl_rng_alloc(gsl_rng_mt19937);
    if (rng == NULL)
        return ss_fail_memory(err, NULL);
    gsl_rng_set(rng, seed);
    return SS_OK;
}

ss_status
ss_noise_add(gsl_rng *noise, double *const column[], size_t n_columns, size_t n, const double *rms, ss_error *err)
{
    double zero = 0;                    /* NaN once a sum is not finite */
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < n_columns; c++)
            if (rms[c] > 0) {
                column[c][i] += gsl_ran_gaussian_ziggurat(noise, rms[c]);
                zero += 0 * column[c][i];
            }
    return zero == 0 ? SS_OK : refuse_sum(err);
}

ss_status
ss_noise_add_band(gsl_rng *noise, double *x, size_t n, double rate, ss_range band, double rms, ss_error *err)
{
    size_t m = 2;
    double square = 0, lo = band.from, hi = band.to;
    while (m < n)
        m *= 2;
    real_fft f;
    if (ss_real_fft_new(&f, m, 1) != SS_OK)
        return ss_fail_memory(err, NULL);
    memset(f.x, 0, (m + 2) * sizeof *f.x);
    double *y = f.x;
    size_t first = (size_t)ceil(lo / rate * (double)m), last = (size_t)floor(hi / rate * (double)m);
    last = last < m / 2 ? last : m / 2;
    for (size_t k = first; k <= last; k++) {    /* Gaussian numbers at the frequencies of the band */
        y[2 * k] = gsl_ran_gaussian_ziggurat(noise, 1);
        if (k > 0 && k < m / 2)
            y[2 * k + 1] = gsl_ran_gaussian_ziggurat(noise, 1);
    }
    if (first > last) {
        ss_real_fft_free(&f);
        return ss_fail(err, SS_EINVAL, "band %g to %g Hz: a record of %zu sample%s at %g Hz has "
                       "no frequency in it", lo, hi, n, PLURAL(n), rate);
    }
    ss_real_fft_run(&f);
    for (size_t i = 0; i < n; i++)
        square += y[i] * y[i];
    double gain = square > 0 ? rms / sqrt(square / (double)n) : 0, zero = 0;
    for (size_t i = 0; i < n; i++) {
        x[i] += gain * y[i];
        zero += 0 * x[i];
    }
    ss_real_fft_free(&f);
    return zero == 0 ? SS_OK : refuse_sum(err);
}

ss_status
ss_noise_add_once(double *x, size_t n, double rms, unsigned long seed, ss_error *err)
{
    gsl_rng *noise = NULL;
    ss_status st = ss_noise_new(&noise, seed, err);
    if (st == SS_OK)
        st = ss_noise_add(noise, &x, 1, n, &rms, err);
    gsl_rng_free(noise);
    return st;
}

void
ss_variance_add(ss_variance *v, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        long double off = x[i] - v->mean;
        v->mean += off / ++v->n;
        v->square += off * (x[i] - v->mean);
    }
}

double
ss_variance_noise(const ss_variance *v, double snr_db)
{
    return v->n > 0 ? (double)sqrtl(v->square / v->n) * pow(10, -snr_db / 20) : 0;
}

ss_status
ss_quantise(double *x, size_t n, int bits, double range, size_t *clipped, ss_error *err)
{
    if (bits < 1 || bits > SS_BITS_MAX)
        return ss_fail(err, SS_EINVAL, "%d bits are out of range 1 ... %d", bits, SS_BITS_MAX);
    double codes = ldexp(1, bits - 1), step = range / codes;
    if (!(step > 0 && isfinite(range)))
        return ss_fail(err, SS_EINVAL, "range %g has no steps of %d bits", range, bits);
    for (size_t i = 0; i < n; i++) {
        double code = rint(x[i] / step), kept = code < -codes ? -codes : code >= codes ? codes - 1 : code;
        *clipped += kept < code || kept > code;         /* NaN stays, as no converter had it */
        x[i] = step * kept + 0.0;     /* no -0 */
    }
    return SS_OK;
}

/* --- a whole record, for noise of a band: its frequencies are those of the record ------------- */

struct whole {
    ss_source base;
    ss_signal *signal;
};

static void
hold_whole(ss_source *s)
{
    s->held = ((struct whole *)s)->signal->n;
}

static void
free_whole(ss_source *s)
{
    ss_signal_free(((struct whole *)s)->signal);
}

static ss_status
read_whole(ss_source **s, ss_signal **signal, ss_error *err)
{
    static const struct source_calls calls = { .rewind = hold_whole, .free = free_whole };
    struct whole *w = ss_source_wrap(s, sizeof *w, &calls, err);
    ss_status st = w != NULL ? ss_source_all(&w->signal, w->base.inner, err) : SS_ENOMEM;
    if (w != NULL && st != SS_OK)
        ss_source_unwrap(s);
    if (st != SS_OK)
        return st;
    *signal = w->signal;
    w->base.made = w->signal->values;
    w->base.rewinds = 1;
    w->base.length = w->base.apart = w->base.held = w->signal->n;
    return SS_OK;
}

/* --- rows ------------------------------------------------------------------------------------ */

struct noisy {
    ss_source base;
    ss_noise_opts opts;
    ss_noise_done *done;
    gsl_rng *noise;
    double *rms;                /* of the noise that each column gets row by row */
    double *chosen;             /* 1 for each column that is changed */
    double **x;                 /* the rows to be given */
};

static ss_status
give_noisy(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct noisy *y = (struct noisy *)s;
    (void)column, (void)max, (void)n;
    s->given = s->held = 0;
    ss_status st = ss_source_rows(s->inner, y->x, s->apart, &s->held, err);
    if (st == SS_OK)
        st = ss_noise_add(y->noise, y->x, s->head->n_columns, s->held, y->rms, err);
    for (size_t c = 0; st == SS_OK && y->opts.bits > 0 && c < s->head->n_columns; c++)
        if (y->chosen[c] > 0) {
            st = ss_quantise(y->x[c], s->held, y->opts.bits, y->opts.range, &y->done->clipped, err);
            y->done->converted += s->held;
        }
    return st;
}

static void
rewind_noisy(ss_source *s)
{
    struct noisy *y = (struct noisy *)s;
    gsl_rng_set(y->noise, y->opts.seed);
    y->done->converted = y->done->clipped = 0;
}

static void
free_noisy(ss_source *s)
{
    struct noisy *y = (struct noisy *)s;
    gsl_rng_free(y->noise);
    free(y->rms);
    free(y->chosen);
    free(y->x);
}

/* Measure the columns, for a ratio, which takes one reading more. */
static ss_status
find_levels(struct noisy *y, ss_error *err)
{
    const size_t columns = y->base.head->n_columns;
    ss_source *s = y->base.inner;
    ss_variance *variance = calloc(columns + 1, sizeof *variance);
    if (variance == NULL)
        return ss_fail_memory(err, s->name);
    ss_status st = s->rewinds ? SS_OK : ss_source_rewind(s, err);
    for (size_t n = 1; st == SS_OK && n > 0;) {
        st = ss_source_rows(s, y->x, y->base.apart, &n, err);
        for (size_t c = 0; c < columns; c++)
            ss_variance_add(&variance[c], y->x[c], n);
    }
    for (size_t c = 0; c < columns; c++)
        y->rms[c] = ss_variance_noise(&variance[c], y->opts.snr);
    free(variance);
    return st == SS_OK ? ss_source_rewind(s, err) : st;
}

static ss_status
note_noise(ss_header *head, const ss_noise_opts *o)
{
    char text[256], band[128] = "", number[SS_NUMBER_MAX], to[SS_NUMBER_MAX];
    const int is_ratio = !isnan(o->snr);
    ss_status st = SS_OK;
    if (!isnan(o->band.from)) {
        ss_number_format(number, o->band.from);
        ss_number_format(to, o->band.to);
        snprintf(band, sizeof band, ", %s to %s Hz", number, to);
    }
    if (is_ratio || !isnan(o->rms)) {
        ss_number_format(number, is_ratio ? o->snr : o->rms);
        snprintf(text, sizeof text, "%s %s%s%s, seed %lu", is_ratio ? "snr" : "rms", number, is_ratio ? " dB" : "",
                 band, o->seed);
        st = ss_header_note(head, "noise", text, NULL);
    }
    if (o->bits == 0 || st != SS_OK)
        return st;
    ss_number_format(number, o->range);
    snprintf(text, sizeof text, "%d bits, range %s", o->bits, number);
    st = ss_header_note(head, "converter", text, NULL);
    return st == SS_OK ? ss_header_note(head, "clipped", NULL, NULL) : st;  /* that was of another converter */
}

/* Find the noise of each column; that of a band is added to the whole record now. */
static ss_status
begin_noise(struct noisy *y, ss_signal *whole, size_t piece, ss_error *err)
{
    const ss_noise_opts *o = &y->opts;
    const size_t columns = y->base.head->n_columns;
    const int is_ratio = !isnan(o->snr), is_noisy = is_ratio || !isnan(o->rms);
    y->rms = calloc(columns + 1, sizeof *y->rms);
    y->chosen = calloc(columns + 1, sizeof *y->chosen);
    y->x = ss_columns_new(columns, piece);
    ss_status st = y->rms != NULL && y->chosen != NULL && y->x != NULL ? ss_noise_new(&y->noise, o->seed, err)
        : SS_ENOMEM;
    if (st == SS_OK)
        st = note_noise(y->base.head, o);
    if (st != SS_OK)
        return ss_fail_memory(err, y->base.name);
    y->base.made = *y->x;
    y->base.apart = piece;
    if (is_ratio)
        st = find_levels(y, err);
    for (size_t c = 0; c < columns; c++)
        y->chosen[c] = o->n_columns == 0;
    for (size_t i = 0; i < o->n_columns; i++)
        y->chosen[o->column[i]] = 1;
    for (size_t c = 0; st == SS_OK && c < columns; c++) {
        double rms = !is_noisy || y->chosen[c] == 0 ? 0 : is_ratio ? y->rms[c] : o->rms;
        y->rms[c] = whole != NULL ? 0 : rms;
        if (whole != NULL && rms > 0)
            st = ss_noise_add_band(y->noise, whole->values + c * whole->n, whole->n, whole->head->rate, o->band,
                                   rms, err);
        if (y->done->rms != NULL)
            y->done->rms[c] = is_noisy && y->chosen[c] > 0 ? rms : NAN;
    }
    return st;
}

ss_status
ss_source_noise(ss_source **s, const ss_noise_opts *opts, ss_noise_done *done, ss_error *err)
{
    static const struct source_calls calls = { .next = give_noisy, .rewind = rewind_noisy, .free = free_noisy };
    ss_noise_opts o;
    ss_signal *whole = NULL;
    const size_t columns = (*s)->head->n_columns, piece = ss_source_piece(*s);
    const double most = (*s)->head->rate / 2;
    ss_status st = ss_options_take(&o, sizeof o, &defaults, opts, err);
    if (st != SS_OK)
        return st;
    const int is_band = (!isnan(o.snr) || !isnan(o.rms)) && !isnan(o.band.from);
    if ((!isnan(o.snr) && !isnan(o.rms)) || isinf(o.snr) || o.rms < 0 || isinf(o.rms)
        || (o.column == NULL && o.n_columns > 0))
        return ss_fail(err, SS_EINVAL, "noise has either a ratio in dB or an rms of 0 or more");
    if (is_band && !(o.band.from >= 0 && o.band.from <= o.band.to && o.band.to <= most))
        return ss_fail(err, SS_EINVAL, "band %g to %g Hz: not between 0 and half the rate, %g Hz", o.band.from,
                       o.band.to, most);
    if (o.bits != 0)
        st = ss_quantise(NULL, 0, o.bits, o.range, NULL, err);
    for (size_t i = 0; st == SS_OK && i < o.n_columns; i++)
        if (o.column[i] >= columns)
            st = ss_fail_column(err, o.column[i], columns);
    if (st == SS_OK && is_band)
        st = read_whole(s, &whole, err);
    if (st != SS_OK)
        return st;
    struct noisy *y = ss_source_wrap(s, sizeof *y, &calls, err);
    if (y == NULL)
        return SS_ENOMEM;
    y->opts = o;
    y->done = done;
    *done = (ss_noise_done){ .rms = done->rms };
    st = begin_noise(y, whole, piece, err);
    if (st != SS_OK)
        ss_source_unwrap(s);
    return st;
}
