/* slip_rate.c -- how many slips a recording has, and how many a second.
 *
 * Transitions are sharp events; not each of them is a slip.  So their number is believed if they repeat with
 * the cycles of the signal, which are found without them.  The falls of a force are slips by themselves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/list.h"
#include "find/medians.h"
#include "find/numbers.h"
#include "signal/gaps.h"

#define EVEN 0.03               /* the same between events of one kind: begins and ends may be nearly even */
#define BARE 0.999              /* likeness of cycles in which noise and hum hide no slip */

#define AWAY (SIGMAS * SURELY)  /* standard deviations: what leaves the band of a rest by less is no motion */
#define RARE 2.5                /* standard deviations: few samples of a rest lie beyond */

typedef struct times {          /* at which slips, or what may be slips, begin [s] */
    double *t;
    size_t n;
} times;

/* --- rests ------------------------------------------------------------------------------------ */

/* While a true stick lasts, velocity and acceleration are zero: the samples lie about one level, within the noise
 * of the record, whatever makes it.  The level is where samples are densest.  A motion that crosses the level does
 * not stop there: it passes the band about the level, and the wider one on either side, evenly.  A rest is as long
 * as it lasts in the band, and short beside it.  What is neither may be a short rest, or an extremum of a motion;
 * so may one whose samples are no noise about the level: it may hide a small motion, too. */

/* Level and standard deviation of the samples that are at rest, from the narrowest interval with LITTLE of all
 * on. */
static ss_status
find_level(const double *x, size_t n, double *level, double *deviation)
{
    enum { PASSES = 12 };
    double *sorted = malloc((n + 1) * sizeof *sorted);
    size_t held = (size_t)(LITTLE * (double)n), best = 0;
    if (sorted == NULL)
        return SS_ENOMEM;
    memcpy(sorted, x, n * sizeof *x);
    qsort(sorted, n, sizeof *sorted, ss_ascending);
    for (size_t i = 0; i + held < n; i++)
        if (sorted[i + held] - sorted[i] < sorted[best + held] - sorted[best])
            best = i;
    const double step = ss_smallest_change(sorted, n);
    *level = sorted[best + held / 2];
    *deviation = fmax(sorted[best + held] - sorted[best], step / 2);
    free(sorted);
    for (int pass = 0; pass < PASSES; pass++) {
        double sum = 0, squares = 0, m = 0;
        for (size_t i = 0; i < n; i++)
            if (fabs(x[i] - *level) <= SURELY * *deviation) {
                sum += x[i] - *level, squares += (x[i] - *level) * (x[i] - *level);
                m++;
            }
        *deviation = fmax(sqrt(fmax(0, squares / m - sum * sum / m / m)), step / 2);
        *level += sum / m;
    }
    return SS_OK;
}

ss_status
ss_rests_find(const double *x, size_t n, ss_rests *out)
{
    double level = 0, deviation = 0;
    *out = (ss_rests){ .rest = calloc(n / 2 + 1, sizeof *out->rest) };
    ss_status st = out->rest != NULL ? find_level(x, n, &level, &deviation) : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        ss_window in = { n, n };
        size_t from = i;
        for (; i < n && fabs(x[i] - level) <= AWAY * deviation; i++)
            if (fabs(x[i] - level) <= SURELY * deviation)
                in = (ss_window){ in.first < i ? in.first : i, i + 1 };
        size_t length = ss_window_length(in), beside = i - from - length;
        ss_window *last = out->n > 0 ? &out->rest[out->n - 1] : NULL;
        if (length >= 3 * beside + 2 && last != NULL && in.first <= last->end + 1)
            last->end = in.end;                 /* a glitch lies between */
        else if (length >= 3 * beside + 2)
            out->rest[out->n++] = in;
        else
            out->is_doubtful |= length >= beside + 2;
    }
    for (size_t i = 0; i < out->n; i++) {
        size_t beyond = 0;      /* more than noise, and a few wrong samples, put there? */
        for (size_t k = out->rest[i].first; k < out->rest[i].end; k++)
            beyond += fabs(x[k] - level) > RARE * deviation;
        out->is_doubtful |= (double)beyond > FEW + 2 * OUTLIERS * (double)ss_window_length(out->rest[i]);
    }
    out->level = level;
    out->band = SURELY * deviation;
    size_t above = 0, below = 0;        /* with none on one side it is the end of a range, where a converter clips */
    for (size_t i = 0; i < n; i++) {
        above += x[i] > level + out->band;
        below += x[i] < level - out->band;
    }
    out->is_end_of_range = (above == 0 || below == 0) && fabs(level) > SLIGHT;
    out->is_doubtful |= out->band > SLIGHT;     /* of the largest sample */
    return st;
}

