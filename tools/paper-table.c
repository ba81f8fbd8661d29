/* paper-table.c -- what the figures of make paper show, in numbers, next to what the paper says of
 * its own.  usage: paper-table FIGURE.h5 ... */
#include "common.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One contour spacing.  A local maximum less prominent than this may have no closed contour, and what is
 * less prominent along the shortest scale is not counted as a spike. */
#define PROMINENCE (80.0 / 18)
#define LOWEST (-40.0)          /* local maxima below this are noise [dB] */
#define LOW 20.0                /* local maxima below belong to the base and its harmonics [Hz] */
#define RANGE 20.0              /* spikes this much below the highest one do not count [dB] */
#define LISTED 60               /* more spikes than this are noise too, and counted only */

static const struct { const char *figure, *words; } paper[] = {
    { "figure2", "a spike at each onset of sticking; no local maximum" },
    { "figure3", "two weaker spikes an interval; no local maximum" },
    { "figure5", "local maximum near 45 Hz at each transition, one major spike" },
    { "figure6", "local maximum near 45 Hz at each transition, grouped spikes" },
    { "figure7", "local maximum near 45 Hz at each transition, grouped spikes, more besides" },
};

/* The name of a figure: "build/paper/figure2-dyadic.h5" becomes "figure2-dyadic". */
static void
name_figure(char name[64], const char *path)
{
    const char *slash = strrchr(path, '/');
    snprintf(name, 64, "%s", slash != NULL ? slash + 1 : path);
    name[strcspn(name, ".")] = '\0';
}

static const char *
find_words(const char *name)
{
    for (size_t i = 0; i < sizeof paper / sizeof *paper; i++)
        if (strncmp(name, paper[i].figure, strlen(paper[i].figure)) == 0)
            return paper[i].words;
    return "-";
}

/* Half a period of the base, which has one transition; 0 if it is not known. */
static double
half_cycle(const ss_header *head)
{
    const char *frequency = ss_header_find_note(head, "base_frequency");
    char *end;
    double f = frequency != NULL ? ss_number_parse(frequency, &end) : 0;
    return f > 0 ? 1 / (2 * f) : 0;
}

/* Keep the maxima with a level of at least `lowest`, and return their number. */
static size_t
keep(ss_maximum *maximum, size_t n, double lowest)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++)
        if (maximum[i].level >= lowest)
            maximum[kept++] = maximum[i];
    return kept;
}

/* Print number, frequencies and prominences of the maxima above the harmonics of the base. */
static void
print_ranges(const ss_maximum *maximum, size_t n)
{
    double f[2] = { INFINITY, 0 }, prominence[2] = { INFINITY, 0 };
    size_t high = 0;
    for (size_t i = 0; i < n; i++) {
        if (maximum[i].f < LOW)
            continue;
        high++;
        f[0] = fmin(f[0], maximum[i].f);
        f[1] = fmax(f[1], maximum[i].f);
        prominence[0] = fmin(prominence[0], maximum[i].prominence);
        prominence[1] = fmax(prominence[1], maximum[i].prominence);
    }
    printf("; above %g Hz: %zu", LOW, high);
    if (high > 0)
        printf(", at %.1f to %.1f Hz, prominence %.1f to %.1f dB", f[0], f[1], prominence[0],
               prominence[1]);
    printf("\n");
}

static void
print_maxima(const ss_coefficients *c)
{
    ss_maximum *maximum = NULL;
    size_t n = 0;
    ss_error err = { 0 };
    tool_check(ss_maxima_find(&maximum, &n, c, PROMINENCE, &err), &err);
    n = keep(maximum, n, LOWEST);
    printf("  local maxima: %zu", n);
    print_ranges(maximum, n);
    if (n > 0)
        printf("    %8s %9s %9s %14s\n", "t/s", "f/Hz", "level/dB", "prominence/dB");
    for (size_t i = 0; i < n; i++)
        printf("    %8.4f %9.3f %9.2f %14.2f\n", c->head->start + maximum[i].t, maximum[i].f,
               maximum[i].level, maximum[i].prominence);
    free(maximum);
}

static void
print_counts(const ss_maximum *spike, size_t n, double half, double end)
{
    printf("; in each half-cycle:");
    for (size_t i = 0, k = 0; (double)i * half < end; i++) {
        size_t first = k;
        while (k < n && spike[k].t < (double)(i + 1) * half)
            k++;
        printf(" %zu", k - first);
    }
}

