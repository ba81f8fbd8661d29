/* backbone_write.c -- free decays as text and as scenes. */
#include "fit/backbone.h"

#include <math.h>
#include <string.h>
#include "base/error.h"
#include "io/record.h"

int
ss_motion_order(const char *unit, double *size)
{
    char dimension;
    int per_time;
    double is = strcmp(unit, "g") == 0 ? 9.80665 : ss_unit_size(unit, &dimension, &per_time);
    if (strcmp(unit, "g") == 0)
        dimension = 'm', per_time = 2;
    *size = is > 0 && dimension == 'm' ? is : 0;
    return is > 0 && dimension != 'N' ? per_time : -1;
}

/* Write the mechanism and its numbers, or why there is no decay. */
static void
write_mechanism(struct rows *rows, const ss_backbone *b)
{
    char names[128] = "", text[256];        /* longer than all names */
    for (size_t i = 0; i < b->n_mechanisms; i++)
        ss_verdict_append(names, sizeof names, ss_mechanism_names[b->mechanism[i]]);
    snprintf(text, sizeof text, "%s%s", b->why != NULL ? "none: " : b->n_mechanisms > 1 ? "cannot tell: " : "",
             b->why != NULL ? b->why : b->n_mechanisms > 0 ? names : "other");
    ss_rows_whole_word(rows, b->why != NULL ? "decay" : "mechanism", text);
    if (b->why != NULL)
        return;
    if (b->other != NULL)
        ss_rows_whole_word(rows, "other", b->other);
    for (size_t i = 0; i < b->n_numbers; i++)
        ss_rows_whole_value(rows, b->number[i].name, b->number[i].value, b->number[i].unit, 0);
}

static void
write_row(struct rows *rows, const ss_backbone *b, const ss_backbone_row *r, const char *unit, double start)
{
    ss_rows_number(rows, "amplitude", unit, r->amplitude);
    ss_rows_value(rows, "frequency", "Hz", r->frequency);
    ss_rows_value(rows, "damping_ratio", "", r->damping_ratio);
    ss_rows_number(rows, "t", "s", start + r->t);
    ss_rows_number(rows, "periods", "", r->periods);
    if (!rows->format->has_notes)
        write_mechanism(rows, b);
    ss_rows_end(rows);
}

ss_status
ss_backbone_write(const ss_backbone *b, const ss_signal *signal, size_t column, FILE *out, ss_format format,
                  ss_error *err)
{
    static const char *const own[] = {
        "decay", "mechanism", "other", "frequency", "damping_ratio", "friction*", "drag_over_mass",
        "contact_stiffness*", "slip_amplitude", "exponent", "microslip_damping", "softening", "chi2_dof",
        "amplitude_*", "noise", "rate", "start", "columns", NULL };
    struct rows rows;
    char number[SS_NUMBER_MAX];
    if (b == NULL || signal == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    if (column >= signal->head->n_columns)
        return ss_fail_column(err, column, signal->head->n_columns);
    ss_status st = ss_rows_begin(&rows, out, format, SS_KIND_BACKBONE, err);
    if (st != SS_OK)
        return st;
    const char *unit = signal->head->column[column].unit;
    if (strcmp(unit, "dB") == 0)
        unit = "";              /* amplitudes are those of the levels */
    const ss_backbone_row none = { NAN, NAN, { NAN, NAN }, { NAN, NAN }, NAN, { NAN, NAN } };
    ss_rows_notes(&rows, signal->head, own);
    if (rows.format->has_notes)
        write_mechanism(&rows, b);
    if (b->why == NULL) {
        ss_rows_note(&rows, "chi2_dof: %s", ss_number_rounded(number, b->chi2_dof, 4));
        ss_rows_note(&rows, "amplitude_start: %s %s", ss_number_text(number, b->row[0].amplitude), b->start);
        ss_rows_note(&rows, "amplitude_stop: %s %s", ss_number_text(number, b->row[b->n - 1].amplitude), b->stop);
        ss_rows_note(&rows, "noise: %s", ss_number_text(number, b->noise));
    }
    write_row(&rows, b, &none, unit, 0);
    for (size_t i = 0; i < b->n; i++)
        write_row(&rows, b, &b->row[i], unit, signal->head->start);
    if (b->n == 0 && !rows.format->has_notes)
        write_row(&rows, b, &none, unit, 0);
    return ss_rows_finish(&rows, err);
}

static double
number_of(const ss_backbone *b, const char *name)
{
    for (size_t i = 0; i < b->n_numbers; i++)
        if (strcmp(b->number[i].name, name) == 0)
            return b->number[i].value.value;
    return 0;
}

ss_status
ss_backbone_scene(ss_scene *scene, const ss_backbone *b, const ss_signal *signal, size_t column, double mass,
                  ss_error *err)
{
    if (scene == NULL || b == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    if (column >= signal->head->n_columns)
        return ss_fail_column(err, column, signal->head->n_columns);
    double size;
    const int order = ss_motion_order(signal->head->column[column].unit, &size);
    if (b->n_mechanisms != 1)
        return ss_fail(err, SS_EDATA, "no scene: %s", b->why != NULL ? b->why : b->other != NULL
                       ? b->other : "the mechanism cannot be told");
    if (b->mechanism[0] == SS_MICROSLIP || b->mechanism[0] == SS_QUADRATIC)
        return ss_fail(err, SS_EDATA, "no scene: no model has %s friction", ss_mechanism_names[b->mechanism[0]]);
    if (!(size > 0) || !(mass > 0) || number_of(b, "frequency") == 0)
        return ss_fail(err, SS_EDATA, "no scene: it needs a length, a speed or an acceleration, and a mass > 0");
    double w = 2 * M_PI * number_of(b, "frequency"), stiffness = mass * w * w;
    double contact = stiffness * number_of(b, "contact_stiffness_ratio");
    double slip = size * number_of(b, "slip_amplitude") * pow((stiffness + contact) / mass, -order / 2.);
    *scene = (ss_scene){
        .model = ss_model_named(contact > 0 ? "compliant" : "coulomb"), .mass = mass, .stiffness = stiffness,
        .damping = 2 * mass * w * number_of(b, "damping_ratio"),
        .v0 = size * b->row[0].amplitude * pow(2 * M_PI * b->row[0].frequency.value, 1 - order),
        .friction = contact > 0 ? contact * slip
            : size * stiffness * number_of(b, "friction_over_stiffness") * pow(w, -order),
        .duration = b->row[b->n - 1].t - b->row[0].t, .rate = signal->head->rate };
    if (contact > 0) {
        ss_status st = ss_scene_set(scene, "contact_stiffness", contact, err);
        return st != SS_OK ? st : ss_scene_set(scene, "contact_damping", 0, err);
    }
    return SS_OK;
}
