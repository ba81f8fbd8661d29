/* verdict.c -- when a fit explains a record, when it is as good as another, what is then said; and the order of
 * scenes in a ranking.
 *
 * * Scenes are fitted to all samples: one explains them if it leaves no more than noise.
 *
 * * A law is judged by what it leaves where it was not fitted.  Part of that is noise, one number for all laws; the
 * rest is the law's own error.  A real contact is no law, so the best may have such an error; but by a law that is
 * wrong by so much nobody can tell another that is hardly worse.  Of the laws as good as the best the simplest is
 * named, if all others contain it.
 *
 * * The best law is none if what it leaves is no noise, by two errors: then a law is missing. */
#include "fit/verdict.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/record.h"

#define AS_GOOD 0.03                /* of the least loss, or of the noise: laws that differ by less are as good */
#define ALIKE 0.5                   /* of the best law's error: laws whose errors differ by less are as good */
#define EXPLAINED 0.8               /* of the power, by a law that is named */
#define QUIET (FAINT * FAINT)       /* of the power: sensors are linear to so much */

/* A residual is noise if its mean square is at most ALLOWED times the noise, plus three standard errors
 * of the estimate of the noise, which is some 2.3 / sqrt n: it rests on medians of n numbers, two of
 * which may share a sample. */
#define ALLOWED 1.2
#define UNCERTAIN (3 * 2.3)

double
ss_residue_excess(const residue *r, double noise)
{
    return r->left / fmax(fmin(noise, r->white), RESIDUE_QUIET * r->power);
}

int
ss_residue_explains(const residue *r, double noise)
{
    return r->compared > 0 && ss_residue_excess(r, noise) <= ALLOWED * (1 + UNCERTAIN / sqrt(r->compared));
}

double
ss_residue_lead(const residue *r, const residue *other, double noise)
{
    return r->compared * (ss_residue_excess(other, noise) - ss_residue_excess(r, noise));
}

int
ss_residue_equals(const residue *r, const residue *other, double noise)
{
    return ss_residue_explains(r, noise) && ss_residue_lead(other, r, noise) < RESIDUE_DECISIVE;
}

/* --- laws ---------------------------------------------------------------------------------- */

double
ss_verdict_error(const double a[BLOCKS], const double b[BLOCKS])
{
    double sum = 0, squares = 0;
    for (size_t k = 0; k < BLOCKS; k++) {
        double x = a[k] - (b != NULL ? b[k] : 0);
        sum += x;
        squares += x * x;
    }
    return sqrt(fmax(squares - sum * sum / BLOCKS, 0) * BLOCKS / (BLOCKS - 1));
}

void
ss_verdict_append(char *text, size_t room, const char *word)
{
    size_t n = strlen(text);
    snprintf(text + n, room - n, "%s%s", n > 0 ? ", " : "", word);
}

