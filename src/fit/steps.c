/* steps.c -- find the steps in the speed of a load point, fit both laws to each, and write them.
 *
 * A sensor of the path has noise, of which a stiff spring would make noise of friction; and friction that answers
 * to its own model's noise is fitted by too small a, b and k.  So the path is first cut into lines, again and
 * again where two of them fit best, as long as they are significantly better than one; and the load point moves on
 * a chain of links that meet where the lines do.  A link that noise does not explain stays as recorded.  But where
 * a sensor jumps and friction does not, the load point has not moved: so one that moves at the speeds of the
 * slides alone is tried too, and the likelier path is kept.
 *
 * Lines whose speeds differ by less than a fifth are one slide.  A line that is short beside its neighbours, in
 * time and way, is the ramp of a servo; it belongs to the change between these.  A step begins in the second half
 * of a slide, when that may be steady, and ends with the next slide. */
#include <stickslip/steps.h>

#include <float.h>
#include <gsl/gsl_interp.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/options.h"
#include "base/list.h"
#include "base/number.h"
#include "find/medians.h"
#include "find/judgement.h"
#include "fit/column.h"
#include "fit/loaded.h"
#include "fit/wander.h"
#include "io/record.h"
#include "signal/header.h"

enum { LEAST = 4, MOST = 4096, CLOSE = 1024 };      /* rows of a line, of a step, and behind a corner: no means */
enum { BETWEEN = 4 };           /* parts of the way from one row to the next, where it bends */
enum { ROOM = 6 };              /* columns of a step: time, friction, two paths, two laws */
#define CHANGE 0.2              /* the least relative change of speed */
#define SIGNIFICANT 30          /* times the noise: squares that a cut must save */
#define STILL FAINT             /* a hold's speed over that of the lines beside it */

static const ss_steps_opts defaults = { .size = sizeof defaults, .normal = -1 };

SS_OPTIONS(ss_steps_opts, defaults)

/* What the lines of a slide say of it, however its sensor jumps between them. */
typedef struct slide {
    double meets;               /* when it meets the one before [s] */
    double speed, weight;       /* mean of its lines, by how well each shows it */
} slide;

typedef struct corner {
    double t, load;
} corner;

typedef struct line {
    size_t first, end;          /* rows */
    double speed, error;
    double at, from, squares;   /* it passes the point (at, from); sum of squares about it */
    slide of;
} line;

typedef struct path {
    const double *t;
    double *x, *moved[2];       /* as recorded, and on either chain */
    size_t n;
    long double (*sum)[5];      /* of t, x, t t, t x, x x of the rows before */
    double rounding, saved, noise;      /* of the sums of squares; squares that a cut must save; of the path */
    double digit;               /* of a sensor, between two of which it stands still, or 0 */
    double start;               /* x of the first row, as recorded */
    line *line;
    size_t lines, room;
    gsl_interp *curve;          /* through the rows */
    corner *corner[2];          /* of either chain, and places between rows where the path stays as recorded */
    size_t corners[2];
} path;

/* The line through the rows first ... end - 1; returns the sum of squares about it. */
static double
fit_line(const path *p, size_t first, size_t end, line *out)
{
    long double s[5], n = (long double)(end - first);
    for (int i = 0; i < 5; i++)
        s[i] = p->sum[end][i] - p->sum[first][i];
    long double tt = s[2] - s[0] * s[0] / n, tx = s[3] - s[0] * s[1] / n, xx = s[4] - s[1] * s[1] / n;
    double left = (double)fmaxl(xx - tx * tx / tt, 0);
    *out = (line){ first, end, (double)(tx / tt), sqrt((left + p->rounding) / (double)(n - 2) / (double)tt),
                   (double)(s[0] / n), (double)(s[1] / n), left, out->of };
    return left;
}

/* The two lines that fit these rows best; returns their squares, infinite if there are too few rows. */
static double
fit_two(const path *p, size_t first, size_t end, line *left, line *right)
{
    double least = INFINITY;
    for (size_t i = first + LEAST; i + LEAST <= end; i++) {
        line a = { 0 }, b = { 0 };
        double squares = fit_line(p, first, i, &a) + fit_line(p, i, end, &b);
        if (squares < least) {
            least = squares;
            *left = a;
            *right = b;
        }
    }
    return least;
}

