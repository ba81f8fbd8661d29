/* recording.c -- from a recording of any supported kind to its strongest frequency.
 *
 *     cc recording.c $(pkg-config --cflags --libs stickslip gsl) -lm -o recording
 *     ./recording run.csv force
 *
 * Reads the file, whichever it is, transforms the column, and names the largest coefficient outside
 * the cone of influence. */
#include <stickslip.h>

#include <math.h>
#include <stdio.h>

/* The largest |W| with its time and its label in Hz. */
static void
print_largest(const ss_coefficients *c)
{
    double largest = -1, b = 0, f = 0;
    for (size_t i = 0; i < c->n_scales; i++) {
        const ss_scale *scale = &c->scale[i];
        for (size_t k = 0; k < scale->n; k++) {
            const double *w = c->w + 2 * (scale->offset + k);
            if (ss_scale_edge(scale, k, c->n, c->head->rate) || !(hypot(w[0], w[1]) > largest))
                continue;
            largest = hypot(w[0], w[1]);
            b = ss_scale_b(scale, k);
            f = scale->f;
        }
    }
    printf("largest |W| = %.4g at %.3f s, %.4g Hz\n", largest, c->head->start + b, f);
}

int
main(int argc, char *argv[])
{
    ss_signal *signal = NULL;
    ss_coefficients *coefficients = NULL;
    ss_error err = { 0 };
    ss_read_opts read;
    ss_morlet_opts opts;
    if (argc != 3) {
        fputs("usage: recording FILE COLUMN\n", stderr);
        return 2;
    }
    ss_read_opts_init(&read, sizeof read);
    read.gaps = SS_GAPS_INTERPOLATE;
    ss_morlet_opts_init(&opts, sizeof opts);
    opts.detrend = SS_DETREND_MEAN;
    opts.norm = SS_NORM_L1;             /* a sine then reads at its own frequency */

    ss_status status = ss_signal_read(&signal, NULL, argv[1], &read, &err);
    int column = status == SS_OK ? ss_header_column(signal->head, argv[2]) : -1;
    if (status == SS_OK && column < 0) {
        snprintf(err.text, sizeof err.text, "%s: no column '%.40s'", argv[1], argv[2]);
        status = SS_EINVAL;
    }
    if (status == SS_OK)
        status = ss_morlet_transform(&coefficients, signal, (size_t)column, &opts, &err);
    if (status == SS_OK)
        print_largest(coefficients);
    else
        fprintf(stderr, "recording: %s\n", err.text);

    ss_coefficients_free(coefficients);
    ss_signal_free(signal);
    return status != SS_OK;
}
