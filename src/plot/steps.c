/* steps.c -- draw the steps of a load point: of each, friction along the path as measured and by both laws, and what
 * each law leaves. */
#include "plot/script.h"
#include "plot/style.h"

#include <stickslip/steps.h>
#include "base/error.h"

#define FRICTION 4.5            /* heights of the panels [cm] */
#define LEFT 2.0
#define AXIS 1.1                /* and below a step's */
#define ROOM 9.0                /* for the label of a panel [ems] */
enum { POINTS = 4000 };         /* of a line */

static const char *const colour[SS_STEP_LAWS] = { BLUE, VERMILION };

static void
draw_step(script_stack *stack, const ss_step *s, size_t number)
{
    FILE *out = stack->out;
    const script_scale plain = ss_script_power(0);
    const ss_column path = { (char *)"path of the load point", (char *)"um" }, mu = { (char *)"friction", (char *)"" };
    const ss_column left = { (char *)"left", (char *)"" };
    script_label of_path, of_mu, of_left;
    ss_script_make_label(&of_path, &path, plain, INFINITY);
    ss_script_make_label(&of_mu, &mu, plain, ROOM);
    ss_script_make_label(&of_left, &left, plain, ROOM);
    ss_print(out, "$step%zu << EOD\n", number);
    for (size_t i = 0, stride = 1 + s->n / POINTS; i < s->n; i += stride)
        ss_print(out, "%.8g %.6g %.6g %.6g\n", 1e6 * s->path[i], s->friction[i], s->law[SS_STEP_AGING].model[i],
                 s->law[SS_STEP_SLIP].model[i]);
    fputs("EOD\n", out);
    ss_script_write_panel(stack, FRICTION, 0.25, &of_mu);
    ss_print(out, "set title offset 0,0.7\nset format x ''\nset key at graph 1, graph 0.99 top right horizontal samplen 1.5 "
             "noenhanced\nplot $step%zu using 1:2 with lines lw 0.6 lc rgb '" SKY_BLUE "' title 'measured'", number);
    for (int i = 0; i < SS_STEP_LAWS; i++)
        ss_print(out, ", '' using 1:%d with lines lw 1.2 lc rgb '%s' title '%s'", i + 3, colour[i], ss_step_law_names[i]);
    fputs("\nunset key; unset title\n", out);
    ss_script_write_panel(stack, LEFT, AXIS, &of_left);
    ss_script_write_x_label(out, &of_path, "0,0.4");
    ss_print(out, "set format x '%%g'\nplot 0 lc rgb '" ZERO_COLOUR "' lw 0.7");
    for (int i = SS_STEP_LAWS - 1; i >= 0; i--)
        ss_print(out, ", $step%zu using 1:($2-$%d) with lines lw 0.6 lc rgb '%s'", number, i + 3, colour[i]);
    fputc('\n', out);
}

ss_status
ss_plot_steps(FILE *out, const ss_steps *steps, const ss_plot_opts *opts, ss_error *err)
{
    ss_plot_opts own;
    script_stack stack;
    if (out == NULL || steps == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, opts, err);
    if (st == SS_OK)
        st = ss_script_begin_stack(&stack, out, &own, NULL, (FRICTION + LEFT + AXIS + 0.25) * (double)steps->n, err);
    if (st != SS_OK)
        return st;
    ss_script_write_frame(out, 0.16, 0.965);
    fputs("set autoscale xfix; set offsets 0,0,graph 0.12,graph 0.05\n", out);
    for (size_t i = 0; i < steps->n; i++)
        draw_step(&stack, &steps->step[i], i);
    return ss_script_end(out);
}
