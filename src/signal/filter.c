/* filter.c -- filter, differentiate and integrate by one FIR filter of linear phase.
 *
 * A low-pass is the sinc of its edge under a window of Kaiser's, a high-pass is one less a low-pass.  A derivative
 * of order N is N differences of neighbours, which are (2 i sin(pi f))^N for a frequency of f cycles a sample, and
 * a correction ((pi f) / sin(pi f))^N, which is smooth; an integral is N sums and the inverse of the correction.
 * So the error of each frequency that passes is that of the window, in proportion to its own answer however low
 * the frequency.  (Kaiser 1974 has the window; Oppenheim & Schafer, Discrete-time signal processing, 7.5, its
 * length.)
 *
 * The rows go through the filter in blocks: its taps are cut into parts as long as a block, the spectra of the
 * last blocks are kept, and that of the next output is the sum of their products with those of the parts.
 * (Overlap-save, partitioned; Stockham 1966.)  A block is an eighth of the filter, so rows leave shortly after
 * they can be known, and their bits do not depend on how a pipe delivers them. */
#include "signal/source.h"

#include <gsl/gsl_sf_bessel.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/fft.h"
#include "base/list.h"
#include "base/number.h"
#include "base/options.h"
#include "signal/gaps.h"
#include "signal/header.h"

#define WIDTH 0.2               /* a transition goes from 1 - WIDTH to 1 + WIDTH times its edge */
#define UP_TO 0.475             /* the edge of derivatives and integrals without a low-pass, in rates */
#define MARGIN 2                /* [dB] as far as Kaiser's formulas for the length and the window may be off */
#define LEAST_STOP 79.          /* [dB] its ripple, 10^(-79/20), is 1e-3 dB in the pass band */
enum { MOST_TAPS = 1 << 24, BLOCK_LEAST = 16, REACH = 16 };     /* REACH: taps of the correction beyond the window */

static const ss_filter_opts defaults = { .size = sizeof defaults, .stop = 80 };

SS_OPTIONS(ss_filter_opts, defaults)

/* --- the taps ------------------------------------------------------------------------------ */

struct design {
    double low, high, low_width, high_width;    /* edges and half widths, in rates; 0: there is none */
    int order, sums;            /* sums: of the outputs, as many; the taps have those of a high-pass in them */
    double rate;
    double stop;                /* [dB] of the window */
    size_t half;                /* its taps on each side */
    double *tap;
    size_t n;
};

/* Add the low-pass of this edge to the taps -half ... half, times a factor. */
static void
add_low_pass(double *middle, size_t half, double edge, double beta, double factor)
{
    double sum = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i <= half; i++) {
            double x = 2 * M_PI * edge * (double)i, at = (double)i / (double)(half + 1), arg = beta * sqrt(1 - at * at);
            double w = gsl_sf_bessel_I0_scaled(arg) * exp(arg - beta), h = w * (i > 0 ? sin(x) / x : 1);
            if (pass == 0) {
                sum += i > 0 ? 2 * h : h;
                continue;
            }
            middle[i] += factor * h / sum;
            if (i > 0)
                *(middle - i) += factor * h / sum;
        }
}

/* The band's taps times the correction: those at -reach ... reach, or for an odd order at half samples up to
 * reach + 1/2.  d->tap is room for all; zeros stand where there is no window. */
static ss_status
correct(struct design *d, size_t reach)
{
    size_t n = 64, odd = (size_t)abs(d->order) % 2, first = d->n / 2;
    real_fft f;
    while (n < 4 * reach)
        n *= 2;
    ss_status st = ss_real_fft_new(&f, n, 0);
    if (st != SS_OK)
        return st;
    memset(f.x, 0, (n + 2) * sizeof *f.x);
    for (size_t i = 0; i <= reach; i++) {
        f.x[i] = d->tap[first + i];
        f.x[(n - i) % n] = d->tap[first - i];
    }
    ss_real_fft_run(&f);
    for (size_t k = 0; k <= n / 2; k++) {
        double x = M_PI * (double)k / (double)n, gain = (k > 0 ? pow(x / sin(x), d->order) : 1) / (double)n;
        f.x[2 * k + 1] = f.x[2 * k] * gain * (odd ? sin(x) : 0);
        f.x[2 * k] *= gain * (odd ? cos(x) : 1);
    }
    st = ss_real_fft_turn(&f, n);
    if (st != SS_OK)
        return st;
    ss_real_fft_run(&f);
    d->n = 2 * reach + 1 + odd;
    double sum = 0;
    for (size_t i = 0; i < d->n; i++)
        sum += d->tap[i] = f.x[(i + n - reach - odd) % n];
    for (size_t i = 0; i < d->n && !(d->high > 0); i++)
        d->tap[i] /= sum;                       /* so that slopes stay what they are */
    ss_real_fft_free(&f);
    return SS_OK;
}

