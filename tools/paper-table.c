/* paper-table.c -- what the figures of make paper show, in numbers, next to what the paper says of
 * its own.  usage: paper-table FIGURE.h5 ... */
#include "common.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PROMINENCE (80.0 / 18)  /* one contour spacing: what is less prominent is not counted as a spike */
#define RANGE 20.0              /* spikes this much below the highest one do not count [dB] */
#define LISTED 60               /* more spikes than this are noise, and counted only */

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
    snprintf(name, 64, "%s", tool_file_name(path));
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

static double
note_number(const ss_header *head, const char *key)
{
    const char *text = ss_header_find_note(head, key);
    return text != NULL ? ss_number_parse(text, NULL) : NAN;
}

/* Half a period of the base, which has one transition; 0 if it is not known. */
static double
half_cycle(const ss_header *head)
{
    double f = note_number(head, "base_frequency");
    return f > 0 ? 1 / (2 * f) : 0;
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
        printf("    %8s %9s\n", "t/s", "level/dB");
    for (size_t i = 0; i < n && n <= LISTED; i++)
        printf("    %8.4f %9.2f\n", c->head->start + spike[i].t, spike[i].level);
    free(spike);
}

/* --- the contact --------------------------------------------------------------------------- */

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
    print_spikes(c);
    print_contact(path, name, c->head->column[0].name);
    ss_coefficients_free(c);
}

int
main(int argc, char *argv[])
{
    tool_begin(argv, "paper-table", "usage: paper-table FIGURE.h5 ...\n");
    printf("Spikes are at least %.1f dB prominent (one contour spacing) and within %.0f dB of the highest.\n"
           "The features of each figure, FIGURE-features.tsv, have the local maxima.\n",
           PROMINENCE, RANGE);
    for (int i = 1; i < argc; i++)
        print_figure(argv[i]);
    tool_end();
    return 0;
}
