/* cover_backbone.c -- do the bands of ss_backbone_find hold, and does it name the right mechanism?
 *
 * Decays of six mechanisms by tests/decay.c, which has no code of the library: parameters, sampling (8 to 200 points
 * a period), start and noise are drawn.  The truth of a row is that of the turns of the simulated motion.
 * A row a mechanism and noise level (amplitude at the start over the noise's standard deviation), then one a
 * disturbance at 40 dB over all mechanisms, of those that close modes and a modulation have time to beat twice:
 * records, rows, the share of damping ratios and of frequencies within 1 and 2 of their errors, the median and rms
 * relative error of the damping ratio in percent; of records how many were named rightly, not told, other, and
 * wrongly; and the share of the numbers of laws that are named rightly within 1 and 2 of their errors.
 * usage: cover_backbone [RECORDS [SEED [CONDITION]]] */
#include <complex.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "fit/backbone.h"
#include "chance.h"
#include "../decay.h"

enum { CLEAN, HUM, DRIFT, OFFSET, CLIPPING, HAMMER, SECOND, CLOSE, MODULATED, CONDITIONS };
static const char *const condition_names[] = { "none", "hum", "drift", "offset", "clipping", "hammer", "second mode",
    "a mode 2 % apart", "modulated" };

static decay
draw(ss_mechanism kind)
{
    decay of = { .w = 2 * PI * between(5, 500), .amplitude = 1 };
    int viscous = kind == SS_JENKINS || kind == SS_MICROSLIP;
    if (kind == SS_VISCOUS)
        of.zeta = between(.003, .05);
    if (kind == SS_COULOMB_DAMPING)
        of.drag = between(.004, .04);
    if (kind == SS_VISCOUS_AND_COULOMB) {
        of.zeta = between(.004, .02);
        of.drag = between(.4, 1.6) * PI / 2 * of.zeta * between(.1, .6);
    }
    if (kind == SS_QUADRATIC)
        of.quadratic = 3 * PI / 4 * between(.005, .05);
    if (viscous)
        of.zeta = between(.001, .005);
    if (kind == SS_JENKINS) {
        of.sliders = 1;
        of.kappa[0] = between(.03, .3);
        of.d[0] = between(.08, .4);
    }
    if (kind == SS_MICROSLIP) {
        double chi = -.8 + .7 * uniform(), sum = 0, most = between(.03, .2);
        of.sliders = DECAY_SLIDERS;
        for (size_t i = 0; i < of.sliders; i++) {
            of.d[i] = 3 * powl(10, -5 * (long double)i / (long double)of.sliders);
            sum += (double)(of.kappa[i] = powl(of.d[i], chi + 1));
        }
        for (size_t i = 0; i < of.sliders; i++)
            of.kappa[i] *= most / sum;
    }
    return of;
}

typedef struct score {
    size_t records, rows, in[4], named[4], numbers, known[2];
    double *error, square;
    size_t room;
} score;

static int
compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void
disturb(double *x, size_t n, size_t first, double per_period, int condition)
{
    double phase = 2 * PI * uniform();
    if (condition == HUM) {
        double by = between(.05, 3) / per_period * 2 * PI, a = between(.003, .03);
        while (fabs(by * per_period / (2 * PI) - round(by * per_period / (2 * PI))) < .15 || by > 2.8)
            by = between(.05, 3) / per_period * 2 * PI;
        for (size_t i = 0; i < n; i++)
            x[i] += a * cos(by * (double)i + phase);
    } else if (condition == DRIFT) {
        double a = between(.02, .3), turns = 2 * PI * between(.3, 1) / (double)n;
        for (size_t i = 0; i < n; i++)
            x[i] += a * cos(turns * (double)i + phase);
    } else if (condition == OFFSET) {
        double a = between(.1, 10);
        for (size_t i = 0; i < n; i++)
            x[i] += a;
    } else if (condition == CLIPPING) {
        double top = between(.5, .9);
        for (size_t i = 0; i < n; i++)
            x[i] = fmax(fmin(x[i], top), -top);
    } else if (condition == HAMMER) {
        double a = between(.3, 3), length = between(.05, .3) * per_period;
        for (size_t i = first; i < n && (double)(i - first) < length; i++)
            x[i] += a * sin(PI * ((double)(i - first) + .5) / length);
    } else if (condition == SECOND) {
        double a = between(.05, .4), zeta = between(.003, .02), by = 2 * PI / per_period * (uniform() < .5 ? 1.3 : 1 / 1.3);
        for (size_t i = first; i < n; i++)
            x[i] += a * exp(-zeta * by * (double)(i - first)) * cos(by * (double)(i - first) + phase);
    }
    else if (condition == CLOSE) {
        double a = between(.2, .8), zeta = between(.003, .01), by = 2 * PI / per_period * 1.02;
        for (size_t i = first; i < n; i++)
            x[i] += a * exp(-zeta * by * (double)(i - first)) * cos(by * (double)(i - first) + phase);
    } else if (condition == MODULATED) {
        double a = between(.05, .3), by = 2 * PI / per_period / between(10, 30);
        for (size_t i = first; i < n; i++)
            x[i] *= 1 + a * cos(by * (double)(i - first) + phase);
    }
}