/* Make the taps; d->tap is to be freed. */
static ss_status
make_taps(struct design *d)
{
    size_t order = (size_t)abs(d->order), reach = d->half + (order > 0 ? REACH : 0);
    double beta = 0.1102 * (d->stop - 8.7);
    d->n = 2 * reach + 1;
    d->tap = calloc(d->n + order + 1, sizeof *d->tap);
    if (d->tap == NULL)
        return SS_ENOMEM;
    double *middle = d->tap + reach;
    if (d->low > 0)
        add_low_pass(middle, d->half, d->low, beta, 1);
    else
        *middle = 1;
    if (d->high > 0)
        add_low_pass(middle, d->half, d->high, beta, -1);
    ss_status st = order > 0 ? correct(d, reach) : SS_OK;
    for (size_t k = 0; st == SS_OK && k < order; k++) {
        if (d->order > 0) {
            for (size_t i = ++d->n; i-- > 0;)
                d->tap[i] = d->rate * (d->tap[i] - (i > 0 ? d->tap[i - 1] : 0));
            continue;
        }
        for (size_t i = 0; i < d->n; i++)
            d->tap[i] = d->tap[i] / d->rate + (d->sums == 0 && i > 0 ? d->tap[i - 1] : 0);
        d->n -= d->sums == 0;                   /* the sum of all is 0, as a high-pass has no mean */
    }
    return st;
}

/* Choose the band and the length of the filter. */
static ss_status
choose(struct design *d, const ss_source *s, const ss_filter_opts *o, ss_error *err)
{
    double rate = s->head->rate;
    *d = (struct design){ .low = o->low_pass / rate, .high = o->high_pass / rate, .order = o->order, .rate = rate,
                          .sums = o->order < 0 && !(o->high_pass > 0) ? -o->order : 0 };
    if (!(d->low < 0.5 && d->high < 0.5))
        return ss_fail(err, SS_EINVAL, "%s: has %.9g Hz: a filter's edge must be below half of that", s->name, rate);
    d->low = d->low > 0 || d->order == 0 ? d->low : UP_TO;
    d->low_width = fmin(WIDTH * d->low, 0.5 - d->low);
    d->high_width = fmin(WIDTH * d->high, 0.5 - d->high);
    if (d->low > 0 && !(d->high + d->high_width < d->low - d->low_width))
        return ss_fail(err, SS_EINVAL, "%s: no frequency passes the filter: the bands from %g to %g Hz, and from %g to "
                       "%g Hz, are transitions", s->name, (d->high - d->high_width) * rate,
                       (d->high + d->high_width) * rate, (d->low - d->low_width) * rate,
                       (d->low + d->low_width) * rate);
    int both = d->low > 0 && d->high > 0;
    double width = both ? fmin(d->low_width, d->high_width) : d->low > 0 ? d->low_width : d->high_width, half = 0;
    for (int pass = 0; pass < 3 && width > 0; pass++) {
        /* The ripples of two edges add up; an integral has those of low frequencies (edge / f)^N times, of which
         * the lowest is at f = 1/(2 half). */
        double more = 20 * log10(both ? 2 : 1);
        if (pass > 0 && d->order < 0 && d->high > 0)
            more -= d->order * 20 * log10(2 * half * d->high);
        d->stop = fmax(o->stop, LEAST_STOP) + MARGIN + more;
        half = ceil((d->stop - 7.95) / (2.285 * 8 * M_PI * width));
    }
    if (!(2 * half < MOST_TAPS))
        return ss_fail(err, SS_EINVAL, "%s: this filter has %.3g taps, and at most %d are made: bring the signal to a "
                       "lower rate before", s->name, 2 * half, MOST_TAPS);
    d->half = (size_t)half;
    return SS_OK;
}

