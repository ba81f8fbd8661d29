/* motion.c -- draw a ranking of friction laws by a motion: the loop of force and motion, as measured and as the
 * first law predicts it; what that leaves over time; and a bar for each law. */
#include "plot/script.h"

#include <math.h>
#include <stickslip/rank.h>
#include "base/error.h"

#define LOOP 5.0                /* heights of the panels [cm] */
#define LEFT 2.0
#define BAR 0.36
#define AXIS 1.1                /* and below each */
#define ROOM 9.0                /* for the label of a panel of LEFT [ems] */
enum { POINTS = 8000 };         /* of a line */

static void
write_panel(script_stack *stack, double height, const script_axis *x, const script_axis *y, int intervals)
{
    ss_script_write_panel(stack, height, AXIS, y, ROOM / LEFT * height, intervals);
    ss_script_write_x_label(stack->out, x->column, x->scale);
    ss_script_write_tics(stack->out, "xtics", ss_script_scaled_extent(x->extent, x->scale), 6);
}

ss_status
ss_plot_motion(FILE *out, const ss_signal *signal, size_t motion, size_t force, const ss_motion_ranking *r,
               const ss_plot_opts *opts, ss_error *err)
{
    ss_plot_opts own;
    script_stack stack;
    script_extent of_left = SCRIPT_NO_EXTENT;
    if (out == NULL || signal == NULL || r == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, opts, err);
    if (st == SS_OK && (motion >= signal->head->n_columns || force >= signal->head->n_columns))
        return ss_fail_column(err, motion >= signal->head->n_columns ? motion : force, signal->head->n_columns);
    if (st == SS_OK && (r->n == 0 || r->rows != signal->n))
        return ss_fail(err, SS_EINVAL, "nothing to draw: %s", r->answer);
    const double *x = signal->values + motion * signal->n, *f = signal->values + force * signal->n;
    const ss_column *of_x = &signal->head->column[motion], *of_f = &signal->head->column[force];
    const ss_column t = { .name = (char *)"t", .unit = (char *)"s" };
    const ss_column rest = { .name = (char *)"left", .unit = of_f->unit };
    const ss_column explained = { .name = (char *)"explained of the force that was held out", .unit = (char *)"" };
    const ss_column none = { .name = (char *)"", .unit = (char *)"" };
    if (st == SS_OK)
        st = ss_script_check(of_x->name, ss_script_extent(x, signal->n), err);
    if (st == SS_OK)
        st = ss_script_check(of_f->name, ss_script_extent(f, signal->n), err);
    if (st == SS_OK)
        st = ss_script_begin_stack(&stack, out, &own, signal->head,
                                   SCRIPT_LEGEND + LOOP + LEFT + BAR * (double)r->n + 3 * AXIS, err);
    if (st != SS_OK)
        return st;
    for (size_t i = 0; i < signal->n; i++)
        ss_script_include(&of_left, f[i] - r->predicted[i]);
    const script_extent whole = { 0, 1 };
    const script_axis place = ss_script_axis(of_x, ss_script_extent(x, signal->n));
    const script_axis forces = ss_script_axis(of_f, ss_script_extent(f, signal->n));
    const script_axis time = ss_script_axis(&t, ss_script_extent(r->time, signal->n));
    const script_axis left = ss_script_axis(&rest, of_left);
    const script_axis share = ss_script_axis(&explained, whole), law = ss_script_axis(&none, whole);
    stack.top -= SCRIPT_LEGEND;
    fputs("$loop << EOD\n", out);
    for (size_t i = 0, stride = 1 + signal->n / POINTS; i < signal->n; i += stride)
        ss_print(out, "%.8g %.6g %.6g %.6g %.6g\n", ss_script_scaled(r->time[i], time.scale),
                 ss_script_scaled(x[i], place.scale), ss_script_scaled(f[i], forces.scale),
                 ss_script_scaled(r->predicted[i], forces.scale),
                 ss_script_scaled(f[i] - r->predicted[i], left.scale));
    fputs("EOD\n$laws << EOD\n", out);
    for (size_t i = 0; i < r->n; i++)
        ss_print(out, "%.6g %.6g %zu %d\n", fmax(r->row[i].explained, 0), r->row[i].explained_error, r->n - i,
                 r->row[i].tied);
    fputs("EOD\n", out);
    ss_script_write_frame(out, 0.22, 0.965);
    fputs("set autoscale xfix; set offsets graph 0.03,graph 0.03,graph 0.05,graph 0.05\n", out);
    write_panel(&stack, LOOP, &place, &forces, 8);
    ss_script_write_key(out);
    fputs("plot $loop using 2:3 with lines lw 1 lc rgb '" SKY_BLUE "' title 'measured', "
          "$loop using 2:4 with lines lw 0.8 lc rgb '" VERMILION "' title ", out);
    ss_script_quote(out, r->row[0].law, 0);
    fputs("\nunset key\n", out);
    write_panel(&stack, LEFT, &time, &left, 4);
    fputs("plot 0 lc rgb '" ZERO_COLOUR "' lw 0.7, $loop using 1:5 with lines lw 0.7 lc rgb '" BLACK "'\n", out);
    write_panel(&stack, BAR * (double)r->n, &share, &law, 4);
    ss_script_write_frame(out, 0.3, 0.965);
    ss_print(out, "set offsets 0,0,0,0; set xrange [0:1]; set yrange [0.4:%zu.6]; set ytics (", r->n);
    for (size_t i = 0; i < r->n; i++) {
        ss_script_quote(out, r->row[i].law, 0);
        ss_print(out, " %zu%s", r->n - i, i + 1 < r->n ? ", " : ")\n");
    }
    fputs("plot $laws using ($1/2):3:($1/2):(0.3) with boxxyerror fs solid 0.6 noborder lc rgb '" BLUE "', "
          "$laws using 1:3:2 with xerrorbars pt 7 ps 0.1*mark lc rgb '" BLACK "', "
          "$laws using ($4 == 1 ? 0.02 : NaN):3 with points pt 7 ps 0.4*mark lc rgb 'white'\n", out);
    return ss_script_end(out);
}