static int verbose;

/* ln of the fundamental of x at sample `at`: of sums over 3 and 4 periods, weighed by (1 + cos)^2: a bend of
 * it adds to each as the square of its length does. */
static double complex
fundamental(const double *x, double at, double w)
{
    double complex z[2];
    for (int i = 0; i < 2; i++) {
        double half = (3 + i) * PI / w;
        double complex sum = 0;
        for (double k = ceil(at - half); k < at + half; k++)
            sum += x[(size_t)k] * pow(1 + cos(PI * (k - at) / half), 2) * cexp(-I * w * (k - at));
        z[i] = clog(sum / half);
    }
    z[1] -= 2 * PI * I * round(cimag(z[1] - z[0]) / (2 * PI));
    return z[0] + (z[0] - z[1]) * 9 / 7;
}

/* What the rows should say at a sample: where friction does not change the stiffness the undamped frequency is
 * that of the spring.  0: too near to an end. */
static int
truth(const decay *of, const decay_turn *turn, size_t turns, const double *x, size_t n, double at, double rate, double *f,
      double *zeta, double *amplitude)
{
    if (!decay_truth(turn, turns, (long double)(at / rate), f, zeta, amplitude))
        return 0;
    if (of->sliders == 0) {
        *f = (double)of->w / (2 * PI);
        return 1;
    }
    double w = 2 * PI * *f / rate, h = PI / w;
    double complex z[5];
    if (at < 6 * PI / w + 1 || at + 6 * PI / w + 1 >= (double)n)
        return 0;
    for (int i = 0; i < 5; i++)
        z[i] = fundamental(x, at + (i - 2) * h, w);
    for (int i = 1; i < 5; i++)
        z[i] += 2 * PI * I * round((cimag(z[i - 1]) + PI - cimag(z[i])) / (2 * PI));
    double complex slope = (8 * (z[3] - z[1]) - (z[4] - z[0])) / 12 / h;
    double curvature = (creal(z[3]) - 2 * creal(z[2]) + creal(z[1])) / h / h, s = -creal(slope);
    *f = sqrt(cimag(slope) * cimag(slope) + s * s - curvature) * rate / (2 * PI);
    *zeta = s / hypot(s, cimag(slope));
    return 1;
}

/* What a number of a law should be; those of microslip have no closed form. */
static double
true_number(const decay *of, const char *name)
{
    const struct { const char *name; long double value; } is[] = {
        { "frequency", of->w / 2 / PI }, { "damping_ratio", of->zeta }, { "friction_over_stiffness", of->drag },
        { "drag_over_mass", of->quadratic }, { "contact_stiffness_ratio", of->kappa[0] }, { "slip_amplitude", of->d[0] } };
    size_t i = 0;
    while (strcmp(is[i].name, name) != 0)
        i++;
    return (double)is[i].value;
}

