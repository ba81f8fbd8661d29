/* diagram.c -- draw a sweep over one parameter: columns of its rows over the key that was varied.
 *
 * If the rows of one value differ, as the points of a stroboscopic map do, they are drawn as points (a bifurcation
 * diagram), else as a line.  Counts have no values between two: they are drawn as steps and points. */
#include "plot/map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"

#define FIRST 4.6               /* heights of the panels [cm] */
#define NEXT 2.2
#define KEY 1.0                 /* and below */
#define GAP 0.2                 /* between two */
#define ROOM 8.0                /* for the label of a panel of NEXT [ems] */
enum { COLUMNS_MAX = 8, CELLS = 1500 };     /* CELLS: in which points of one value of the key are told apart */

/* Write panel i of n rows.  Points that would cover each other are written once. */
static void
write_panel(script_stack *stack, const map_column *column, script_scale of_x, size_t i, size_t n)
{
    FILE *out = stack->out;
    const double *x = column[0].value, *y = column[i].value;
    map_label label;
    const script_axis axis = ss_script_axis(ss_map_label(&label, column[i].label), ss_script_extent(y, n));
    const script_extent e = axis.extent;
    char seen[CELLS + 1] = { 0 };
    int line = 1, whole = 1, decimals = ss_script_decimals((e.hi - e.lo) / axis.scale.unit);
    ss_print(out, "$panel%zu << EOD\n", i);
    for (size_t k = 0; k < n; k++) {            /* rows of one value of the key stand together */
        line &= k == 0 || x[k] != x[k - 1] || y[k] == y[k - 1] || (isnan(y[k]) && isnan(y[k - 1]));
        whole &= isnan(y[k]) || y[k] == floor(y[k]);
        if (k > 0 && x[k] != x[k - 1])
            memset(seen, 0, sizeof seen);
        size_t cell = !isnan(y[k]) && e.hi > e.lo ? (size_t)((y[k] - e.lo) / (e.hi - e.lo) * CELLS) : 0;
        if (isnan(y[k])) {
            putc('\n', out);                    /* a line breaks */
        } else if (!seen[cell]) {
            seen[cell] = 1;
            ss_print(out, "%.9g ", ss_script_scaled(x[k], of_x));
            ss_script_write(out, ss_script_scaled(y[k], axis.scale), decimals, "\n");
        }
    }
    fputs("EOD\n", out);
    double height = i == 1 ? FIRST : NEXT, room = ROOM / NEXT * height;
    ss_script_write_panel(stack, height, GAP, &axis, room, i == 1 ? 6 : 4);
    if (line && whole)
        ss_print(out, "plot $panel%zu using 1:2 with histeps lw 0.7 lc rgb colour, "
                "$panel%zu using 1:2 with points pt 7 ps 4*size lc rgb colour\n", i, i);
    else
        ss_print(out, "plot %s$panel%zu using 1:2 with %s\n",
                line && e.lo < 0 && e.hi > 0 ? "0 lc rgb '" ZERO_COLOUR "' lw 0.7, " : "", i,
                line ? "lines lw 1 lc rgb colour" : "points pt 7 ps size lc rgb colour");
}

ss_status
ss_plot_diagram(FILE *out, const ss_table *t, const size_t drawn[], size_t n, const ss_plot_opts *opts,
                ss_error *err)
{
    script_stack stack;
    map_label label;
    if (n < 2 || n > COLUMNS_MAX)
        return ss_fail(err, SS_EINVAL, "one key was varied, so X,Y[,Y...] are drawn, at most %d columns",
                       COLUMNS_MAX);
    if (opts->curve != NULL)
        return ss_fail(err, SS_EINVAL, "a line needs a map over two keys, and one was varied");
    map_column column[COLUMNS_MAX];
    map_axis x = { .n = 0 };
    ss_status st = ss_map_read_columns(column, n, t, drawn, err);
    if (st == SS_OK)
        st = ss_map_make_axis(&x, &column[0], t->n, err);
    for (size_t i = 1; st == SS_OK && i < n; i++) {
        script_extent e = ss_script_extent(column[i].value, t->n);
        if (!(e.lo <= e.hi))
            st = ss_fail(err, SS_EDATA, "%s has no value to draw", column[i].label->name);
    }
    const ss_plot_opts own = ss_map_titled(opts, t);
    if (st == SS_OK)
        st = ss_script_begin_stack(&stack, out, &own, NULL, FIRST + (double)(n - 2) * (GAP + NEXT) + KEY, err);
    if (st == SS_OK) {
        ss_script_write_frame(out, 0.175, 0.965);
        fputs("colour = '" BLUE "'; size = 0.15*mark\nset xtics format ''; set border back\n"
              "set offsets 0,0,graph 0.04,graph 0.04; set autoscale yfix\n", out);
        ss_map_write_axis(out, 'x', &x);
    }
    for (size_t i = 1; st == SS_OK && i < n; i++) {
        if (i + 1 == n) {
            fputs("set xtics format '%g'; ", out);
            ss_script_write_x_label(out, ss_map_label(&label, column[0].label), x.scale);
            if (x.log)
                ss_script_write_decades(out, "x", x.value[0], x.value[x.n - 1]);
        }
        write_panel(&stack, column, x.scale, i, t->n);
    }
    st = st == SS_OK ? ss_script_end(out) : st;
    free(x.value);
    ss_map_free_columns(column, n);
    return st;
}
