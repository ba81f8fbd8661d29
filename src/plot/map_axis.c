/* map_axis.c -- title and axes of maps and diagrams. */
#include "plot/map.h"

#include <math.h>
#include <string.h>

#define TICS_WIDE 24            /* letters of all tics below a map together, if they are long */

ss_plot_opts
ss_map_titled(const ss_plot_opts *opts, const ss_table *t)
{
    ss_plot_opts titled = *opts;
    const char *scene = ss_table_note(t, "scene");
    if (titled.title == NULL)
        titled.title = scene != NULL ? scene : "";
    return titled;
}

script_label
ss_map_label(const ss_column *column, script_scale scale, double room)
{
    script_label label;
    ss_script_make_label(&label, column, scale, room);
    for (size_t i = 0; i < strlen(column->name) && label.text[i] != '\0'; i++)
        label.text[i] = label.text[i] == '_' ? ' ' : label.text[i];
    return label;
}

script_scale
ss_map_scale(script_extent e)
{
    script_scale scale = ss_script_scale(e);
    return scale.offset != 0 ? scale : ss_script_power(0);
}

/* gnuplot sets tics at powers of ten, or at some ten equally spaced values. */
int
ss_map_letters(script_extent e, int log)
{
    double step = pow(10, floor(log10(e.hi - e.lo)));
    double tic[2] = { step * ceil(10 * e.lo / step) / 10, step * floor(10 * e.hi / step) / 10 };
    int most = 0;
    for (int i = 0; i < 2; i++) {
        double at = !log ? tic[i] : pow(10, i == 0 ? ceil(log10(e.lo)) : floor(log10(e.hi)));
        most = (int)fmax(most, snprintf(NULL, 0, "%g", at));
    }
    return most;
}

void
ss_map_write_x_tics(FILE *out, script_extent e)
{
    int letters = ss_map_letters(e, 0);
    if (letters > 4)
        ss_script_write_tics(out, "xtics", e, (int)fmax(1, TICS_WIDE / letters));
}