static void
print_spikes(const ss_coefficients *c)
{
    size_t n, shortest = c->n_scales - 1;
    ss_error err = { 0 };
    ss_maximum *spike;
    double half = half_cycle(c->head);
    tool_check(ss_maxima_along(&spike, &n, c, shortest, RANGE, PROMINENCE, &err), &err);
    printf("  spikes at %.0f Hz: %zu", c->scale[shortest].f, n);
    if (half > 0)
        print_counts(spike, n, half, (double)c->n / c->head->rate);
    printf("\n");
    if (n > 0 && n <= LISTED)
        printf("    %8s %9s %9s\n", "t/s", "", "level/dB");
    for (size_t i = 0; i < n && n <= LISTED; i++)
        printf("    %8.4f %9s %9.2f\n", c->head->start + spike[i].t, "", spike[i].level);
    free(spike);
}

/* --- the contact --------------------------------------------------------------------------- */

static double
note_number(const ss_header *head, const char *key)
{
    const char *text = ss_header_find_note(head, key);
    char *end;
    return text != NULL ? ss_number_parse(text, &end) : NAN;
}

static void
print_value(const char *format, double x)
{
    if (isnan(x))
        printf(" %10s", "-");
    else
        printf(format, x);
}

static void
print_row(const char *name, const char *format, double words, double raw, ss_number fitted,
          double truth)
{
    printf("  %-22s", name);
    print_value(format, words);
    print_value(format, raw);
    print_value(format, fitted.value);
    if (isnan(fitted.error))
        printf(" %10s", "-");
    else
        printf(" %10.2g", fitted.error);
    print_value(format, truth);
    printf("\n");
}

/* Print the contact as the paper estimates it, as the same reading of our map does, as the fit finds it,
 * and as it was simulated. */
static void
print_contact(const char *path, const char *name, const char *column_name)
{
    ss_signal *signal = NULL;
    ss_features *f = NULL;
    ss_error err = { 0 };
    ss_features_opts opts;
    ss_features_opts_init(&opts, sizeof opts);
    int said = strncmp(name, "figure2", 7) != 0 && strncmp(name, "figure3", 7) != 0;
    tool_check(ss_signal_read(&signal, NULL, path, NULL, &err), &err);
    const ss_header *head = signal->head;
    int column = ss_header_column(head, column_name);
    double m = note_number(head, "mass"), k = note_number(head, "stiffness");
    double K = k + note_number(head, "contact_stiffness"), c = note_number(head, "contact_damping");
    opts.mass = m > 0 ? m : 0;
    opts.stiffness = k > 0 ? k : 0;
    if (column < 0)
        tool_die("%s: no column %s beside its coefficients", path, column_name);
    tool_check(ss_features_find(&f, signal, (size_t)column, &opts, &err), &err);
    printf("  transitions: %zu, with a local maximum %zu\n", f->n, f->recurring);
    printf("  %-22s %10s %10s %10s %10s %10s\n", "", "paper", "raw", "fitted", "+-", "simulated");
    print_row("frequency / Hz", " %10.3f", said ? 45 : NAN, f->number[SS_TRANSITION_FREQUENCY_RAW].value,
              f->number[SS_TRANSITION_FREQUENCY],
              sqrt(K / m - c * c / (4 * m * m)) / (2 * M_PI));
    print_row("damping ratio", " %10.5f", NAN, NAN, f->number[SS_DAMPING_RATIO], c / (2 * sqrt(K * m)));
    print_row("total stiffness / N/m", " %10.0f", said ? 193500 : NAN, f->number[SS_TOTAL_STIFFNESS_RAW].value,
              f->number[SS_TOTAL_STIFFNESS], K);
    ss_features_free(f);
    ss_signal_free(signal);
}

static void
print_figure(const char *path)
{
    ss_coefficients *c = NULL;
    ss_error err = { 0 };
    char name[64];
    tool_check(ss_coefficients_read(&c, NULL, path, &err), &err);
    name_figure(name, path);
    printf("\n%s\n  the paper: %s\n", name, find_words(name));
    print_maxima(c);
    print_spikes(c);
    print_contact(path, name, c->head->column[0].name);
    ss_coefficients_free(c);
}

int
main(int argc, char *argv[])
{
    tool_begin(argv, "paper-table", "usage: paper-table FIGURE.h5 ...\n");
    printf("Levels in dB re the largest |W| outside the cone of influence.  Local maxima and spikes are\n"
           "at least %.1f dB prominent (one contour spacing); local maxima from %.0f dB up, spikes\n"
           "within %.0f dB of the highest.\n", PROMINENCE, LOWEST, RANGE);
    for (int i = 1; i < argc; i++)
        print_figure(argv[i]);
    tool_end();
    return 0;
}
