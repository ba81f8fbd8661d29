/* contour_script.h -- the script of a contour plot as text: for tests. */
#ifndef CONTOUR_SCRIPT_H
#define CONTOUR_SCRIPT_H

#include <stickslip.h>

#include "unit.h"

/* To be freed with free(). */
static char *
contour_script(const ss_coefficients *c, const ss_contour_opts *contour)
{
    char *text = NULL;
    size_t size;
    ss_error err = { 0 };
    FILE *out = open_memstream(&text, &size);
    if (ss_plot_contour(out, c, contour, &ss_plot_defaults, &err) != SS_OK)
        fail_msg("%s", err.text);
    fclose(out);
    return text;
}

#endif
