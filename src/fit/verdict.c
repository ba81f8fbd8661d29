/* verdict.c -- when a fit explains a record, when it is as good as another, and what is then said.
 *
 * * Scenes are fitted to all samples: one explains them if it leaves no more than noise.
 *
 * * A law is judged by what it leaves where it was not fitted.  Of those as good as the best and not refuted the
 * simplest is named; if another does not contain it, nobody can tell.
 *
 * * A law is refuted if a free law predicts significantly more: then a law is missing.  A real contact is no law;
 * its friction wanders, its rig has play.  Of this a free law predicts no more; but a part of what is left must be
 * noise, or the change from cycle to cycle. */
#include "fit/verdict.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/error.h"
#include "io/record.h"

#define AS_GOOD 0.03                /* of the least loss: laws that differ by less are as good */
#define EXPLAINED 0.8               /* of the power, by a law that is named */
#define BEYOND_NOISE 4              /* times the noise is left: three quarters are an error of the law, */
#define MISSING 2                   /* or half, if a free law predicts significantly more */
#define SIGNIFICANT 3               /* errors */
#define TAKEN 0.1                   /* of its work a friction takes, unless it is hardly reached */
#define QUIET 1e-4                  /* of the power: sensors are linear to a hundredth */

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
ss_verdict_sum(const double a[BLOCKS])
{
    double sum = 0;
    for (size_t k = 0; k < BLOCKS; k++)
        sum += a[k];
    return sum;
}

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

double
ss_verdict_noise(const candidate *c)
{
    return fmax(QUIET, fmin(c->noise, c->rough));
}

/* How many times the noise it leaves. */
static double
excess(const candidate *c)
{
    return fmax(c->fitted / fmax(QUIET, c->noise), c->steady / fmax(QUIET, c->rough));
}

/* How much more a candidate leaves than the best, in errors of the difference. */
static double
errors_behind(const candidate *c, const candidate *best, double power)
{
    double error = ss_verdict_error(c->block, best->block) / power;
    return (c->left - best->left) / fmax(fmin(error, best->left / 2), RESIDUE_QUIET / 2);
}

/* Does it leave more than noise and what a real contact does beside its law, is a law missing, is it a spring, or
 * has it no gap? */
static int
is_refuted(const candidate *c)
{
    return c->work < TAKEN || c->gap <= SIGNIFICANT
        || excess(c) > (c->better > SIGNIFICANT ? MISSING : BEYOND_NOISE);
}

ss_verdict
ss_verdict_find(char *answer, size_t room, candidate c[], size_t n, double power, size_t *best)
{
    char names[128] = "", number[SS_NUMBER_MAX], times[SS_NUMBER_MAX];
    size_t count = 0, simplest = 0;
    unsigned fit = 0;
    *best = 0;
    for (size_t i = 1; i < n; i++)
        *best = c[i].left < c[*best].left ? i : *best;
    const candidate *most = &c[*best];
    for (size_t i = 0; i <= n; i++) {
        c[i].tied = c[i].left - most->left <= AS_GOOD * most->left || errors_behind(&c[i], most, power) <= 2;
        fit |= c[i].tied && !is_refuted(&c[i]) ? c[i].law : 0;
    }
    for (size_t i = 0; i < n; i++)
        if ((c[i].law & fit) != 0 && (c[i].contains & fit) == 0) {
            simplest = i;
            count++;
            ss_verdict_append(names, sizeof names, c[i].name);
        }
    ss_number_fixed(number, 1 - most->left, 4);
    if (!(most->left < 1)) {
        snprintf(answer, room, "none of these: no law explains any of the force that was held out");
        return SS_NONE_FITS;
    }
    if (c[0].tied || c[n].tied || 1 - most->left < EXPLAINED || count == 0) {
        const double beyond = excess(most);
        const int is_noisy = beyond > BEYOND_NOISE;
        int length = snprintf(answer, room, "none of these: %s%s explains %s of the force that was held out",
                              c[0].tied ? "no law explains more than the null; "
                              : c[n].tied ? "no law explains more than a spring of any shape and a damper; " : "",
                              most->name, number);
        ss_number_rounded(times, is_noisy ? beyond : most->better, 3);
        if (count == 0 && most->work < TAKEN)
            snprintf(answer + length, room - (size_t)length, ", but its friction is hardly reached");
        else if (count == 0 && most->gap <= SIGNIFICANT)
            snprintf(answer + length, room - (size_t)length, ", but its gap is not shown to be above 0");
        else if (count == 0)
            snprintf(answer + length, room - (size_t)length, ", but %s %s %s", is_noisy ? "leaves"
                     : "a free law predicts more, by", times, is_noisy ? "times the noise" : "errors");
        return SS_NONE_FITS;
    }
    if (count > 1) {
        snprintf(answer, room, "cannot tell: %s", names);
        return SS_UNDECIDED;
    }
    *best = simplest;
    snprintf(answer, room, "%s explains %s of the force that was held out", c[simplest].name,
             ss_number_fixed(number, 1 - c[simplest].left, 4));
    return SS_NAMED;
}