/* Does another line save squares that noise does not explain, be it that of the path or what is left of n rows? */
static int
is_needed(const path *p, double without, double with, size_t n)
{
    return without - with > fmax(p->saved, SIGNIFICANT * with / (double)n);
}

/* Cut these rows into lines, in order.  SS_ENOMEM. */
static ss_status
cut(path *p, size_t first, size_t end)
{
    line whole = { 0 }, left, right;
    fit_line(p, first, end, &whole);
    if (is_needed(p, whole.squares, fit_two(p, first, end, &left, &right), end - first)) {
        ss_status st = cut(p, first, left.end);
        return st == SS_OK ? cut(p, left.end, end) : st;
    }
    line *more = ss_list_room(p->line, &p->room, p->lines, sizeof *more);
    if (more == NULL)
        return SS_ENOMEM;
    p->line = more;
    more[p->lines++] = whole;
    return SS_OK;
}

static void
drop(path *p, size_t i, size_t n)
{
    memmove(&p->line[i], &p->line[i + n], (p->lines - i - n) * sizeof *p->line);
    p->lines -= n;
}

/* Leave out lines that only stand where a cut was not the best beside the next one. */
static void
prune(path *p)
{
    for (size_t k = 1; k + 1 < p->lines;) {
        line *l = &p->line[k], left, right;
        double three = l[-1].squares + l->squares + l[1].squares;
        if (is_needed(p, fit_two(p, l[-1].first, l[1].end, &left, &right), three, l[1].end - l[-1].first)) {
            k++;
            continue;
        }
        l[-1] = left;
        l[1] = right;
        drop(p, k, 1);
        k -= k > 1;
    }
}

/* Are the n lines behind this one a ramp to the next, short beside both, in time and way? */
static int
is_ramp(const path *p, const line *l, size_t n)
{
    const line *beside[2] = { l, l + n + 1 };
    const double low = fmin(l->speed, beside[1]->speed), high = fmax(l->speed, beside[1]->speed);
    double time = 0, way = 0;
    for (const line *r = l + 1; r <= l + n; r++) {
        if (!(r->speed > low - CHANGE * (high - low) && r->speed < high + CHANGE * (high - low)))
            return 0;
        time += p->t[r->end - 1] - p->t[r->first];
        way += fabs(r->speed) * (p->t[r->end - 1] - p->t[r->first]);
    }
    for (int k = 0; k < 2; k++) {
        double other = p->t[beside[k]->end - 1] - p->t[beside[k]->first];
        if (!(time < LITTLE * other && way < LITTLE * fabs(beside[k]->speed) * other))
            return 0;
    }
    return 1;
}

/* How much the speeds of a line and the next differ, in parts of what makes them two. */
static double
difference(const line *l)
{
    double by = fabs(l[1].speed - l[0].speed);
    return by / fmax(CHANGE * fmax(fabs(l[0].speed), fabs(l[1].speed)), 5 * (l[0].error + l[1].error));
}

/* Join lines of like speed, the likest first, and leave out ramps: then the change between their neighbours ends
 * where the next line begins. */
static void
join(path *p)
{
    for (int again = 1; again;) {
        size_t likest = 0;
        for (size_t i = 1; i + 1 < p->lines; i++)
            if (difference(&p->line[i]) < difference(&p->line[likest]))
                likest = i;
        again = p->lines > 1 && difference(&p->line[likest]) < 1;
        if (again) {
            line *l = &p->line[likest];
            const double weight = l[0].of.weight + l[1].of.weight;
            fit_line(p, l[0].first, l[1].end, l);
            l->of.speed += l[1].of.weight / weight * (l[1].of.speed - l->of.speed);
            l->of.weight = weight;
            drop(p, likest + 1, 1);
        }
        for (size_t i = 0; !again && i + 2 < p->lines; i++)
            for (size_t n = 1; !again && i + n + 1 < p->lines; n++)
                if ((again = is_ramp(p, &p->line[i], n))) {
                    p->line[i + n + 1].of.meets = (p->line[i + 1].of.meets + p->line[i + n + 1].of.meets) / 2;
                    drop(p, i + 1, n);
                }
    }
}

