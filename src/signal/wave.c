/* wave.c -- benchmark signals.
 *
 * The error of a phase of 1e6 cycles in one double is 1e-10 cycles.  So times and phases are kept
 * in two doubles (Dekker 1971) until whole cycles are subtracted; the error is then 1e-16 cycles
 * in a record of any length. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/options.h"
#include "signal/header.h"
#include "signal/noise.h"

const ss_wave_opts ss_wave_defaults = {
    .size = sizeof(ss_wave_opts), .rate = 2000, .duration = 10, .amplitude = 1, .frequency = 10, .frequency_end = 100,
    .damping = 0.05, .at = 0, .seed = 1
};

SS_OPTIONS(ss_wave_opts, ss_wave_defaults)

struct twofold {
    double hi, lo;              /* hi + lo, |lo| <= ulp(hi) / 2 or so */
};

static struct twofold
add(struct twofold a, double b)
{
    double sum = a.hi + b, part = sum - a.hi;
    return (struct twofold){ sum, (a.hi - (sum - part)) + (b - part) + a.lo };
}

static struct twofold
multiply(struct twofold a, struct twofold b)
{
    double p = a.hi * b.hi;
    return (struct twofold){ p, fma(a.hi, b.hi, -p) + (a.hi * b.lo + a.lo * b.hi) };
}

static struct twofold
divide(struct twofold a, double b)
{
    double q = a.hi / b;
    return (struct twofold){ q, (fma(-q, b, a.hi) + a.lo) / b };
}

static struct twofold
single(double x)
{
    return (struct twofold){ x, 0 };
}

/* cos(2 pi cycles) */
static double
cosine(struct twofold cycles)
{
    double rest = cycles.hi - rint(cycles.hi);          /* exact */
    rest += cycles.lo - rint(cycles.lo);
    return cos(2 * M_PI * rest);
}

/* Sample i of a signal without noise. */
static double
sample(ss_wave wave, const ss_wave_opts *o, size_t i)
{
    struct twofold t = divide(single((double)i), o->rate), since = add(t, -o->at);
    struct twofold turned = multiply(since, single(o->frequency));
    int begun = t.hi >= o->at;                  /* t.hi is the time that is printed */
    double decay = 2 * M_PI * o->frequency * o->damping / sqrt(1 - o->damping * o->damping);
    struct twofold slope = add(single(o->frequency_end), -o->frequency);
    struct twofold mean = add(multiply(divide(slope, 2 * o->duration), t), o->frequency);      /* since the start */
    switch (wave) {
    case SS_SINE:     return o->amplitude * cosine(turned);
    case SS_IMPULSE:  return (double)i == round(o->at * o->rate) ? o->amplitude : 0;
    case SS_STEP:     return begun ? o->amplitude : 0;
    case SS_CHIRP:    return o->amplitude * cosine(multiply(mean, t));
    case SS_RINGDOWN: return begun ? o->amplitude * exp(-decay * since.hi) * cosine(turned) : 0;
    case SS_NOISE:    break;
    }
    return 0;
}

/* The fault of the options, or NULL. */
static const char *
refuse_opts(ss_wave wave, const ss_wave_opts *o)
{
    if ((unsigned)wave > SS_NOISE)
        return "no such kind of signal";
    if (!(o->rate >= RATE_MIN && o->rate <= RATE_MAX))
        return "rate must be in " RATE_RANGE;
    if (!(o->duration >= 0 && o->duration * o->rate < (double)(SIZE_MAX / 64)))
        return "duration must be at least 0, and duration x rate a number of samples that fits";
    if (!isfinite(o->amplitude) || !isfinite(o->at))
        return "amplitude and at must be finite";
    if (!(o->frequency >= 0 && o->frequency_end >= 0 && isfinite(o->frequency + o->frequency_end)))
        return "frequencies must be at least 0 and finite";
    if (!(o->damping >= 0 && o->damping < 1))
        return "damping must be in [0, 1)";
    return NULL;
}

ss_status
ss_wave_new(ss_signal **out, ss_wave wave, const ss_wave_opts *given, ss_error *err)
{
    ss_wave_opts own;
    const ss_wave_opts *opts = &own;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    if (ss_options_take(&own, sizeof own, &ss_wave_defaults, given, err) != SS_OK)
        return SS_EINVAL;
    const char *wrong = refuse_opts(wave, opts);
    if (wrong != NULL)
        return ss_fail(err, SS_EINVAL, "%s", wrong);
    ss_header *head = NULL;
    ss_header_new(&head, opts->rate, 0, NULL);
    ss_status st = head != NULL ? ss_header_add_column(head, "a", "", NULL) : SS_ENOMEM;
    if (st == SS_OK)
        st = ss_signal_new(out, head, (size_t)round(opts->duration * opts->rate), NULL);
    ss_header_free(head);
    if (st == SS_ENOMEM)
        return ss_fail(err, st, "%s for %.3g samples, which is duration x rate = %g s x %g Hz",
                       ss_strerror(st), opts->duration * opts->rate, opts->duration, opts->rate);
    if (st == SS_OK && wave == SS_NOISE)
        st = ss_noise_add_once((*out)->values, (*out)->n, fabs(opts->amplitude), opts->seed, NULL);
    double zero = 0;                    /* NaN once a value is not finite */
    for (size_t i = 0; st == SS_OK && wave != SS_NOISE && i < (*out)->n; i++) {
        (*out)->values[i] = sample(wave, opts, i);
        zero += 0 * (*out)->values[i];
    }
    if (st == SS_OK && zero == 0)
        return SS_OK;
    ss_signal_free(*out);
    *out = NULL;
    st = st == SS_OK ? SS_ERANGE : st;
    return ss_fail(err, st, "%s", ss_strerror(st));
}