/* --- slips ------------------------------------------------------------------------------------ */

/* The number of slips in a second, by the mean of the times between them.  Times with a gap are left out: it may
 * hide slips.  The first slip and the last lie anywhere within a sample. */
static ss_value
mean_rate(const search *s, times slip)
{
    double sum = 0, squares = 0, m = 0;
    for (size_t i = 1; i < slip.n; i++) {
        double from = slip.t[i - 1], interval = slip.t[i] - from;
        if (ss_gaps_near(s->gap, s->n_gaps, from + interval / 2, interval / 2))
            continue;
        sum += interval;
        squares += interval * interval;
        m++;
    }
    if (m < 2)
        return unknown;
    double mean = sum / m, scatter = fmax(0, squares / m - mean * mean), sample = 1 / (s->rate * m);
    return (ss_value){ 1 / mean, sqrt(scatter / (m - 1) + sample * sample / 6) / (mean * mean) };
}

/* Do most of the slips come so long before those `step` slips later, to within a part of it? */
static int
recur(const search *s, times slip, size_t step, double time, double within)
{
    size_t good = 0, all = 0;
    for (size_t i = 0; i + step < slip.n; i++) {
        double passed = slip.t[i + step] - slip.t[i];
        if (ss_gaps_near(s->gap, s->n_gaps, slip.t[i] + passed / 2, passed / 2))
            continue;
        all++;
        good += fabs(passed / time - 1) <= within;
    }
    return all >= 2 && (double)good >= MOSTLY * (double)all;
}

/* The number of slips in a cycle, after which a period has passed.  0: they do not repeat with the cycle. */
static size_t
slips_in_cycle(const search *s, times slip)
{
    double period = 1 / s->out->number[SS_REPETITION_FREQUENCY].value,
        each = round(mean_rate(s, slip).value * period);
    return each >= 1 && each < (double)slip.n && recur(s, slip, (size_t)each, period, JITTER) ? (size_t)each : 0;
}

/* The onsets of the transitions, in memory that is there. */
static times
onsets(const search *s, double *t)
{
    for (size_t i = 0; i < s->out->n; i++)
        t[i] = s->out->transition[i].onset;
    return (times){ t, s->out->n };
}

/* The least number of slips in a cycle: one, but two if its second half mirrors the first. */
static size_t
least_in_cycle(const search *s)
{
    return s->cycles.symmetry < -CYCLES_ALIKE ? 2 : 1;
}

/* Keep the transitions that ring, and those that stand alone.  A contact rings while it sticks: an event that does
 * not ring and stands beside one that does, nearer than most of the time between slips, is an end of this stick,
 * or a micro-slip. */
static void
keep_ringing(search *s)
{
    ss_features *out = s->out;
    double apart = MOSTLY / (out->number[SS_REPETITION_FREQUENCY].value * (double)least_in_cycle(s));
    size_t kept = 0;
    for (size_t i = 0; i < out->n; i++) {
        const ss_transition *tr = &out->transition[i], *last = &out->transition[kept - (kept > 0)];
        size_t next = i;
        while (next < out->n && isnan(out->transition[next].from))
            next++;
        int is_beside = (kept > 0 && tr->onset - last->onset < apart)
            || (next < out->n && out->transition[next].onset - tr->onset < apart);
        if (!isnan(tr->from) || !is_beside)
            out->transition[kept++] = *tr;
    }
    out->n = kept;
}

