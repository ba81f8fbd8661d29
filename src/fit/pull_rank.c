/* pull_rank.c -- rank scenes of pulled sliders by the slips in the force of the spring.
 *
 * A scene represents all rigs within the spread of its parameters.  Each scene is fitted to the same
 * samples by simulation, whatever its model, so that their residuals can be compared.  Of all masses,
 * stiffnesses and speeds with the same motion, those with the least change are chosen. */
#include "fit/pulled.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/number.h"
#include "base/progress.h"
#include "scene/model.h"

/* A scene and its fit to the falls. */
typedef struct trial {
    pulled_fit fit;
    double distance, error;     /* rms change of its numbers, and the error of this */
    const char *most_name;      /* the number that is farthest beyond the spread, by the falls alone, */
    double beyond;              /* its distance from the spread, in errors, */
    double most;                /* and its change, as a logarithm */
    int explains;               /* the falls */
    int near;                   /* it explains them within the spread */
    int rings;                  /* it does not as its contact still rings when the next slip begins */
} trial;

/* A number that the fit has changed: by the logarithm of a factor. */
typedef struct change {
    const char *name;
    double by, error;
    double data, data_error;    /* the same by the falls alone, without what the scene knows */
    int power;                  /* see pulled_key */
} change;

static change
change_of_friction(const char *name, ss_number found, double given)
{
    double by = found.value > 0 && given > 0 ? log(found.value / given) : found.value == given ? 0 : INFINITY;
    double error = found.error / found.value;
    return (change){ name, by, error, by, error, 0 };
}

/* Of all rigs with the motion of the fit, which differ in stiffness, find the one that changes least from the
 * scene, which knows its keys to within `known`, and measure its change: as a part of the limit, too. */
static void
measure_change(trial *t, ss_rank_row *row, const ss_scene *scene, double known, double limit)
{
    change c[SS_FIT_KEYS + 3];
    double sum = 0, powers = 1, squares = 0, errors = 0;        /* the stiffness has a power of 1, frictions none */
    size_t n = 0;
    for (; n < t->fit.n_keys; n++) {
        const pulled_key *k = &t->fit.key[n];
        const double precision = 1 / (k->error * k->error), data = precision - 1 / (known * known);
        c[n] = (change){ k->name, k->change, k->error, data > 0 ? k->change * precision / data : 0,
                         data > 0 ? 1 / sqrt(data) : INFINITY, k->power };
        sum += c[n].power * c[n].by;
        powers += c[n].power * c[n].power;
    }
    c[n++] = (change){ "stiffness", 0, 0, 0, 0, 1 };
    c[n++] = change_of_friction("friction", t->fit.friction, scene->friction);
    c[n++] = change_of_friction("static_friction", t->fit.static_friction, static_friction(scene));
    const double stiffer = -sum / powers;
    for (size_t i = 0; i < n; i++) {
        double by = c[i].by + c[i].power * stiffer, data = c[i].data + c[i].power * stiffer;
        double beyond = (fabs(data) - limit) / fmax(c[i].data_error, 1e-9);
        squares += by * by;
        errors += c[i].error * c[i].error;
        if (beyond > t->beyond) {
            t->beyond = beyond;
            t->most = data;
            t->most_name = c[i].name;
        }
    }
    t->distance = sqrt(squares / (double)n);
    t->error = sqrt(errors / (double)n);
    t->near = t->explains && t->beyond <= sqrt(RESIDUE_DECISIVE);
    row->adjusted = t->fit.scene;
    row->adjusted.x0 = 0;
    row->adjusted.stiffness *= exp(stiffer);
    for (size_t i = 0; i < t->fit.n_keys; i++)
        ss_scene_set(&row->adjusted, c[i].name,
                     ss_scene_get(&row->adjusted, c[i].name) * exp(c[i].power * stiffer), NULL);
}