/* --- the header ---------------------------------------------------------------------------- */

static const char note_key[] = "filter";

int
ss_header_flat(const ss_header *head, ss_range *flat)
{
    const char *text = ss_header_find_note(head, note_key);
    char *end;
    double lo = text != NULL && strncmp(text, "flat ", 5) == 0 ? ss_number_parse(text + 5, &end) : NAN;
    double hi = isfinite(lo) && strncmp(end, " to ", 4) == 0 ? ss_number_parse(end + 4, &end) : NAN;
    if (!(lo >= 0 && hi > lo))
        return 0;
    *flat = (ss_range){ fmax(flat->from, lo), fmin(flat->to, hi) };
    return 1;
}

/* The unit of a derivative, or for a negative order of an integral: of m/s^2 they are m/s^3 and m/s. */
static char *
change_unit(const char *unit, int order)
{
    size_t last = strlen(unit), size = last + 32;
    while (last > 0 && unit[last - 1] != '/' && unit[last - 1] != ' ')
        last--;
    char *end = "", *made = malloc(size);
    const char *part = unit + last;
    double power = strncmp(part, "s^", 2) == 0 ? ss_number_parse(part + 2, &end) : 1;
    int is_time = part[0] == 's' && (part[1] == '\0' || part[1] == '^') && *end == '\0';
    int divides = last > 0 && unit[last - 1] == '/', total = order + (is_time ? divides ? (int)power : -(int)power : 0);
    int kept = (int)(!is_time ? strlen(unit) : last > 0 ? last - 1 : 0);
    const char *before = total > 0 ? kept > 0 ? "/" : "1/" : kept > 0 ? " " : "";
    if (made != NULL && (total == 0 || unit[0] == '\0'))
        snprintf(made, size, "%.*s", kept, unit);
    else if (made != NULL)
        snprintf(made, size, abs(total) > 1 ? "%.*s%ss^%d" : "%.*s%ss", kept, unit, before, abs(total));
    return made;
}

static ss_status
change_header(ss_header *head, const struct design *d, double stop)
{
    ss_range flat = { d->high > 0 ? (d->high + d->high_width) * d->rate : 0,
                      d->low > 0 ? (d->low - d->low_width) * d->rate : d->rate / 2 };
    char text[200], more[40] = "";
    ss_header_flat(head, &flat);
    if (d->order != 0)
        ss_print_to(more, sizeof more, ", %s %d", d->order > 0 ? "derivative" : "integral", abs(d->order));
    ss_print_to(text, sizeof text, "flat %.9g to %.9g Hz, stop %.9g dB%s%s", flat.from, flat.to, stop, more,
                d->sums > 0 ? ", drifts" : "");
    ss_status st = ss_header_note(head, note_key, text, NULL);
    for (size_t c = 0; st == SS_OK && d->order != 0 && c < head->n_columns; c++) {
        char *unit = change_unit(head->column[c].unit, d->order);
        if (unit == NULL)
            return SS_ENOMEM;
        free(head->column[c].unit);
        head->column[c].unit = unit;
    }
    /* the gaps grow by the reach of the filter, as what lies beside them is not known either */
    const double reach = (double)(d->n / 2) / d->rate;
    ss_span *gap = NULL;
    size_t n = 0;
    st = st == SS_OK ? ss_header_gaps(&gap, &n, head, NULL) : st;
    for (size_t i = 0; i < n; i++)
        gap[i] = (ss_span){ gap[i].from - reach, gap[i].to + reach };
    st = st == SS_OK ? ss_header_note_gaps(head, gap, n) : st;
    free(gap);
    head->start += reach;
    return st == SS_EDATA ? SS_OK : st;
}

/* --- the rows ------------------------------------------------------------------------------ */

