/* stiffness.c -- from an acceleration to the stiffness and damping of the contact.
 *
 *     cc stiffness.c $(pkg-config --cflags --libs stickslip gsl) -lm -o stiffness
 *     ./stiffness run.csv accel 2.42 2310
 *
 * Finds the transitions of a column.  Mass [kg] and stiffness of the spring [N/m] are those of the rig.  A
 * number that is not known is NaN, and why_ringing says why. */
#include <stickslip.h>

#include <math.h>
#include <stdio.h>

static void
print(const char *name, ss_number number, const char *unit)
{
    if (isnan(number.value))
        printf("%s: not known\n", name);
    else
        printf("%s: %.6g, standard error %.1g%s\n", name, number.value, number.error, unit);
}

static void
print_features(const ss_features *f)
{
    printf("%zu transitions\n", f->n);
    print("frequency", f->number[SS_TRANSITION_FREQUENCY], " Hz");
    print("contact stiffness", f->number[SS_CONTACT_STIFFNESS], " N/m");
    print("contact damping", f->number[SS_CONTACT_DAMPING], " N s/m");
    if (f->number[SS_TRANSITION_FREQUENCY].why != NULL)
        printf("%s\n", f->number[SS_TRANSITION_FREQUENCY].why);
}

int
main(int argc, char *argv[])
{
    ss_signal *signal = NULL;
    ss_features *features = NULL;
    ss_error err = { 0 };
    ss_features_opts opts;
    ss_features_opts_init(&opts, sizeof opts);
    char *rest[2] = { "", "" };
    if (argc == 5) {
        opts.mass = ss_number_parse(argv[3], &rest[0]);
        opts.stiffness = ss_number_parse(argv[4], &rest[1]);
    }
    if (argc != 5 || *rest[0] != '\0' || *rest[1] != '\0') {
        fputs("usage: stiffness FILE COLUMN MASS STIFFNESS\n", stderr);
        return 2;
    }

    const char *const needed[] = { argv[2] };
    ss_read_opts read;
    ss_read_opts_init(&read, sizeof read);
    read.needed = needed;
    read.n_needed = 1;
    ss_status status = ss_signal_read(&signal, NULL, argv[1], &read, &err);
    int column = status == SS_OK ? ss_header_column(signal->head, argv[2]) : -1;
    if (status == SS_OK && column < 0) {
        snprintf(err.text, sizeof err.text, "%s: no column '%.40s'", argv[1], argv[2]);
        status = SS_EINVAL;
    }
    if (status == SS_OK)
        status = ss_features_find(&features, signal, (size_t)column, &opts, &err);
    if (status == SS_OK)
        print_features(features);
    else
        fprintf(stderr, "stiffness: %s\n", err.text);

    ss_features_free(features);
    ss_signal_free(signal);
    return status != SS_OK;
}