static ss_status
try_scene(trial *t, ss_rank_row *row, const falls *r, const ss_scene *scene, double spread,
          const ss_stretch *progress)
{
    const double known = fmax(log(1 + spread), 1e-6);
    const residue *of = &t->fit.of_samples;
    ss_status st = ss_pulled_fit(&t->fit, r, scene, known, progress);
    if (st != SS_OK)
        return st;
    t->explains = ss_residue_explains(of, r->noise);
    /* Where the contact still rings above the noise when the next slip begins, the next fall depends on the phase
     * of the ringing, which changes fast with the frictions and the contact's frequency.  So a fit may end far
     * from the best one; and the falls need not be settled, as the fit assumes. */
    const ss_scene *s = t->fit.slips ? &t->fit.scene : scene;
    const double stick = 2 * (s->static_friction - s->friction) / fabs(s->stiffness * pull_of(s));
    const double decay = (ss_scene_get(s, "contact_damping") + s->damping) / (2 * s->mass);
    const double above = log(r->power / fmax(r->noise, RESIDUE_QUIET * r->power)) / 2;
    t->rings = !t->explains && s->model->has_contact && decay * stick < above;
    t->distance = NAN;
    row->adjusted = *scene;
    if (t->fit.slips)
        measure_change(t, row, scene, known, log((1 + spread) / (1 - spread)));
    for (size_t i = 0; i < SS_CRITERIA; i++)
        row->value[i] = NAN;
    row->explained = 1 - of->left / of->power;
    row->excess = ss_residue_excess(of, r->noise);
    row->value[SS_BY_RESIDUAL] = 10 * log10(fmax(of->left / of->power, 1e-12));
    row->value[SS_BY_ADJUSTMENT] = t->distance;
    row->distance[SS_BY_ADJUSTMENT] = spread > 0 ? t->distance / log(1 + spread) : 0;
    return SS_OK;
}

/* --- the verdict --------------------------------------------------------------------------- */

/* Does a scene within the spread explain the falls, and leave as little as `least` does, to within the error? */
static int
is_equal(const trial *t, const trial *least, double noise)
{
    return t->near && ss_residue_equals(&t->fit.of_samples, &least->fit.of_samples, noise);
}

/* Write the reason if no scene within the spread explains the falls. */
static void
refuse(ss_ranking *r, const trial *t, double noise)
{
    const trial *best = &t[0];
    for (size_t i = 1; i < r->n; i++)
        best = t[i].explains > best->explains
               || (t[i].explains == best->explains && t[i].fit.of_samples.left < best->fit.of_samples.left)
            ? &t[i] : best;
    const residue *of = &best->fit.of_samples;
    r->verdict = SS_NONE_FITS;
    if (!best->fit.slips)
        snprintf(r->why, sizeof r->why, "none of the scenes sticks and slips");
    else if (!best->explains)
        ss_print_to(r->why, sizeof r->why, "within the spread each scene leaves at least %.3g %% of the power of "
                    "the falls, %.3g times the noise", 100 * of->left / of->power, ss_residue_excess(of, noise));
    else if (isinf(best->most))
        snprintf(r->why, sizeof r->why, "%s friction explains the falls, but the scene would need another %s",
                 ss_model_name(best->fit.scene.model), best->most_name);
    else
        ss_print_to(r->why, sizeof r->why, "%s friction explains the falls, but the scene would need %.3g "
                    "times its %s", ss_model_name(best->fit.scene.model), exp(best->most), best->most_name);
}

/* Name a scene; n: none, and r->why says why not.  No scene may be named while another may explain the falls
 * as well: one whose fit is not the best it could have, one of another law, one that is as near. */
