/* signal.c -- a motion as a signal. */
#include <stickslip/sim.h>

#include <string.h>
#include "base/error.h"
#include "scene/model.h"

static const struct { const char *name, *unit; } column[SS_SIM_COLUMNS] = {
    { "x", "m" }, { "v", "m/s" }, { "a", "m/s^2" }, { "f", "N" }, { "s", "N" }, { "y", "m" },
    { "z", "m" }, { "mode", "" }
};

ss_status
ss_sim_columns_parse(ss_sim_columns *out, const char *list, ss_error *err)
{
    if (out == NULL || list == NULL)
        return SS_FAIL_NULL(err);
    ss_sim_columns columns = { 0 };
    for (const char *name = list;; name++) {
        size_t length = strcspn(name, ",");
        int c = 0, repeated = 0, is_time = name == list && length == 1 && *name == 't';
        while (c < SS_SIM_COLUMNS && (strlen(column[c].name) != length
                                      || strncmp(name, column[c].name, length) != 0))
            c++;
        for (size_t i = 0; i < columns.n; i++)
            repeated |= columns.pick[i] == c;
        if (!is_time && (c == SS_SIM_COLUMNS || repeated))
            return ss_fail(err, SS_EINVAL, repeated ? "'%.*s' is there twice in '%s'"
                           : "'%.*s' in '%s' is none of t (which comes first), x, v, a, f, s, y, "
                           "z, mode", (int)length, name, list);
        if (is_time)
            columns.has_time = 1;
        else
            columns.pick[columns.n++] = c;
        name += length;
        if (*name == '\0')
            break;
    }
    if (columns.n == 0)
        return ss_fail(err, SS_EINVAL, "a signal needs a column besides t");
    *out = columns;
    return SS_OK;
}

void
ss_sim_rows(const ss_sim_columns *columns, const ss_sample *s, size_t n, double *const to[])
{
    if (columns == NULL || s == NULL || to == NULL)
        return;
    for (size_t i = 0; i < n; i++, s++) {
        const double value[SS_SIM_COLUMNS] = { s->x, s->v, s->a, s->f, s->s, s->y, s->z, s->mode };
        for (size_t c = 0; c < columns->n; c++)
            to[c][i] = value[columns->pick[c]] + 0.0;   /* no -0 */
    }
}

/* Add the scene as notes, without the rate, which every header has. */
static ss_status
note_scene(ss_header *head, const ss_scene *scene, ss_error *err)
{
    ss_status st = SS_OK;
    const scene_key *k;
    char room[SS_NUMBER_MAX];
    for (size_t i = 0; st == SS_OK && (k = ss_key_next(scene, &i)) != NULL;)
        if (strcmp(k->name, "rate") != 0)
            st = ss_header_note(head, k->name, ss_value_text(scene, k, room), err);
    if (st == SS_OK && scene->base != NULL && *scene->base->cksum != '\0')
        st = ss_header_note(head, "base_cksum", scene->base->cksum, err);
    return st;
}

ss_status
ss_sim_header(ss_header **out, const ss_scene *scene, const ss_sim_columns *columns, ss_error *err)
{
    if (out == NULL || scene == NULL || columns == NULL)
        return SS_FAIL_NULL(err);
    ss_header *head = NULL;
    ss_status st = ss_scene_check(scene, err);
    if (st == SS_OK)
        st = ss_header_new(&head, scene->rate, 0, err);
    if (st != SS_OK)
        return st;
    head->has_time = columns->has_time;
    st = note_scene(head, scene, err);
    for (size_t i = 0; st == SS_OK && i < columns->n; i++)
        st = ss_header_add_column(head, column[columns->pick[i]].name, column[columns->pick[i]].unit, err);
    if (st == SS_OK)
        *out = head;
    else
        ss_header_free(head);
    return st;
}

struct collector {
    ss_sim_columns columns;
    size_t n, i;                /* samples, and the next */
    double *values;
};

static int
collect(const ss_sample *s, size_t n, void *user)
{
    struct collector *c = user;
    double *to[SS_SIM_COLUMNS];
    for (size_t k = 0; k < c->columns.n; k++)
        to[k] = c->values + k * c->n + c->i;
    ss_sim_rows(&c->columns, s, n, to);
    c->i += n;
    return 0;
}

ss_status
ss_sim_signal(ss_signal **out, const ss_scene *scene, ss_error *err)
{
    if (out == NULL)
        return SS_FAIL_NULL(err);
    struct collector c = { .columns = { 1, 5, { 0, 1, 2, 3, 4 } } };
    ss_header *head = NULL;
    ss_signal *signal = NULL;
    ss_status st = ss_sim_header(&head, scene, &c.columns, err);
    if (st == SS_OK)
        st = ss_signal_new(&signal, head, ss_scene_samples(scene), err);
    ss_header_free(head);
    if (st != SS_OK)
        return st;
    c.n = signal->n;
    c.values = signal->values;
    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
    opts.samples = collect;
    opts.user = &c;
    st = ss_sim_run(scene, &opts, NULL, err);
    if (st == SS_OK)
        *out = signal;
    else
        ss_signal_free(signal);
    return st;
}
