/* stream.c -- transform a signal whose end is not known, window by window.
 *
 * Scales are computed in blocks, as those of a record are (fft/windows.c): each level keeps one window, which is
 * computed when it is full, so only samples are kept from one window to the next.  When complete coefficients are
 * wanted at once, windows are filled up with zeros and computed.
 *
 * A coefficient is complete if all samples within REACH a of b have come: others add at most exp(-REACH^2/2) to
 * its error, nothing compared with the promise. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "map/fft/blocks.h"
#include "map/map.h"
#include "map/plan.h"

enum { GIVEN = 1 << 17 };       /* coefficients computed and passed to the sink at a time, at most */

/* What is computed of one window. */
typedef struct window {
    ss_stream *stream;
    ptrdiff_t limit;            /* a coefficient is complete if it needs no sample from here on */
    transformed of;
} window;

struct ss_stream {
    ss_morlet *plan;            /* as of the longest record that a plan allows */
    ss_coefficient_sink *sink;
    void *user;
    size_t samples;
    size_t *next;               /* of each scale, the next translation */
    cascade *cascade;
    double x_max;               /* of all samples */
    int exponent;               /* those in the cascade are divided by 2^exponent */
    double *w;
    ss_map_part *part;
    int ended;
    ss_status status;           /* of what failed first, which every later call returns */
    ss_error error;
};

/* --- what a window gives ---------------------------------------------------------------------- */

/* The next translations of scale i that a window gives. */
static size_t
count_given(const window *win, size_t i)
{
    const ss_stream *s = win->stream;
    const ss_scale *scale = &s->plan->grid.scale[i];
    size_t end = ss_blocks_end(s->plan->blocks, i, win->of.spectra.first);
    double last = s->ended ? (double)s->samples - 1 : INFINITY;
    if (win->limit < PTRDIFF_MAX)
        last = (double)win->limit - ceil(REACH * scale->a * s->plan->rate) - 1;
    if (last < 0)
        return 0;
    if (isfinite(last)) {
        size_t count = ss_scale_count(scale, last / s->plan->rate);
        end = end < count ? end : count;
    }
    return end > s->next[i] ? end - s->next[i] : 0;
}

/* Compute and send all coefficients of a window of a level, scale by scale in parts of at most GIVEN, whatever the
 * number of threads.  One thread computes part by part, so that each stays in the cache; several threads share as
 * many parts as there is room for. */
static ss_status
run_level(size_t level, size_t number, double *spectrum, void *user)
{
    window win = *(const window *)user;
    ss_stream *s = win.stream;
    const size_t scales = s->plan->grid.n_scales, most = s->plan->opts.threads > 1 ? scales : 1;
    ss_status st = SS_OK;
    win.of.spectra.first = number;
    win.of.spectra.level[level] = spectrum;
    size_t i = 0, end;
    while (i < scales && ss_blocks_level(s->plan->blocks, i) > level)
        i++;
    for (end = i; end < scales && ss_blocks_level(s->plan->blocks, end) == level; end++)
        ;
    while (st == SS_OK && i < end) {
        size_t all = 0, parts = 0;
        for (; i < end && parts < most; i++) {
            size_t n = count_given(&win, i), part = n < GIVEN ? n : GIVEN;
            if (all + part > GIVEN)
                break;
            if (part > 0)
                s->part[parts++] = (ss_map_part){ i, s->next[i], part, s->w + 2 * all, NULL };
            all += part;
            if (part < n)
                break;                  /* the rest comes next */
        }
        st = ss_morlet_parts(s->plan, &win.of, s->part, parts, NULL, &s->error);
        for (const ss_map_part *p = s->part; st == SS_OK && p < s->part + parts; p++) {
            s->next[p->scale] = p->first + p->n;
            if (s->sink(&s->plan->grid.scale[p->scale], p->first, p->n, p->w, s->samples, s->user))
                st = SS_STOP;
        }
    }
    return st;
}

/* All coefficients that need no sample from limit on, PTRDIFF_MAX: all. */
static void
run_to(ss_stream *s, ptrdiff_t limit)
{
    window asked = { .stream = s, .limit = limit, .of.rec.exponent = s->exponent };
    s->status = ss_cascade_end(s->cascade, s->samples, run_level, &asked);
}

/* --- samples ---------------------------------------------------------------------------------- */

/* Append n samples, at most as many as complete a window.  Samples are divided so that their squares neither
 * overflow nor underflow; the exponent is 0 except for signals near the limits of a double.  A window is computed
 * as soon as it has its last sample, so its coefficients do not depend on how samples arrive. */
static void
append(ss_stream *s, const double *x, size_t n)
{
    enum { FAR = 300 };
    double most;
    size_t good = ss_morlet_finite(x, n, &most);
    s->x_max = fmax(most, s->x_max);
    int more = (s->x_max > 0 ? FAR * (ilogb(s->x_max) / FAR) : 0) - s->exponent;
    if (more != 0)
        ss_cascade_divide(s->cascade, more, ldexp(s->x_max, -s->exponent));
    s->exponent += more;
    ss_morlet_divide(ss_cascade_append(s->cascade, x, good), good, s->exponent, s->x_max);
    s->samples += good;
    window asked = { .stream = s, .limit = PTRDIFF_MAX, .of.rec.exponent = s->exponent };
    s->status = ss_cascade_run(s->cascade, run_level, &asked);
    if (s->status == SS_OK && good < n)
        s->status = ss_morlet_not_finite(&s->error, s->samples + 1, x[good]);
}