/* The square of how far a row is off its neighbours, in parts of the path's noise. */
static double
off_neighbours(const path *p, size_t i)
{
    double w = (p->t[i + 1] - p->t[i]) / (p->t[i + 1] - p->t[i - 1]);
    double by = p->x[i] - w * p->x[i - 1] - (1 - w) * p->x[i + 1];
    return by * by / (1 + w * w + (1 - w) * (1 - w));
}

/* What all changes of a column are multiples of, or 0, and for how many rows it stands still. */
static double
digit_of(const double *x, size_t n, size_t *longest)
{
    const double digit = ss_smallest_change(x, n);
    *longest = 1;
    for (size_t i = 1, run = 1; i < n; i++) {
        run = x[i] != x[i - 1] ? 1 : run + 1;
        *longest = run > *longest ? run : *longest;
    }
    for (size_t i = 1; i < n; i++) {
        const double digits = (x[i] - x[i - 1]) / digit;
        if (!(fabs(digits - rint(digits)) < 0.02))
            return 0;
    }
    return digit;
}

/* The variance of the path's noise along a line: the faster it is, the more that of its stamps makes, which are
 * multiples of a power of ten if they were rounded. */
static double
noise_along(const path *p, const line *l)
{
    double sum = 0, n = 0, most = 0;
    for (size_t i = l->first; i < l->end; i++)
        most = fmax(most, fabs(p->t[i]));
    double grain = pow(10, ceil(log10(most)));
    for (size_t i = l->first; i < l->end && grain > 1e-12 * most;)
        if (fabs(p->t[i] / grain - rint(p->t[i] / grain)) < FAINT)
            i++;
        else
            grain /= 10, i = l->first;
    const double by_stamps = grain > 1e-12 * most ? l->speed * grain : 0;
    for (size_t i = l->first + LEAST; i + LEAST < l->end; i++, n++)
        sum += off_neighbours(p, i);
    return fmax(fmax(p->noise, n > 2 * LEAST ? sum / n : 0), by_stamps * by_stamps / 12);
}

/* The time at which a line ends. */
static double
end_of(const path *p, size_t k)
{
    return k + 1 < p->lines ? p->line[k + 1].of.meets : p->t[p->n - 1];
}

/* Add places between a row, as recorded, and the next, on Akima's curve, which keeps a line straight to its end. */
static void
add_between(path *p, size_t i)
{
    for (int k = 1; k < BETWEEN; k++) {
        const double t = p->t[i] + k / (double)BETWEEN * (p->t[i + 1] - p->t[i]);
        p->corner[0][p->corners[0]++] = (corner){ t, gsl_interp_eval(p->curve, p->t, p->x, t, NULL) };
    }
}

/* Move the path onto the chain of straight links between such joints that is nearest to it, but where noise does
 * not explain what a link leaves.  SS_ENOMEM. */
static ss_status
chain(path *p)
{
    const size_t joints = p->lines + 1;
    double *on = calloc(4 * joints, sizeof *on), *beside = on + joints, *sum = beside + joints, *at = sum + joints;
    p->curve = gsl_interp_alloc(gsl_interp_akima, p->n);
    if (on == NULL || p->curve == NULL) {
        free(on);
        return SS_ENOMEM;
    }
    gsl_interp_init(p->curve, p->t, p->x, p->n);
    memcpy(p->moved[0], p->x, p->n * sizeof *p->x);
    for (int pass = 0; pass < 2; pass++) {
        int fits = 0;
        for (size_t k = 0, i = 0, end; k < p->lines; k++, i = end) {
            const double from = p->line[k].of.meets, to = end_of(p, k);
            double squares = 0;
            for (end = i; end < p->n && (p->t[end] < to || k + 1 == p->lines); end++) {
                double u = (p->t[end] - from) / (to - from), x = p->x[end] - p->start;
                double off = (1 - u) * at[k] + u * at[k + 1] - x;
                on[k] += (1 - u) * (1 - u);
                on[k + 1] += u * u;
                beside[k] += u * (1 - u);
                sum[k] += (1 - u) * x;
                sum[k + 1] += u * x;
                squares += off * off;
            }
            if (pass == 0)
                continue;
            const int fitted = fits;
            fits = squares < SIGMAS * SIGMAS * noise_along(p, &p->line[k]) * (double)(end - i) + p->rounding;
            if (fits && fitted)
                p->corner[0][p->corners[0]++] = (corner){ from, p->start + at[k] };
            else if (i > 0)
                add_between(p, i - 1);
            for (size_t j = i; j < end; j++) {
                double u = (p->t[j] - from) / (to - from);
                if (fits)
                    p->moved[0][j] = p->start + (1 - u) * at[k] + u * at[k + 1];
                else if (j + 1 < end)
                    add_between(p, j);
            }
        }
        gsl_vector_view d = gsl_vector_view_array(on, joints), e = gsl_vector_view_array(beside, joints - 1);
        gsl_vector_view b = gsl_vector_view_array(sum, joints), x = gsl_vector_view_array(at, joints);
        if (pass == 0)
            gsl_linalg_solve_symm_tridiag(&d.vector, &e.vector, &b.vector, &x.vector);
    }
    free(on);
    return SS_OK;
}

