/* contour_script.h -- the script of a contour plot as text: for tests. */
#ifndef CONTOUR_SCRIPT_H
#define CONTOUR_SCRIPT_H

#include <stickslip.h>

#include "unit.h"

static inline ss_plot_opts
new_plot_opts(void)
{
    ss_plot_opts opts;
    ss_plot_opts_init(&opts, sizeof opts);
    return opts;
}

static inline ss_contour_opts
new_contour_opts(void)
{
    ss_contour_opts opts;
    ss_contour_opts_init(&opts, sizeof opts);
    return opts;
}

/* To be freed with free(); NULL: the default options. */
static char *
contour_script(const ss_coefficients *c, const ss_contour_opts *contour)
{
    char *text = NULL;
    size_t size;
    ss_error err = { 0 };
    FILE *out = open_memstream(&text, &size);
    if (ss_plot_contour(out, c, contour, NULL, &err) != SS_OK)
        fail_msg("%s", err.text);
    fclose(out);
    return text;
}

#endif