static ss_status
report(const ss_stream *s, ss_error *err)
{
    if (s->status != SS_OK && err != NULL)
        *err = s->error;
    return s->status;
}

ss_status
ss_stream_push(ss_stream *s, const double *x, size_t n, ss_error *err)
{
    if (s == NULL || (x == NULL && n > 0))
        return SS_FAIL_NULL(err);
    if (s->status == SS_OK && s->ended)
        s->status = ss_fail(&s->error, SS_EINVAL, "the stream has ended");
    for (size_t room, piece; s->status == SS_OK && n > 0; x += piece, n -= piece) {
        room = ss_cascade_room(s->cascade);
        piece = n < room ? n : room;
        append(s, x, piece);
    }
    return report(s, err);
}

ss_status
ss_stream_drain(ss_stream *s, ss_error *err)
{
    if (s == NULL)
        return SS_FAIL_NULL(err);
    if (s->status == SS_OK)
        run_to(s, (ptrdiff_t)s->samples);
    return report(s, err);
}

ss_status
ss_stream_end(ss_stream *s, ss_error *err)
{
    if (s == NULL)
        return SS_FAIL_NULL(err);
    if (s->status == SS_OK && s->samples == 0)
        s->status = ss_fail(&s->error, SS_EINVAL, "the record is empty");
    if (s->status == SS_OK && !s->ended) {
        s->ended = 1;
        run_to(s, PTRDIFF_MAX);
    }
    return report(s, err);
}

/* --- making and freeing ----------------------------------------------------------------------- */

/* Make the grid, and room for what threads need. */
static ss_status
make(ss_stream *s, double rate, const ss_morlet_opts *opts, ss_error *err)
{
    ss_morlet *plan = s->plan = calloc(1, sizeof *plan);
    if (plan == NULL)
        return SS_ENOMEM;
    *plan = (ss_morlet){ .opts = *opts, .n = INT_MAX / 2, .rate = rate, .window = 1 };
    ss_status st = ss_grid_make(&plan->scale, &plan->n_scales, 0, rate, opts, err);
    if (st == SS_OK)
        st = ss_blocks_new(plan);
    plan->grid = (ss_grid){ plan->n_scales, plan->scale, 0 };
    for (size_t i = plan->n_scales; st == SS_OK && i-- > 0;)
        if (!ss_blocks_covers(plan->blocks, i))
            return ss_fail(err, SS_ESCALE, "a stream has no scale as short as that of %.6g Hz", plan->scale[i].f);
    if (st != SS_OK)
        return st;
    s->cascade = ss_cascade_new(plan->blocks);
    s->next = calloc(plan->n_scales, sizeof *s->next);
    s->w = malloc(2 * GIVEN * sizeof *s->w);
    s->part = malloc(plan->n_scales * sizeof *s->part);
    return s->cascade != NULL && s->next != NULL && s->w != NULL && s->part != NULL ? SS_OK : SS_ENOMEM;
}

ss_status
ss_stream_new(ss_stream **out, double rate, const ss_morlet_opts *given, ss_coefficient_sink *sink,
              void *user, ss_error *err)
{
    ss_morlet_opts opts;
    if (out == NULL || sink == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_morlet_take(&opts, given, err);
    if (st == SS_OK)
        st = ss_morlet_check(1, rate, &opts, err);
    if (st != SS_OK)
        return st;
    if (!(opts.fmin > 0) && !opts.octaves)
        return ss_fail(err, SS_EINVAL, "a stream, whose length is not known, needs fmin");
    if (opts.detrend != SS_DETREND_NONE)
        return ss_fail(err, SS_EINVAL, "a stream cannot be detrended: a mean or a line is that of "
                       "the whole record");
    if (opts.engine == SS_ENGINE_QUADRATURE)
        return ss_fail(err, SS_EINVAL, "a stream is computed by FFTs: quadrature is for whole records");
    ss_stream *s = calloc(1, sizeof *s);
    if (s == NULL)
        return SS_ENOMEM;
    s->sink = sink;
    s->user = user;
    st = make(s, rate, &opts, err);
    if (st == SS_OK)
        *out = s;
    else
        ss_stream_free(s);
    return st;
}

void
ss_stream_free(ss_stream *s)
{
    if (s == NULL)
        return;
    ss_cascade_free(s->cascade);
    ss_morlet_free(s->plan);
    free(s->next);
    free(s->part);
    free(s->w);
    free(s);
}

const ss_grid *
ss_stream_grid(const ss_stream *s)
{
    return s != NULL ? &s->plan->grid : NULL;
}

size_t
ss_stream_samples(const ss_stream *s)
{
    return s != NULL ? s->samples : 0;
}

size_t
ss_stream_window(const ss_stream *s, size_t i)
{
    return s != NULL && i < s->plan->grid.n_scales ? (size_t)ss_blocks_delay(s->plan->blocks, i) : 0;
}