/* Find the lines of different speed, and both paths. */
static ss_status
find_lines(path *p)
{
    p->moved[0] = malloc(2 * p->n * sizeof *p->moved[0]);
    p->sum = malloc((p->n + 1) * sizeof *p->sum);
    if (p->moved[0] == NULL || p->sum == NULL)
        return SS_ENOMEM;
    p->moved[1] = p->moved[0] + p->n;
    const double from = p->start = p->x[0], way = p->x[p->n - 1] - from;
    for (size_t i = 1; i + 1 < p->n; i++)
        p->moved[0][i] = off_neighbours(p, i);
    size_t still;
    p->digit = digit_of(p->x, p->n, &still);
    const double noise = ss_wander_variance(p->moved[0] + 1, p->n - 2), by_digits = p->digit * p->digit / 12;
    p->noise = fmax(noise, by_digits);
    memset(p->sum[0], 0, sizeof p->sum[0]);
    for (size_t i = 0; i < p->n; i++) {
        long double t = p->t[i] - p->t[0], x = p->x[i] - from, of[5] = { t, x, t * t, t * x, x * x };
        for (int k = 0; k < 5; k++)
            p->sum[i + 1][k] = p->sum[i][k] + of[k];
    }
    p->rounding = 10 * DBL_EPSILON * way * way;
    p->saved = fmax(SIGNIFICANT * p->noise * (double)still, p->rounding);
    ss_status st = cut(p, 0, p->n);
    if (st == SS_OK)
        prune(p);
    int is_digit = 0;                           /* an even path passes a digit a row, and shows no step */
    for (size_t k = 0; k < p->lines; k++)
        is_digit |= p->line[k].squares > by_digits / 2 * (double)(p->line[k].end - p->line[k].first);
    p->digit = is_digit ? p->digit : 0;
    p->noise = is_digit ? p->noise : noise;
    for (size_t k = 0; st == SS_OK && k < p->lines; k++) {
        line *l = &p->line[k];
        const double first = p->t[l->first], last = p->t[l->end - 1], lasts = last - first;
        l->of = (slide){ first, l->speed, (double)(l->end - l->first) * lasts * lasts };
        if (k == 0)
            continue;
        /* where it meets the line before, if that is near its first row */
        const double apart = l[-1].from - l[-1].speed * l[-1].at - (l->from - l->speed * l->at);
        const double meet = p->t[0] + apart / (l->speed - l[-1].speed);
        if (meet > (p->t[l[-1].first] + first) / 2 && meet < (first + last) / 2)
            l->of.meets = meet;
    }
    p->corner[0] = st == SS_OK ? malloc((BETWEEN * p->n + 2 * p->lines) * sizeof *p->corner[0]) : NULL;
    if (p->corner[0] == NULL)
        return SS_ENOMEM;
    p->corner[1] = p->corner[0] + BETWEEN * p->n + p->lines;
    st = chain(p);
    if (st == SS_OK)
        join(p);
    double x = from;            /* at the speeds of the slides alone, one from where the last ends */
    for (size_t k = 0, i = 0; st == SS_OK && k < p->lines; k++) {
        const slide *s = &p->line[k].of;
        const double to = end_of(p, k);
        if (k > 0)
            p->corner[1][p->corners[1]++] = (corner){ s->meets, x };
        for (; i < p->n && (p->t[i] < to || k + 1 == p->lines); i++)
            p->moved[1][i] = x + s->speed * (p->t[i] - s->meets);
        x += s->speed * (to - s->meets);
    }
    return st;
}