ss_verdict
ss_verdict_find(char *answer, size_t room, candidate c[], size_t n, double power, size_t *best)
{
    char names[128] = "", others[128] = "", number[SS_NUMBER_MAX], times[SS_NUMBER_MAX];
    double noise = INFINITY;
    size_t count = 0, simplest = 0;
    unsigned fit = 0;
    *best = 0;
    for (size_t i = 0; i < n; i++) {
        *best = i == 1 || c[i].left < c[*best].left ? i : *best;
        noise = fmin(noise, c[i].noise);
    }
    const candidate *most = &c[*best];
    noise = fmax(fmin(noise, most->rough), QUIET);
    const double own = fmax(AS_GOOD * fmax(most->left, noise), ALIKE * (most->left - noise));
    for (size_t i = 0; i <= n; i++) {
        const double more = c[i].left - most->left, error = ss_verdict_error(c[i].block, most->block) / power;
        c[i].tied = more <= own || more <= fmax(2 * fmin(error, most->left / 2), RESIDUE_QUIET);
        c[i].excess = c[i].fitted / noise;
        fit |= c[i].tied ? c[i].law : 0;
    }
    for (size_t i = 0; i < n; i++)
        if ((c[i].law & fit) != 0 && (c[i].contains & fit) == 0) {
            simplest = count++ == 0 ? i : simplest;
            ss_verdict_append(names, sizeof names, c[i].name);
        } else if ((c[i].law & fit) != 0)
            ss_verdict_append(others, sizeof others, c[i].name);
    ss_number_fixed(number, 1 - most->left, 4);
    if (!(most->left < 1)) {
        snprintf(answer, room, "none of these: no law explains any of the force that was held out");
        return SS_NONE_FITS;
    }
    const double surely = 1 - 2 * ss_verdict_error(most->block, NULL) / (most->left * power);
    const char *fault = c[0].tied ? "no law explains more than the null"
        : c[n].tied ? "no law explains more than a spring of any shape and a damper"
        : 1 - most->left < EXPLAINED ? "too little is explained"
        : most->work < LITTLE ? "friction is hardly reached"
        : most->excess * surely > LARGER ? "more than noise is left" : NULL;
    if (fault != NULL) {
        snprintf(answer, room, "none of these: %s; %s explains %s of the force that was held out, and leaves %s "
                 "times the noise", fault, most->name, number, ss_number_rounded(times, most->excess, 4));
        return SS_NONE_FITS;
    }
    if (count > 1) {
        snprintf(answer, room, "cannot tell: %s", names);
        return SS_UNDECIDED;
    }
    *best = simplest;
    snprintf(answer, room, "%s explains %s of the force that was held out%s%s, and leaves %s times the noise",
             c[simplest].name, ss_number_fixed(number, 1 - c[simplest].left, 4),
             others[0] != '\0' ? ", no less than " : "", others, ss_number_rounded(times, c[simplest].excess, 4));
    return SS_NAMED;
}

/* --- scenes -------------------------------------------------------------------------------- */

/* A threshold is a difference that can be resolved, not one that was seen in some signal: twice the
 * power; the spread itself; one of two transitions; one wavelet bandwidth, 1/6 of the frequency; twice
 * the damping or stiffness; half the amplitude; one spike; one order of smoothness, jump to kink; one
 * contour. */
const criterion_rule ss_criterion_rules[SS_CRITERIA] = {
    [SS_BY_RESIDUAL]   = { "residual", "dB", 3, 1 },
    [SS_BY_ADJUSTMENT] = { "adjustment", "", 1, 1 },
    [SS_BY_MAXIMUM]    = { "maximum", "", 0.5, 1 },
    [SS_BY_FREQUENCY]  = { "frequency", "Hz", 0.154, 1 },
    [SS_BY_DAMPING]    = { "damping", "", M_LN2, 1 },
    [SS_BY_JUMP]       = { "jump", "dB", 6, 1 },
    [SS_BY_SPIKES]     = { "spikes", "", 1, 1 },
    [SS_BY_SLOPE]      = { "slope", "dB/octave", 6, 1 },
    [SS_BY_STIFFNESS]  = { "stiffness", "N/m", M_LN2, 1 },
    [SS_BY_MAP]        = { "map", "dB", 80. / 18, 0.25 },
};

double
ss_rank_score(const ss_rank_row *row, ss_criterion criterion)
{
    double d = row->distance[criterion];
    return isnan(d) ? 1 : fmin(d / ss_criterion_rules[criterion].threshold, SCORE_MOST);
}

static int
less_first(const void *a, const void *b)
{
    const ss_rank_row *p = a, *q = b;
    if (p->total != q->total)
        return p->total > q->total ? 1 : -1;
    return (p->scene > q->scene) - (p->scene < q->scene);
}

void
ss_ranking_sort(ss_ranking *r)
{
    for (size_t i = 0; i < r->n; i++) {
        r->row[i].total = 0;
        for (int k = 0; k < SS_CRITERIA; k++)
            r->row[i].total += ss_criterion_rules[k].weight * ss_rank_score(&r->row[i], (ss_criterion)k);
    }
    qsort(r->row, r->n, sizeof *r->row, less_first);
}