/* May some of the events be no slips, but ends of sticks, or micro-slips, or may slips be missing?  Events at
 * equal distances are all of one kind, but in a half-cycle that mirrors the other: there a slip begins and ends.
 * Where nothing rings anew with each, weak slips hide in noise or a hum. */
static int
is_doubtful(const search *s, times event, size_t each)
{
    const double rate = s->out->number[SS_REPETITION_FREQUENCY].value;
    size_t least = least_in_cycle(s);
    return (each != least && (least > 1 || !recur(s, event, 1, 1 / ((double)each * rate), EVEN)))
        || (isnan(s->out->number[SS_TRANSITION_FREQUENCY].value) && !s->out->reverses
            && !(s->cycles.likeness >= BARE));
}

void
ss_loadings_forget(ss_features *out)
{
    free(out->loading);
    out->loading = NULL;
    for (int k = 0; k < SS_FEATURE_NUMBERS; k++)
        if (ss_feature_numbers[k].needs & OF_EVENTS)
            out->number[k] = no_number;
}

static void
forget_slips(ss_features *out, const char *why)
{
    out->number[SS_SLIPS].value = NAN;
    know(out, SS_SLIP_RATE, unknown);
    out->number[SS_SLIPS].why = why;
}

/* Count a slip in each cycle, as sharp events do not repeat with the cycle.  A cycle of dry friction has a
 * slip nevertheless.  It has one, unless its second half mirrors the first: then it has as many in either
 * direction, or none, as a sinusoid. */
static void
count_cycles(search *s)
{
    ss_features *out = s->out;
    int more = (double)out->n > (double)s->cycles.n;
    if (s->rings_as != OF_CONTACT) {
        for (size_t i = 0; i < out->n; i++)
            out->transition[i].frequency = out->transition[i].damping_ratio = unknown;
        know(out, SS_TRANSITION_FREQUENCY_RAW, unknown);
        know(out, SS_TRANSITION_FREQUENCY, unknown);
        know(out, SS_DAMPING_RATIO, unknown);
        say(out, SS_TRANSITION_FREQUENCY, "the slips are not known");
    }
    if (s->quantity == QUANTITY_UNKNOWN && s->cycles.symmetry > -CYCLES_ALIKE) {
        out->n = out->recurring = 0;
        out->number[SS_SLIPS].value = (double)s->cycles.n;
        know(out, SS_SLIP_RATE, known(out, SS_REPETITION_FREQUENCY));
        say(out, SS_SLIPS, "counted as one a cycle, as nothing sharp repeats with it");
    } else
        forget_slips(out, more ? "there are more sharp events than slips that could repeat with the cycle"
            : "there are fewer sharp events than cycles");
}

/* Count the falls of a force, which are slips by themselves.  A signal of unknown quantity that repeats with
 * several falls in a cycle, or with none, is no force of one sign, but one with an offset, unless someone says
 * that it is such a force.  Each fall ends a cycle: so a period that is the time between falls needs no other
 * proof.  Falls that are alike and evenly spaced repeat with each: a period of several of them is that of what
 * disturbs them, such as glitches. */
static void
count_falls(search *s, times fall)
{
    ss_features *out = s->out;
    ss_number *repetition = &out->number[SS_REPETITION_FREQUENCY];
    const ss_number *drop = &out->number[SS_DROP];
    const double rate = out->number[SS_SLIP_RATE].value;
    const int is_each = fabs(rate / cycle_rate(s).value - 1) <= JITTER;
    if (s->quantity == QUANTITY_UNKNOWN && s->opts->drop == 0 && !isnan(repetition->value) && !is_each) {
        ss_loadings_forget(out);
        out->n = 0;
        forget_slips(out, "it repeats, but not as falls of a force of one sign: it may have an offset");
        return;
    }
    if (isnan(repetition->value) && is_each) {
        know(out, SS_REPETITION_FREQUENCY, cycle_rate(s));
        repetition->why = NULL;
    }
    if (slips_in_cycle(s, fall) >= 2 && recur(s, fall, 1, 1 / rate, JITTER)
        && drop->scatter <= SLIGHT * drop->value) {
        know(out, SS_REPETITION_FREQUENCY, unknown);
        repetition->why = "each fall is like the next one, but the signal repeats only after several";
    }
    if (out->n > 0 && isnan(drop->value))
        say(out, SS_SLIPS, "most falls of the force are no slips of an evenly pulled slider");
    else if (out->n > 0 && isnan(out->number[SS_LOADING_SLOPE].value))
        say(out, SS_SLIPS, "the force rises along no lines: it has no slope, and its sticks no length");
    else if (s->has_offset)
        say(out, SS_SLIPS, s->has_offset < 0
            ? "they are rises: the zero of the force is not that of friction, which is not known"
            : "the force changes its sign as it falls: if its zero is that of friction is not known");
}