/* --- a step -------------------------------------------------------------------------------- */

/* Where a slide may be steady. */
static size_t
middle(const path *p, size_t k)
{
    return k > 0 ? (p->line[k].first + p->line[k].end) / 2 : 0;
}

/* Lay the places of the load point under the rows of a step, each the mean of so many of the record.  Where
 * friction bends, at and behind corners, each row has a place, else each mean.  The slide before is passed first,
 * since it may not be forgotten in the middle of this one.  SS_ENOMEM. */
static ss_status
lay(track *r, const path *p, int which, size_t at, size_t apart)
{
    const corner *c = p->corner[which], *end = c + p->corners[which];
    /* the way from the slide before is known, but behind a hold with which a record begins */
    const size_t held = at > 1 && p->line[at - 1].speed < STILL * p->line[at - 2].speed;
    const size_t before = at > 0 ? at - 1 - held : 0, first = middle(p, at);
    size_t corners = 0;
    for (const corner *k = c; k < end; k++)
        corners += k->t > p->t[middle(p, before)] && k->t < p->t[first];
    const int is_known = corners >= at - before && p->line[before].speed > STILL * p->line[at].speed;
    const size_t from = is_known ? before : at, start = middle(p, from);
    const double *x = p->moved[which];
    place *to = r->place = malloc((r->n * apart + p->corners[which] + 1) * sizeof *to);
    if (to == NULL)
        return SS_ENOMEM;
    while (c < end && c->t <= p->t[start])
        c++;
    if (from < at)
        *to++ = (place){ p->t[start], x[start] - x[first], 0, 0 };
    for (size_t i = 0, bent = 0, k = first; i < r->n; i++, bent -= bent < apart ? bent : apart) {
        const size_t behind = first + (i + 1) * apart;
        if (c < end && c->t <= p->t[behind - 1])
            bent = CLOSE;
        if (bent == 0) {
            *to++ = (place){ r->t[i], r->load[i], i, 1 };
            k = behind;
        }
        for (; k < behind; k++) {
            for (; c < end && c->t <= p->t[k]; c++)
                *to++ = (place){ c->t, c->load - x[first], i, 0 };
            *to++ = (place){ p->t[k], x[k] - x[first], i, 1 / (double)apart };
        }
    }
    r->places = (size_t)(to - r->place);
    line of = { 0 };
    fit_line(p, start, p->line[from].end, &of);
    r->speed = which == 0 ? of.speed : p->line[from].of.speed;
    if (from == at && which == 0)           /* the slide begins on its line, not on its first row's noise */
        r->place->load = of.from + of.speed * (r->place->t - p->t[0] - of.at) - (x[first] - p->start);
    return SS_OK;
}

/* The variance of the end of a line.  Rows tell of it by noise, or if they pass the digits of a sensor in turn. */
static double
end_variance(const path *p, const line *l)
{
    const double n = (double)(l->end - l->first);
    const double turns = p->digit > 0 ? l->speed * (p->t[l->end - 1] - p->t[l->first]) / (n - 1) / p->digit : 0;
    return 4 * p->noise / (p->digit > 0 ? fmax(n * fabs(turns - rint(turns)), 1) : n);
}

