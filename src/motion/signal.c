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
ss_sim_row(const ss_sim_columns *columns, const ss_sample *s, double *row)
{
    if (columns == NULL || s == NULL || row == NULL)
        return;
    const double value[SS_SIM_COLUMNS] = { s->x, s->v, s->a, s->f, s->s, s->y, s->z, s->mode };
    for (size_t i = 0; i < columns->n; i++)
        row[i] = value[columns->pick[i]] + 0.0;         /* no -0 */
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
    const ss_sim_columns *columns;
    ss_signal *signal;
    size_t i;
};

static int
collect(const ss_sample *s, size_t n, void *user)
{
    struct collector *c = user;
    double row[SS_SIM_COLUMNS];
    for (size_t k = 0; k < n; k++, c->i++) {
        ss_sim_row(c->columns, &s[k], row);
        for (size_t j = 0; j < c->columns->n; j++)
            c->signal->values[j * c->signal->n + c->i] = row[j];
    }
    return 0;
}

ss_status
ss_sim_signal(ss_signal **out, const ss_scene *scene, ss_error *err)
{
    if (out == NULL)
        return SS_FAIL_NULL(err);
    const ss_sim_columns columns = { 1, 5, { 0, 1, 2, 3, 4 } };
    struct collector c = { &columns, NULL, 0 };
    ss_header *head = NULL;
    ss_status st = ss_sim_header(&head, scene, &columns, err);
    if (st == SS_OK)
        st = ss_signal_new(&c.signal, head, ss_scene_samples(scene), err);
    ss_header_free(head);
    if (st != SS_OK)
        return st;
    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
    opts.samples = collect;
    opts.user = &c;
    st = ss_sim_run(scene, &opts, NULL, err);
    if (st == SS_OK)
        *out = c.signal;
    else
        ss_signal_free(c.signal);
    return st;
}