struct filtered {
    ss_source base;
    size_t columns, n, block, parts, terms;     /* n: taps; terms: numbers of a spectrum */
    int sums;
    real_fft forth, back;
    double *tap, *seen;         /* spectra of the parts; and of each column's last blocks */
    double **in, **out;         /* of each column the block before and the one that is filled; what comes of it */
    double (*sum)[2];           /* of each column, for integrals */
    uint64_t blocks;            /* so far */
    int ended;                  /* have all rows been read? */
};

/* The first result of a block that is known: the first n - 1 rows have not filled the filter. */
static size_t
first_known(const struct filtered *f, uint64_t block)
{
    uint64_t before = block * f->block, needed = f->n - 1;
    return needed <= before ? 0 : needed - before < f->block ? (size_t)(needed - before) : f->block;
}

/* y += a b, of spectra of so many complex terms. */
static void
add_product(double *restrict y, const double *restrict a, const double *restrict b, size_t terms)
{
    for (size_t k = 0; k < terms; k += 2) {
        y[k] += a[k] * b[k] - a[k + 1] * b[k + 1];
        y[k + 1] += a[k] * b[k + 1] + a[k + 1] * b[k];
    }
}

static void
run_column(struct filtered *f, size_t c)
{
    size_t parts = f->parts, block = f->block, terms = f->terms;
    double *seen = f->seen + c * parts * terms;
    memcpy(f->forth.x, f->in[c], 2 * block * sizeof *f->forth.x);
    ss_real_fft_run(&f->forth);
    memcpy(seen + f->blocks % parts * terms, f->forth.x, terms * sizeof *seen);
    memset(f->back.x, 0, terms * sizeof *f->back.x);
    for (size_t p = 0; p < parts && p <= f->blocks; p++)
        add_product(f->back.x, seen + (f->blocks - p) % parts * terms, f->tap + p * terms, terms);
    ss_real_fft_run(&f->back);
    memcpy(f->out[c], f->back.x + block, block * sizeof *f->back.x);
    memmove(f->in[c], f->in[c] + block, block * sizeof *f->back.x);
}

/* Sums of the results from the first known one on, which becomes 0.  The second sum begins between two rows, so
 * half of the first result lies before it. */
static void
sum_up(struct filtered *f, size_t c)
{
    double *sum = f->sum[c], *x = f->out[c];
    uint64_t before = f->blocks * f->block;
    for (size_t i = first_known(f, f->blocks); i < f->block; i++) {
        int first = before + i == f->n - 1;
        double now = x[i];
        if (f->sums == 1) {
            x[i] = sum[0] = first ? 0 : sum[0] + now;
            continue;
        }
        x[i] = sum[0] = first ? 0 : sum[0] + sum[1];
        sum[1] = first ? now / 2 : sum[1] + now;
    }
}

/* Read on until a block is full, or the rows end, and run it. */
static ss_status
next_block(struct filtered *f, ss_error *err)
{
    double **to = f->in + f->columns;           /* room for the places of the next rows */
    size_t filled = 0;
    for (size_t n; filled < f->block && !f->ended; filled += n) {
        for (size_t c = 0; c < f->columns; c++)
            to[c] = f->in[c] + f->block + filled;
        ss_status st = ss_source_rows(f->base.inner, to, f->block - filled, &n, err);
        if (st != SS_OK)
            return st;
        f->ended = n == 0;
    }
    f->base.held = filled;
    f->base.given = first_known(f, f->blocks);
    for (size_t c = 0; c < f->columns; c++) {
        memset(f->in[c] + f->block + filled, 0, (f->block - filled) * sizeof *f->in[c]);
        run_column(f, c);
        if (f->sums > 0)
            sum_up(f, c);
        for (size_t i = f->base.given; i < filled; i++)
            if (!isfinite(f->out[c][i]))
                return ss_fail(err, SS_ERANGE, "%s: a filtered value exceeds what a double holds", f->base.name);
    }
    uint64_t rows = f->blocks++ * f->block + filled;
    if (rows >= f->n || !f->ended)
        return SS_OK;
    return ss_fail(err, SS_EDATA, "%s: the filter needs %zu rows, %.4g s, and there are %llu", f->base.name, f->n,
                   (double)f->n / f->base.head->rate, (unsigned long long)rows);
}