/* Take the rows of a step, whose slide begins with line `at`; the next `lines` belong to it. */
static ss_status
take(ss_step *s, track r[2], const path *p, const double *mu, size_t at, size_t lines)
{
    const line *l = &p->line[at];
    const size_t first = middle(p, at), all = l[lines - 1].end - first, apart = all / MOST + 1, n = all / apart;
    size_t still;
    const double digit = digit_of(mu + first, all, &still);
    double *room = calloc(ROOM * n, sizeof *room);
    if (room == NULL)
        return SS_ENOMEM;
    s->n = n;
    s->t = room;
    s->friction = room + n;
    for (size_t i = 0; i < n * apart; i++) {
        const double of[4] = { p->t[first + i], mu[first + i], p->moved[0][first + i] - p->moved[0][first],
                               p->moved[1][first + i] - p->moved[1][first] };
        for (size_t j = 0; j < 4; j++)
            room[j * n + i / apart] += of[j] / (double)apart;
    }
    ss_status st = SS_OK;
    for (int k = 0; st == SS_OK && k < 2; k++) {
        r[k] = (track){ .n = n, .t = s->t, .mu = s->friction, .load = room + (2 + (size_t)k) * n,
                        .changes = lines - 1, .digit = digit,
                        .blur = sqrt(end_variance(p, l) + end_variance(p, l + 1)) };
        for (size_t j = 1; j < lines; j++)
            r[k].change[j - 1] = (l[j].first - first) / apart;
        st = lay(&r[k], p, k, at, apart);
    }
    s->path = r[0].load;
    s->at = p->t[l[1].first];
    s->before = l->speed;
    s->after = l[lines - 1].speed;
    return st;
}

/* What a step does not show is no number. */
static void
forget(ss_value *v)
{
    if (!(v->error < fabs(v->value)))
        *v = (ss_value){ NAN, NAN };
}

/* Fit a step along the first track, or the other one if that is likelier.  Tracks whose squares of differences are
 * less than `same` are one. */
static ss_status
fit_step(ss_step *s, loaded **fit, const track r[2], double same, double stiffness)
{
    double apart = 0, likely[2] = { -INFINITY, -INFINITY };
    loaded *of[2] = { NULL, NULL };
    ss_status st = SS_OK;
    for (size_t i = 0; i < r->n; i++)
        apart = fmax(apart, fabs(r[1].load[i] - r[0].load[i]));
    const int paths = 1 + (apart * apart > same);
    for (int k = 0; st == SS_OK && k < paths; k++)
        st = ss_loaded_new(&of[k], &r[k], of[0], stiffness);
    for (int k = 0; st == SS_OK && k < paths; k++) {
        st = ss_loaded_fit(&of[k], 1);
        if (st == SS_OK)
            st = ss_loaded_report(of[k], s->law, s->t + 4 * r->n);
        for (int i = 0; i < SS_STEP_LAWS; i++)
            likely[k] = fmax(likely[k], s->law[i].log_likelihood);
    }
    const int best = likely[1] > likely[0];
    s->path = r[best].load;
    *fit = of[best];
    ss_loaded_free(of[1 - best]);
    return st;
}

/* By how much slip is likelier than aging. */
static double
slip_ahead(const ss_step *s)
{
    return s->law[SS_STEP_SLIP].log_likelihood - s->law[SS_STEP_AGING].log_likelihood;
}

/* Say which law a step, or all of them, shows.  ahead: see above. */
static void
judge(ss_step *s, double ahead, double stiffness)
{
    for (ss_step_law *l = s->law; l < s->law + SS_STEP_LAWS; l++) {
        forget(&l->direct_effect);
        forget(&l->critical_slip_distance);
        forget(&l->stiffness);
        if (stiffness > 0)
            l->stiffness = (ss_value){ stiffness, 0 };
    }
    s->best = ahead > 0 || isnan(s->law[SS_STEP_AGING].log_likelihood) ? SS_STEP_SLIP : SS_STEP_AGING;
    s->ahead = fabs(ahead);
    const ss_step_law *best = &s->law[s->best];
    s->answer = s->ahead <= LOADED_DECISIVE ? SS_STEP_UNDECIDED : (ss_step_answer)s->best;
    if (s->answer == SS_STEP_UNDECIDED)
        ss_print_to(s->why, sizeof s->why, "the likelihoods differ by a factor of e^%.2g only", s->ahead);
    if (isnan(best->direct_effect.value)) {
        s->answer = SS_STEP_UNDECIDED;
        ss_print_to(s->why, sizeof s->why, "the direct effect is less than its error");
    }
    if (!(best->gain > 2 * LOADED_DECISIVE)) {
        s->answer = SS_STEP_NONE;
        ss_print_to(s->why, sizeof s->why, "friction is a straight line along the path, but for noise");
    }
}