/* So many slips in a cycle.  Their number is known only if as many as the rate says lie between the first and the
 * last, but for one at either end and beside each gap. */
static void
repeat_slips(search *s, times slip, size_t each)
{
    ss_features *out = s->out;
    ss_value rate = known(out, SS_REPETITION_FREQUENCY);
    double all = (double)each * rate.value, time = slip.t[slip.n - 1] - slip.t[0];
    for (size_t k = 0; k < s->n_gaps; k++)
        time -= fmax(0, fmin(s->gap[k].to, slip.t[slip.n - 1]) - fmax(s->gap[k].from, slip.t[0]));
    know(out, SS_SLIP_RATE, (ss_value){ all, (double)each * rate.error });
    if (fabs(all * time + 1 - (double)slip.n) > 2 * (1 + (double)s->n_gaps)) {
        out->number[SS_SLIPS].value = NAN;
        say(out, SS_SLIPS, "slips repeat with the cycle, but some are not seen");
    }
}

/* Does one of four slips or more, at this rate [Hz], have a jump or kink in a range [dB] that is none of the places,
 * in time order, at which a rest or a transition begins or ends?  So a motion shows that stops too briefly to be
 * seen at rest.  One that turns while it slides keeps off the level of rests. */
static int
hides_stops(const search *s, times place, const ss_rests *rests, double rate, double range)
{
    const ss_spikes *found = s->out->spikes;
    size_t off = 0, i = 0;
    for (size_t k = 0; k < found->n; k++) {
        const ss_spike *spike = &found->spike[k];
        double reach = 2 * ROW_CENTER / (2 * M_PI * spike->f), within = JITTER / rate + reach;
        while (i < place.n && place.t[i] < spike->t - within)
            i++;
        if (!is_event(spike) || spike->level < -range || (i < place.n && place.t[i] <= spike->t + within))
            continue;
        double low = INFINITY, high = -INFINITY, about = reach + EVEN / rate;
        size_t end = (size_t)fmin((spike->t + about) * s->rate, (double)s->n - 1);
        for (size_t m = (size_t)fmax((spike->t - about) * s->rate, 0); m <= end; m++)
            low = fmin(low, s->x[m]), high = fmax(high, s->x[m]);
        off += low <= rests->level + rests->band && high >= rests->level - rests->band;
    }
    return (double)off >= (1 - MOSTLY) * rate * (double)s->n / s->rate;
}

/* Count the onsets of motion behind rests. */
static void
count_motions(search *s, times motion, times place, const ss_rests *rests)
{
    ss_features *out = s->out;
    size_t each = slips_in_cycle(s, motion);
    out->number[SS_SLIPS].value = (double)motion.n;
    know(out, SS_SLIP_RATE, mean_rate(s, motion));
    if (hides_stops(s, place, rests, out->number[SS_SLIP_RATE].value, INFINITY))
        forget_slips(out, "sharp events lie within motions or rests, as where a motion stops for a short time");
    else if (each > 0)
        repeat_slips(s, motion, each);
    else if (!isnan(out->number[SS_REPETITION_FREQUENCY].value))
        forget_slips(out, "the motions between rests do not repeat with the cycle");
}