static size_t
name_scene(ss_ranking *r, const trial *t, double noise)
{
    const size_t n = r->n;
    size_t least = n, nearest;
    for (size_t i = 0; i < n; i++) {
        const char *model = ss_model_name(r->row[i].adjusted.model);
        if (t[i].rings)
            snprintf(r->why, sizeof r->why, "the contact of a scene with %s friction rings from slip to slip, "
                     "and has many fits: whether it explains the falls is not known", model);
        else if (t[i].fit.unfinished && !t[i].explains)
            ss_print_to(r->why, sizeof r->why, "a scene with %s friction is too stiff: it takes more than %.0e "
                        "integration steps to be adjusted", model, PULLED_BUDGET);
        if (r->why[0] != '\0')
            return n;
    }
    for (size_t i = 0; i < n; i++)
        if (t[i].near && (least == n || t[i].fit.of_samples.left < t[least].fit.of_samples.left))
            least = i;
    if (least == n) {
        refuse(r, t, noise);
        return n;
    }
    nearest = least;
    for (size_t i = 0; i < n; i++) {
        if (!is_equal(&t[i], &t[least], noise))
            continue;
        if (t[i].fit.scene.model != t[least].fit.scene.model || t[i].fit.n_keys != t[least].fit.n_keys) {
            snprintf(r->why, sizeof r->why, "%s and %s friction%s explain the falls equally well",
                     ss_model_name(t[least].fit.scene.model), ss_model_name(t[i].fit.scene.model),
                     t[i].fit.scene.damping > 0 ? ", with damping," : "");
            return n;
        }
        nearest = t[i].distance < t[nearest].distance ? i : nearest;
    }
    for (size_t i = 0; i < n; i++)
        if (i != nearest && is_equal(&t[i], &t[least], noise)
            && t[i].distance - t[nearest].distance < sqrt(RESIDUE_DECISIVE) * t[nearest].error) {
            snprintf(r->why, sizeof r->why, "two scenes are equally near to the slips, within their errors");
            return n;
        }
    r->verdict = SS_NAMED;
    return nearest;
}

ss_status
ss_pull_compare(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
                const ss_rank_opts *opts, ss_error *err)
{
    ss_features *features = NULL;
    trial *t = NULL;
    double least = INFINITY;
    falls f;
    const ss_scene *first = &scene[r->row[0].scene];
    for (size_t i = 0; i < r->n; i++) {
        const ss_scene *s = &scene[r->row[i].scene];
        ss_status st = ss_pull_check(signal, column, s, opts, err);
        if (st != SS_OK)
            return st;
        if (pull_of(s) * pull_of(first) < 0)
            return ss_fail(err, SS_EINVAL, "scenes that are pulled to either side are not compared");
    }
    ss_status st = ss_features_find(&features, signal, column, NULL, err);
    if (st != SS_OK)
        return st;
    st = ss_falls_gather(&f, r->why, sizeof r->why, features, signal, column, first);
    r->noise = f.noise / f.power;
    const size_t n = r->why[0] == '\0' ? r->n : 0;      /* scenes that are compared */
    if (st == SS_OK && n > 0)
        st = (t = calloc(n, sizeof *t)) != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        const ss_stretch part = { opts->progress, (double)i / (double)n, (double)(i + 1) / (double)n };
        st = try_scene(&t[i], &r->row[i], &f, &scene[r->row[i].scene], opts->spread, &part);
        least = fmin(least, r->row[i].value[SS_BY_RESIDUAL]);
    }
    for (size_t i = 0; st == SS_OK && i < n; i++)
        r->row[i].distance[SS_BY_RESIDUAL] = r->row[i].value[SS_BY_RESIDUAL] - least;
    if (st == SS_OK && n > 0) {
        const size_t at = name_scene(r, t, f.noise), named = at < n ? r->row[at].scene : SIZE_MAX;
        ss_ranking_sort(r);
        for (size_t i = n; i-- > 1;)                    /* to the front */
            if (r->row[i].scene == named) {
                const ss_rank_row row = r->row[i];
                r->row[i] = r->row[i - 1];
                r->row[i - 1] = row;
            }
    }
    if (st != SS_OK)
        ss_fail(err, st, "%s", ss_strerror(st));
    free(t);
    ss_falls_free(&f);
    ss_features_free(features);
    return st;
}