/* --- a record ------------------------------------------------------------------------------ */

/* Fit the steps of a path, each by itself; shared: then all of them by the same numbers. */
static ss_status
fit_steps(ss_steps *out, const path *p, const double *mu, double stiffness, int shared)
{
    track (*record)[2] = calloc(p->lines + 1, sizeof *record);
    loaded **fit = calloc(p->lines + 1, sizeof *fit);
    out->step = calloc(p->lines + 1, sizeof *out->step);
    ss_status st = out->step != NULL && record != NULL && fit != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0, lines; st == SS_OK && i + 1 < p->lines; i += lines - 1) {
        const line *l = &p->line[i];
        int holds = fabs(l[1].speed) < STILL * fabs(l[0].speed) && i + 2 < p->lines;
        lines = holds ? 3 : 2;
        if (!(l->speed > 0) || (i > 0 && fabs(l->speed) < STILL * fabs(l[-1].speed)))
            continue;
        const size_t k = out->n++;
        st = take(&out->step[k], record[k], p, mu, i, lines);
        if (st == SS_OK)
            st = fit_step(&out->step[k], &fit[k], record[k], SIGMAS * SIGMAS * p->noise + p->rounding, stiffness);
    }
    if (st == SS_OK && shared && out->n > 0)
        st = ss_loaded_fit(fit, out->n);
    double all = 0;
    for (size_t k = 0; k < out->n; k++) {
        ss_step *s = &out->step[k];
        if (st == SS_OK)
            st = ss_loaded_report(fit[k], s->law, s->t + 4 * s->n);
        all += slip_ahead(s);
        ss_loaded_free(fit[k]);
        free(record[k][0].place);
        free(record[k][1].place);
    }
    for (size_t k = 0; st == SS_OK && k < out->n; k++)
        judge(&out->step[k], shared ? all : slip_ahead(&out->step[k]), stiffness);
    free(fit);
    free(record);
    return st;
}

ss_status
ss_steps_find(ss_steps **out, const ss_signal *signal, size_t load, size_t friction, const ss_steps_opts *opts,
              ss_error *err)
{
    ss_steps_opts o;
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    ss_status st = ss_options_take(&o, sizeof o, &defaults, opts, err);
    if (st != SS_OK)
        return st;
    const size_t n = signal->n, columns = signal->head->n_columns;
    if (load >= columns || friction >= columns || o.normal >= (int)columns)
        return ss_fail_column(err, load >= columns ? load : friction >= columns ? friction : (size_t)o.normal,
                              columns);
    if (!(o.stiffness >= 0) || isinf(o.stiffness))
        return ss_fail(err, SS_EINVAL, "a stiffness of %g 1/m is out of range", o.stiffness);
    const ss_column *of = &signal->head->column[load];
    const char *named = *of->unit != '\0' ? of->unit : ss_unit_of_name(of->name, NULL);
    const double unit = ss_unit_in_si(named, 'm');
    if (unit == 0)
        return ss_fail(err, SS_EDATA, "column %s: '%.40s' is not a unit of length, as m, mm or um is", of->name,
                       named);
    double *x = malloc((2 * n + 1) * sizeof *x), *mu = x + n;
    path p = { .t = signal->values + (columns - 1) * n, .x = x, .n = n };
    ss_steps *made = calloc(1, sizeof *made);
    st = x != NULL && made != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        x[i] = unit * signal->values[load * n + i];
        mu[i] = signal->values[friction * n + i] / (o.normal >= 0 ? signal->values[(size_t)o.normal * n + i] : 1);
        if (!isfinite(x[i] + mu[i]))
            st = ss_fail(err, SS_EDATA, "row %zu: path or friction is not a finite number", i + 1);
    }
    for (size_t i = 0, back = st == SS_OK && n > 0 && x[n - 1] < x[0]; back && i < n; i++)
        x[i] = -x[i];           /* the slide goes forwards */
    if (st == SS_OK && n >= 2 * LEAST)
        st = find_lines(&p);
    if (st == SS_OK)
        st = fit_steps(made, &p, mu, o.stiffness, o.shared);
    if (st == SS_OK && made->n == 0)
        st = ss_fail(err, SS_EDATA, "the speed of column %s has no step behind a steady slide", of->name);
    free(p.sum);
    free(p.line);
    free(p.moved[0]);
    free(p.corner[0]);
    gsl_interp_free(p.curve);
    free(x);
    if (st == SS_OK)
        *out = made;
    else
        ss_steps_free(made);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