/* Count the transitions, which are sharp events, if they repeat with the cycle. */
static void
count_events(search *s, double *t, const ss_rests *rests)
{
    ss_features *out = s->out;
    size_t each = slips_in_cycle(s, onsets(s, t));
    if (each > least_in_cycle(s)) {
        if (!isnan(out->number[SS_TRANSITION_FREQUENCY].value))
            keep_ringing(s);
        out->number[SS_SLIPS].value = (double)out->n;
        each = slips_in_cycle(s, onsets(s, t));
    }
    if (each == 0)
        count_cycles(s);
    else if (s->quantity == QUANTITY_MOTION && !s->spiked && least_in_cycle(s) == 1
             && isnan(out->number[SS_TRANSITION_FREQUENCY].value))
        forget_slips(out, "what swells again and again is not known to begin with slips");
    else if (is_doubtful(s, onsets(s, t), each)
        || (rests->rest != NULL && s->quantity == QUANTITY_MOTION
            && hides_stops(s, onsets(s, t), rests, (double)each * cycle_rate(s).value, STRONG)))
        forget_slips(out, "of several sharp events a cycle some may be no slips of their own, or some hide");
    else
        repeat_slips(s, onsets(s, t), each);
}

ss_status
ss_slip_rate_find(search *s)
{
    ss_features *out = s->out;
    if (out->number[SS_SLIPS].why != NULL) {
        know(out, SS_SLIPS, unknown);
        return SS_OK;
    }
    int repeats = !isnan(out->number[SS_REPETITION_FREQUENCY].value);
    int rings = !isnan(out->number[SS_TRANSITION_FREQUENCY].value);
    ss_rests rests = { .rest = NULL };
    int has_level = out->loading == NULL && !out->reverses && !rings && s->quantity != QUANTITY_DISPLACEMENT;
    ss_status st = has_level ? ss_rests_find(s->x, s->n, &rests) : SS_OK;
    rests.is_doubtful |= rests.is_end_of_range && s->quantity == QUANTITY_MOTION;   /* there a converter clips */
    double *t = malloc((out->n + 3 * rests.n + 1) * sizeof *t);
    if (st != SS_OK || t == NULL) {
        free(rests.rest);
        free(t);
        return SS_ENOMEM;
    }
    times event = onsets(s, t), motion = { t + out->n, 0 }, end = { motion.t + rests.n, 2 * rests.n };
    for (size_t i = 0; i < rests.n; i++) {
        end.t[2 * i] = (double)rests.rest[i].first / s->rate;
        end.t[2 * i + 1] = (double)rests.rest[i].end / s->rate;
        if (rests.rest[i].end < s->n)
            motion.t[motion.n++] = end.t[2 * i + 1];
    }
    out->number[SS_SLIPS].value = (double)out->n;
    know(out, SS_SLIP_RATE, mean_rate(s, event));
    if (out->loading != NULL)
        count_falls(s, event);
    else if (s->rings_as == OF_SENSOR)
        forget_slips(out, "what rings is a sensor's: short sticks may hide in it");
    else if (motion.n >= FEW && !rests.is_doubtful && slips_in_cycle(s, motion) % least_in_cycle(s) == 0)
        count_motions(s, motion, end, &rests);
    else if (motion.n >= FEW && !rests.is_doubtful && s->quantity == QUANTITY_MOTION)
        forget_slips(out, "one half of the cycle mirrors the other, but it does not rest in both");
    else if (motion.n >= FEW && out->n > 0 && rests.is_doubtful)
        forget_slips(out, "the signal rests at a level that it also crosses so slowly that rests are not certain");
    else if (repeats)
        count_events(s, t, &rests);
    else if (out->n == 0)
        forget_slips(out, "nothing stands out: slips that are smooth or weak are not seen");
    else if (rings || (out->n == 1 && out->transition[0].end > out->transition[0].onset))
        say(out, SS_SLIPS, "counted by what stands out, as nothing repeats that would confirm it");
    else
        forget_slips(out, "events stand out, but they neither repeat nor ring nor lie between rests");
    free(rests.rest);
    free(t);
    return SS_OK;
}
