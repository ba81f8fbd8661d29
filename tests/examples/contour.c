/* contour.c -- the shortest way from a scene to a contour plot with libstickslip.
 *
 *     cc contour.c $(pkg-config --cflags --libs stickslip gsl) -o contour
 *     ./contour compliant-light
 *     gnuplot -p contour.gp
 *
 * Simulates a scene, a shipped one or a file, transforms its acceleration, and leaves contour.h5 with
 * the numbers and contour.gp with the picture.  Each step gives a status, and on failure its reason
 * in err. */
#include <stickslip.h>

#include <stdio.h>

static ss_status
write_plot(const char *path, const ss_coefficients *coefficients, const ss_signal *signal,
           size_t column, ss_error *err)
{
    ss_contour_opts opts;
    ss_contour_opts_init(&opts, sizeof opts);
    opts.signal = signal;
    opts.column = column;
    FILE *out = fopen(path, "w");
    if (out == NULL) {
        snprintf(err->text, sizeof err->text, "%s: cannot be written", path);
        return SS_EIO;
    }
    ss_status status = ss_plot_contour(out, coefficients, &opts, NULL, err);
    if (fclose(out) != 0 && status == SS_OK)
        status = SS_EIO;
    return status;
}

int
main(int argc, char *argv[])
{
    ss_scene scene;
    ss_signal *signal = NULL;
    ss_coefficients *coefficients = NULL;
    ss_error err = { 0 };
    size_t column = 0;

    /* GSL's default handler ends the program at the first error, lack of memory included.  The
     * library checks GSL's statuses itself, but leaves this setting, a global one, to the program. */

    const char *path = argc > 1 ? argv[1] : "compliant-light";
    ss_status status = ss_scene_read(&scene, NULL, path, NULL, 0, &err);
    if (status == SS_OK)
        status = ss_sim_signal(&signal, &scene, &err);
    if (status == SS_OK) {
        column = (size_t)ss_header_column(signal->head, "a");
        status = ss_morlet_transform(&coefficients, signal, column, NULL, &err);
    }
    if (status == SS_OK)
        status = ss_record_write(&(ss_record){ .signal = signal, .coefficients = coefficients }, NULL,
                                 "contour.h5", SS_H5, &err);
    if (status == SS_OK)
        status = write_plot("contour.gp", coefficients, signal, column, &err);
    if (status == SS_OK)
        printf("%zu samples, %zu scales from %.3g to %.3g Hz, max |W| = %.3g\n", signal->n,
               coefficients->n_scales, coefficients->scale[0].f,
               coefficients->scale[coefficients->n_scales - 1].f, ss_coefficients_max(coefficients));
    else
        fprintf(stderr, "contour: %s\n", err.text[0] != '\0' ? err.text : ss_strerror(status));

    ss_coefficients_free(coefficients);
    ss_signal_free(signal);
    return status != SS_OK;
}