void
ss_steps_free(ss_steps *steps)
{
    for (size_t i = 0; steps != NULL && i < steps->n; i++)
        free(steps->step[i].t);
    if (steps != NULL)
        free(steps->step);
    free(steps);
}

/* --- writing ------------------------------------------------------------------------------- */

static void
write_answer(struct rows *rows, const ss_step *s)
{
    char answer[256], ahead[SS_NUMBER_MAX];
    if (s->answer == SS_STEP_NONE || s->answer == SS_STEP_UNDECIDED)
        snprintf(answer, sizeof answer, "%s: %s", s->answer == SS_STEP_NONE ? "none of these" : "cannot tell", s->why);
    else
        snprintf(answer, sizeof answer, "%s is likelier by a factor of e^%s", s->law[s->best].name,
                 ss_number_rounded(ahead, s->ahead, 2));
    ss_rows_whole_word(rows, "answer", answer);
}

static void
write_row(struct rows *rows, size_t rank, const ss_step *s, size_t law)
{
    const ss_step_law *l = &s->law[law];
    ss_rows_count(rows, "rank", rank);
    ss_rows_word(rows, "law", s->law[law].name);
    ss_rows_rounded(rows, "log_likelihood", "", l->log_likelihood, 10);
    ss_rows_value(rows, "direct_effect", "", l->direct_effect);
    ss_rows_value(rows, "evolution_effect", "", l->evolution_effect);
    ss_rows_value(rows, "critical_slip_distance", "m", l->critical_slip_distance);
    ss_rows_value(rows, "stiffness", "1/m", l->stiffness);
    ss_rows_value(rows, "drift", "1/m", l->drift);
    ss_rows_rounded(rows, "step", "s", s->at, 9);
    ss_rows_rounded(rows, "before", "m/s", s->before, 3);
    ss_rows_rounded(rows, "after", "m/s", s->after, 3);
    if (!rows->format->has_notes)
        write_answer(rows, s);
    ss_rows_end(rows);
}

ss_status
ss_steps_write(const ss_steps *steps, FILE *out, ss_format format, ss_error *err)
{
    enum { DIGITS = 6 };
    struct rows rows;
    if (steps == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_rows_begin(&rows, out, format, SS_KIND_RANKING, err);
    if (st != SS_OK)
        return st;
    for (size_t i = 0; i < steps->n && rows.format->has_notes; i++) {
        const ss_step *s = &steps->step[i];
        const ss_step_law *best = &s->law[s->best];
        char at[SS_NUMBER_MAX], before[SS_NUMBER_MAX], after[SS_NUMBER_MAX];
        ss_rows_note(&rows, "step: at %s s, from %s to %s m/s", ss_number_rounded(at, s->at, 9),
                     ss_number_rounded(before, s->before, 3), ss_number_rounded(after, s->after, 3));
        write_answer(&rows, s);
        ss_rows_note_value(&rows, "direct_effect", best->direct_effect, "", DIGITS);
        ss_rows_note_value(&rows, "evolution_effect", best->evolution_effect, "", DIGITS);
        ss_rows_note_value(&rows, "critical_slip_distance", best->critical_slip_distance, "m", DIGITS);
        ss_rows_note_value(&rows, "stiffness", best->stiffness, "1/m", DIGITS);
        ss_rows_note_value(&rows, "drift", best->drift, "1/m", DIGITS);
    }
    write_row(&rows, 0, &steps->step[0], 0);
    for (size_t i = 0; i < steps->n; i++)
        for (size_t rank = 0; rank < SS_STEP_LAWS; rank++)
            write_row(&rows, rank + 1, &steps->step[i], rank == 0 ? steps->step[i].best : 1 - steps->step[i].best);
    return ss_rows_finish(&rows, err);
}