static void
run(score *s, ss_mechanism kind, double decibels, int condition)
{
    decay of = draw(kind);
    double per_period = between(8, 200), rate = per_period * (double)of.w / (2 * PI), noise = pow(10, -decibels / 20);
    double beats = condition == CLOSE ? 100 : condition == MODULATED ? 60 : 0;
    size_t n = (size_t)(per_period * 400), before = uniform() < .3 ? (size_t)(per_period * between(3, 30)) : 0, turns;
    double *y = malloc(n * sizeof *y);
    decay_turn *turn = decay_run(&of, 1 / (long double)rate, n, y, NULL, NULL, &turns);
    size_t seen = 0;
    while (seen < turns && fabsl(turn[seen].x) > noise / 2 + of.drag)
        seen++;
    if (seen < turns)
        n = (size_t)fmin((double)n, (double)(turn[seen].t * rate) + per_period * between(2, 60));
    if (seen / 2. < beats) {                    /* it is gone before it can beat twice */
        free(y);
        free(turn);
        return;
    }
    ss_header *head = NULL;
    ss_signal *signal = NULL;
    ss_backbone *b = NULL;
    ss_error err = { 0 };
    if (ss_header_new(&head, rate, 0, &err) != SS_OK || ss_header_add_column(head, "x", "m", &err) != SS_OK
        || ss_signal_new(&signal, head, n + before, &err) != SS_OK)
        exit(1);
    for (size_t i = 0; i < n + before; i++)
        signal->values[i] = i < before ? 0 : y[i - before];
    if (condition != CLIPPING)
        disturb(signal->values, n + before, before, per_period, condition);
    for (size_t i = 0; i < n + before; i++)
        signal->values[i] += noise * gauss();
    if (condition == CLIPPING)
        disturb(signal->values, n + before, before, per_period, condition);
    if (getenv("DUMP"))
        for (size_t i = 0; i < n + before; i++)
            printf("%.17g\n", signal->values[i]);
    if (ss_backbone_find(&b, signal, 0, NULL, &err) != SS_OK) {
        fprintf(stderr, "%s\n", err.text);
        exit(1);
    }
    s->records++;
    if (verbose)
        printf("# named %s chi2 %.2f, %s %zu blocks, %.1f points a period, f %.6g, stop: %s, why %s\n",
               b->n_mechanisms == 1 ? ss_mechanism_names[b->mechanism[0]] : "none", b->chi2_dof, ss_mechanism_names[kind], b->n,
               per_period, (double)of.w / 2 / PI, b->stop, b->why ? b->why : "-");
    for (size_t i = 0; i < b->n; i++) {
        const ss_backbone_row *r = &b->row[i];
        double f, zeta, amplitude;
        if (!truth(&of, turn, turns, y, n, r->t * rate - (double)before, rate, &f, &zeta, &amplitude))
            continue;
        double z = fabs(r->damping_ratio.value - zeta) / r->damping_ratio.error;
        double zf = fabs(r->frequency.value - f) / r->frequency.error;
        if (verbose)
            printf("%.4g %.4g %.4g  zeta %.5g %.5g err %.2g  z %.2f   f %.8g %.8g z %.2f\n", r->t, r->periods, r->amplitude / amplitude,
                   r->damping_ratio.value, zeta, r->damping_ratio.error, z, r->frequency.value, f, zf);
        s->in[0] += z <= 1, s->in[1] += z <= 2, s->in[2] += zf <= 1, s->in[3] += zf <= 2;
        if (s->rows == s->room)
            s->error = realloc(s->error, (s->room = 2 * s->room + 1000) * sizeof *s->error);
        s->error[s->rows] = fabs(r->damping_ratio.value / zeta - 1);
        s->square += s->error[s->rows] * s->error[s->rows];
        s->rows++;
    }
    int right = 0;
    size_t *named = &s->named[b->n_mechanisms == 0 ? 2 : b->n_mechanisms > 1 ? 1 : 0];
    for (size_t i = 0; i < b->n_mechanisms; i++)
        right |= b->mechanism[i] == kind;
    if (b->n_mechanisms == 1 && !right)
        named = &s->named[3];
    if (condition >= CLOSE && b->n_mechanisms > 0)
        named = &s->named[b->n_mechanisms > 1 ? 1 : 3];
    (*named)++;
    for (size_t i = 0; i < b->n_numbers && named == s->named && kind != SS_MICROSLIP; i++) {
        double z = fabs(b->number[i].value.value - true_number(&of, b->number[i].name)) / b->number[i].value.error;
        s->numbers++, s->known[0] += z <= 1, s->known[1] += z <= 2;
    }
    ss_backbone_free(b);
    ss_signal_free(signal);
    ss_header_free(head);
    free(turn);
    free(y);
}

static void
print(const char *what, const char *level, score *s)
{
    double n = (double)s->rows / 100;
    qsort(s->error, s->rows, sizeof *s->error, compare);
    printf("| %s | %s | %zu | %zu | %.0f | %.0f | %.0f | %.0f | %.2f | %.2f | %zu | %zu | %zu | %zu | %.0f | %.0f |\n", what, level, s->records,
           s->rows, (double)s->in[0] / n, (double)s->in[1] / n, (double)s->in[2] / n, (double)s->in[3] / n,
           s->rows > 0 ? 100 * s->error[s->rows / 2] : NAN, 100 * sqrt(s->square / (double)s->rows), s->named[0], s->named[1],
           s->named[2], s->named[3], 100. * (double)s->known[0] / (double)s->numbers,
           100. * (double)s->known[1] / (double)s->numbers);
    fflush(stdout);
    free(s->error);
}

int
main(int argc, char *argv[])
{
    size_t records = argc > 1 ? strtoul(argv[1], NULL, 10) : 20, seed = argc > 2 ? strtoul(argv[2], NULL, 10) : 1;
    int only = argc > 3 ? atoi(argv[3]) : -1, of = argc > 4 ? atoi(argv[4]) : -1;
    double db = argc > 5 ? atof(argv[5]) : 0;
    verbose = argc > 6;
    static const double levels[] = { 60, 40, 25, 20 };
    printf("| mechanism | dB | records | rows | damping <= 1 | <= 2 | frequency <= 1 | <= 2 | median | rms | right "
           "| not told | other | wrong | numbers <= 1 | <= 2 |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int c = 0; c < CONDITIONS; c++)
        for (int k = 0; k < SS_MECHANISMS && (only < 0 || only == c); k++)
            for (int l = 0; l < 4; l++) {
                score s = { 0 };
                char level[16];
                if ((of >= 0 && of != k) || (db > 0 && levels[l] != db) || (c != CLEAN && (k > 0 || levels[l] != 40)))
                    continue;
                for (size_t i = 0; i < records; i++)
                    for (int m = 0; m < (c == CLEAN ? 1 : SS_MECHANISMS); m++) {
                        chance = (seed + i) * 0xbf58476d1ce4e5b9u + (uint64_t)(100 * c + 10 * (k + m) + l) * 0x94d049bb133111ebu;
                        run(&s, (ss_mechanism)(k + m), levels[l], c);
                    }
                snprintf(level, sizeof level, "%g", levels[l]);
                print(c == CLEAN ? ss_mechanism_names[k] : condition_names[c], level, &s);
            }
    return 0;
}