static ss_status
make_filtered(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct filtered *f = (struct filtered *)s;
    ss_status st = SS_OK;
    (void)column, (void)max, (void)n;
    while (st == SS_OK && s->given >= s->held && !f->ended)
        st = next_block(f, err);
    s->held = s->held < s->given ? s->given : s->held;
    return st;
}

static void
rewind_filtered(ss_source *s)
{
    struct filtered *f = (struct filtered *)s;
    f->blocks = 0;
    f->ended = 0;
    for (size_t c = 0; c < f->columns; c++)
        memset(f->in[c], 0, f->block * sizeof *f->in[c]);
}

static void
free_filtered(ss_source *s)
{
    struct filtered *f = (struct filtered *)s;
    ss_real_fft_free(&f->forth);
    ss_real_fft_free(&f->back);
    free(f->tap);
    free(f->seen);
    free(f->in);
    free(f->out);
    free(f->sum);
}

/* Make room, and the spectra of the parts. */
static ss_status
prepare(struct filtered *f, const struct design *d)
{
    size_t block = BLOCK_LEAST;
    while (16 * block <= d->n)
        block *= 2;
    f->n = d->n;
    f->sums = d->sums;
    f->block = block;
    f->parts = (d->n + block - 1) / block;
    f->terms = 2 * block + 2;
    f->tap = malloc(f->parts * f->terms * sizeof *f->tap);
    f->seen = malloc(f->columns * f->parts * f->terms * sizeof *f->seen);
    f->in = ss_columns_new(2 * f->columns, 2 * block);
    f->out = ss_columns_new(f->columns, block);
    f->sum = calloc(f->columns, sizeof *f->sum);
    if (f->tap == NULL || f->seen == NULL || f->in == NULL || f->out == NULL || f->sum == NULL)
        return SS_ENOMEM;
    ss_status st = ss_real_fft_new(&f->forth, 2 * block, 0);
    if (st == SS_OK)
        st = ss_real_fft_new(&f->back, 2 * block, 1);
    for (size_t p = 0; st == SS_OK && p < f->parts; p++) {
        size_t left = d->n - p * block, n = left < block ? left : block;
        memset(f->forth.x, 0, f->terms * sizeof *f->forth.x);
        for (size_t i = 0; i < n; i++)
            f->forth.x[i] = d->tap[p * block + i] / (double)(2 * block);
        ss_real_fft_run(&f->forth);
        memcpy(f->tap + p * f->terms, f->forth.x, f->terms * sizeof *f->tap);
    }
    f->base.made = *f->out;
    f->base.apart = block;
    rewind_filtered(&f->base);
    return st;
}

ss_status
ss_source_filter(ss_source **s, const ss_filter_opts *opts, ss_error *err)
{
    static const struct source_calls calls = {
        .next = make_filtered, .rewind = rewind_filtered, .free = free_filtered };
    struct design d;
    ss_filter_opts o;
    ss_status st = ss_options_take(&o, sizeof o, &defaults, opts, err);
    if (st != SS_OK)
        return st;
    if (!(o.low_pass >= 0 && o.high_pass >= 0 && o.stop > 0 && o.stop <= 160 && o.order >= -2 && o.order <= 4))
        return ss_fail(err, SS_EINVAL, "a filter's edges must be >= 0, its stop in 0 ... 160 dB, its order -2 ... 4");
    st = choose(&d, *s, &o, err);
    if (st != SS_OK)
        return st;
    struct filtered *f = ss_source_wrap(s, sizeof *f, &calls, err);
    if (f == NULL)
        return SS_ENOMEM;
    f->columns = f->base.head->n_columns;
    st = make_taps(&d);
    if (st == SS_OK)
        st = prepare(f, &d);
    if (st == SS_OK)
        st = change_header(f->base.head, &d, fmax(o.stop, LEAST_STOP));
    free(d.tap);
    if (st != SS_OK) {
        ss_source_unwrap(s);
        return st == SS_ENOMEM ? ss_fail_memory(err, (*s)->name) : st;
    }
    uint64_t length = f->base.length;
    f->base.length = length == UINT64_MAX ? length : length > d.n - 1 ? length - (d.n - 1) : 0;
    return SS_OK;
}
