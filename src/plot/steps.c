/* steps.c -- draw the steps of a load point: of each, friction along the path as measured and by both laws, and
 * what each law leaves. */
#include "plot/script.h"

#include <stickslip/steps.h>
#include "base/error.h"

#define FRICTION 4.5            /* heights of the panels [cm] */
#define LEFT 2.0
#define AXIS 1.1                /* and below a step's */
#define ROOM 16.0               /* for the labels of the panels [ems] */
#define LEFT_ROOM 8.0
enum { POINTS = 4000 };         /* of a line */

static const char *const colour[SS_STEP_LAWS] = { BLUE, VERMILION };

static void
draw_step(script_stack *stack, const ss_step *s, size_t number)
{
    FILE *out = stack->out;
    const ss_column path = { (char *)"path of the load point", (char *)"\xc2\xb5m" };
    const ss_column mu = { (char *)"friction", (char *)"" }, left = { (char *)"left", (char *)"" };
    script_extent extent_of_mu = SCRIPT_NO_EXTENT, extent_of_left = extent_of_mu;
    for (size_t i = 0; i < s->n; i++) {
        ss_script_include(&extent_of_mu, s->friction[i]);
        for (int k = 0; k < SS_STEP_LAWS; k++) {
            ss_script_include(&extent_of_mu, s->law[k].model[i]);
            ss_script_include(&extent_of_left, s->friction[i] - s->law[k].model[i]);
        }
    }
    const script_axis frictions = ss_script_axis(&mu, extent_of_mu), rest = ss_script_axis(&left, extent_of_left);
    ss_print(out, "$step%zu << EOD\n", number);
    for (size_t i = 0, stride = 1 + s->n / POINTS; i < s->n; i += stride) {
        ss_print(out, "%.8g %.6g", 1e6 * s->path[i], ss_script_scaled(s->friction[i], frictions.scale));
        for (int k = 0; k < SS_STEP_LAWS; k++)
            ss_print(out, " %.6g %.6g", ss_script_scaled(s->law[k].model[i], frictions.scale),
                     ss_script_scaled(s->friction[i] - s->law[k].model[i], rest.scale));
        putc('\n', out);
    }
    fputs("EOD\n", out);
    ss_script_write_panel(stack, FRICTION, 0.25, &frictions, ROOM, 5);
    ss_print(out, "set format x ''; unset xlabel\n"
             "set key at graph 1, graph 0.99 top right horizontal samplen 1.5 noenhanced\n"
             "plot $step%zu using 1:2 with lines lw 0.6 lc rgb '" SKY_BLUE "' title 'measured'", number);
    for (int k = 0; k < SS_STEP_LAWS; k++)
        ss_print(out, ", '' using 1:%d with lines lw 1.2 lc rgb '%s' title '%s'", 3 + 2 * k, colour[k],
                 s->law[k].name);
    fputs("\nunset key; unset title\n", out);
    ss_script_write_panel(stack, LEFT, AXIS, &rest, LEFT_ROOM, 4);
    ss_script_write_x_label(out, &path, ss_script_power(0));
    ss_print(out, "set format x '%%g'\nplot 0 lc rgb '" ZERO_COLOUR "' lw 0.7");
    for (int k = SS_STEP_LAWS - 1; k >= 0; k--)
        ss_print(out, ", $step%zu using 1:%d with lines lw 0.6 lc rgb '%s'", number, 4 + 2 * k, colour[k]);
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
        st = ss_script_begin_stack(&stack, out, &own, NULL, (FRICTION + LEFT + AXIS + 0.25) * (double)steps->n,
                                   err);
    if (st != SS_OK)
        return st;
    ss_script_write_frame(out, 0.175, 0.965);
    fputs("set autoscale xfix; set offsets 0,0,graph 0.12,graph 0.05\n", out);
    for (size_t i = 0; i < steps->n; i++)
        draw_step(&stack, &steps->step[i], i);
    return ss_script_end(out);
}
