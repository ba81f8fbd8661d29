/* pull_rank.c -- rank scenes of pulled sliders by the slips in the force of the spring.
 *
 * A scene represents all rigs within the spread of its parameters.  Each scene is fitted to the same
 * samples by simulation, whatever its model, so that their residuals can be compared.  Of all masses,
 * stiffnesses and speeds with the same motion, those with the least change are chosen. */
#include "fit/pull.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/progress.h"
#include "scene/key.h"
#include "scene/model.h"

#define BUDGET 1e7              /* integration steps of one scene */

/* A scene and its fit to the falls. */
typedef struct trial {
    falls_fit fit;
    match match;
    double distance, error;     /* rms change of its numbers, and the error of this */
    const char *most_name;      /* the number that is farthest beyond the spread, by the falls alone, */
    double beyond;              /* its distance from the spread, in errors, */
    double most;                /* and its change, as a logarithm */
    int explains;               /* the falls */
    int near;                   /* it is within the spread */
    int unfinished;             /* its fit took too many steps, so that a better one may exist */
    int rings;                  /* the same as its contact still rings when the next slip begins */
} trial;

enum { CHANGES = FALLS_KEYS + 3 };

typedef struct change {
    const char *name;
    double by, error;           /* logarithms */
    double data, data_error;    /* the same by the falls alone, without what the scene knows */
    int power;                  /* see falls_key */
} change;

static change
change_of_key(const falls_key *k, const ss_scene *scene, double known)
{
    double precision = 1 / (k->error * k->error), data = precision - 1 / (known * known);
    double by = data > 0 ? k->change * precision / data : 0, error = data > 0 ? 1 / sqrt(data) : INFINITY;
    return (change){ ss_pull_key_name(scene, k), k->change, k->error, by, error, k->power };
}

static change
change_of(const char *name, double found, double error, double given)
{
    double by = found > 0 && given > 0 ? log(found / given) : found == given ? 0 : INFINITY;
    return (change){ name, by, error / found, by, error / found, 0 };
}

/* List the numbers that the fit changes in the scene, which knows its keys to within `known`; returns how
 * many there are. */
static size_t
list_changes(change c[CHANGES], const falls_fit *fit, const ss_scene *scene, double known)
{
    const ss_median *f = &fit->friction, *top = &fit->static_friction;
    size_t n = 0;
    for (; n < fit->n_keys; n++)
        c[n] = change_of_key(&fit->key[n], scene, known);
    c[n++] = (change){ "stiffness", 0, 0, 0, 0, 1 };
    c[n++] = change_of("friction", f->value, f->error, scene->friction);
    c[n++] = change_of("static_friction", top->value, top->error, static_friction(scene));
    return n;
}

/* Of all rigs with the motion of the fit, which differ in stiffness, find the one that changes least, and
 * measure its change. */
static void
measure_change(trial *t, ss_rank_row *row, const ss_scene *scene, double known, double limit)
{
    change c[CHANGES];
    double sum = 0, powers = 0, squares = 0, errors = 0;
    size_t n = list_changes(c, &t->fit, scene, known);
    for (size_t i = 0; i < n; i++) {
        sum += c[i].power * c[i].by;
        powers += c[i].power * c[i].power;
    }
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
    t->near = t->beyond <= sqrt(MATCH_DECISIVE);
    row->adjusted = t->fit.scene;
    row->adjusted.x0 = 0;
    row->adjusted.stiffness *= exp(stiffer);
    for (size_t i = 0; i < t->fit.n_keys; i++)
        *ss_scene_number(&row->adjusted, c[i].name, NULL, NULL) *= exp(c[i].power * stiffer);
}

static void
fill_row(ss_rank_row *row, const trial *t, double noise, double spread)
{
    for (size_t i = 0; i < SS_CRITERIA; i++)
        row->value[i] = NAN;
    row->explained = 1 - t->match.left / t->match.power;
    row->excess = ss_match_excess(&t->match, noise);
    row->value[SS_BY_RESIDUAL] = 10 * log10(fmax(t->match.left / t->match.power, 1e-12));
    row->value[SS_BY_ADJUSTMENT] = t->distance;
    row->distance[SS_BY_ADJUSTMENT] = spread > 0 ? t->distance / log(1 + spread) : 0;
}

/* Does the contact still ring, above the noise, when the next slip begins?  Then the next fall depends on the
 * phase of the ringing, which changes fast with the frictions and the contact's frequency.  So a fit may end
 * far from the best one; and the falls need not be settled, as the fit assumes. */
static int
rings_on(const ss_scene *s, const falls *r)
{
    double stick = 2 * (s->static_friction - s->friction) / fabs(s->stiffness * pull_of(s));
    double decay = (s->contact_damping + s->damping) / (2 * s->mass);
    double noise = fmax(r->noise, MATCH_QUIET * r->power);
    return ss_model_of(s)->has_contact && decay * stick < 0.5 * log(r->power / noise);
}

static ss_status
try_scene(trial *t, ss_rank_row *row, const falls *r, const ss_scene *scene, double spread,
          const ss_stretch *progress, ss_error *err)
{
    const double known = fmax(log(1 + spread), 1e-6);
    double steps = 0;
    ss_status st = ss_falls_fit(&t->fit, r, scene, known, BUDGET, &steps, progress);
    t->match = ss_pull_match(r, &t->fit);
    t->explains = ss_match_explains(&t->match, r->noise);
    t->unfinished = steps > BUDGET && !t->explains;
    t->rings = !t->explains && rings_on(t->fit.slips ? &t->fit.scene : scene, r);
    if (st != SS_OK)
        return ss_fail(err, st, "%s", ss_strerror(st));
    t->distance = NAN;
    row->adjusted = *scene;
    if (t->fit.slips)
        measure_change(t, row, scene, known, log((1 + spread) / (1 - spread)));
    fill_row(row, t, r->noise, spread);
    return SS_OK;
}

static int
is_same_law(const trial *a, const trial *b)
{
    return a->fit.scene.model == b->fit.scene.model && a->fit.n_keys == b->fit.n_keys;
}

/* Does a leave no more than b, to within the error? */
static int
leaves_as_little(const trial *a, const trial *b, double noise)
{
    return (double)a->match.compared * (ss_match_excess(&a->match, noise) - ss_match_excess(&b->match, noise))
        < MATCH_DECISIVE;
}

/* Say that no scene explains the falls, or why none of those that explain them is named. */
static void
refuse(ss_ranking *r, const trial *t, double noise)
{
    const trial *best = &t[0];
    r->verdict = SS_NONE_FITS;
    for (size_t i = 1; i < r->n; i++)
        best = t[i].explains > best->explains || (t[i].explains == best->explains
                                                  && t[i].match.left < best->match.left) ? &t[i] : best;
    if (!best->fit.slips)
        snprintf(r->why, sizeof r->why, "none of the scenes sticks and slips");
    else if (!best->explains)
        snprintf(r->why, sizeof r->why, "within the spread each scene leaves at least %.3g %% of the power of "
                 "the falls, %.3g times the noise", 100 * best->match.left / best->match.power,
                 ss_match_excess(&best->match, noise));
    else
        snprintf(r->why, sizeof r->why, "%s friction explains the falls, but the scene would need %.3g "
                 "times its %s", ss_model_name(best->fit.scene.model), exp(best->most), best->most_name);
}

/* Does a scene exist of which it is not known whether it explains the falls?  Then no other may be named. */
static int
has_unknown(ss_ranking *r, const trial *t)
{
    for (size_t i = 0; i < r->n; i++) {
        const char *model = ss_model_name(r->row[i].adjusted.model);
        if (t[i].rings)
            snprintf(r->why, sizeof r->why, "the contact of a scene with %s friction rings from slip to slip, "
                     "and has many fits: whether it explains the falls is not known", model);
        else if (t[i].unfinished)
            snprintf(r->why, sizeof r->why, "a scene with %s friction is too stiff: it takes more than %.0e "
                     "integration steps to be adjusted", model, BUDGET);
        if (t[i].rings || t[i].unfinished)
            return 1;
    }
    return 0;
}

/* Does a scene within the spread explain the falls, and leave as little as `least` does? */
static int
is_equal(const trial *t, const trial *least, double noise)
{
    return t->explains && t->near && leaves_as_little(t, least, noise);
}

/* Of the scenes within the spread that explain the falls, the one that leaves least; n: none does. */
static size_t
find_least(const trial *t, size_t n)
{
    size_t least = n;
    for (size_t i = 0; i < n; i++)
        if (t[i].explains && t[i].near && (least == n || t[i].match.left < t[least].match.left))
            least = i;
    return least;
}

/* Does another law explain the falls as well as scene `least`?  Then r->why says so. */
static int
has_rival(ss_ranking *r, const trial *t, size_t least, double noise)
{
    size_t i = 0;
    while (i < r->n && (!is_equal(&t[i], &t[least], noise) || is_same_law(&t[i], &t[least])))
        i++;
    if (i == r->n)
        return 0;
    snprintf(r->why, sizeof r->why, "%s and %s friction%s explain the falls equally well",
             ss_model_name(t[least].fit.scene.model), ss_model_name(t[i].fit.scene.model),
             t[i].fit.scene.damping > 0 ? ", with damping," : "");
    return 1;
}

/* The scene that is named; r->n: none, and why. */
static size_t
name_scene(ss_ranking *r, const trial *t, double noise)
{
    if (has_unknown(r, t))
        return r->n;
    const size_t least = find_least(t, r->n);
    if (least == r->n) {
        refuse(r, t, noise);
        return r->n;
    }
    if (has_rival(r, t, least, noise))
        return r->n;
    size_t nearest = least;
    for (size_t i = 0; i < r->n; i++)
        if (is_equal(&t[i], &t[least], noise) && t[i].distance < t[nearest].distance)
            nearest = i;
    for (size_t i = 0; i < r->n; i++)
        if (i != nearest && is_equal(&t[i], &t[least], noise)
            && t[i].distance - t[nearest].distance < sqrt(MATCH_DECISIVE) * t[nearest].error) {
            snprintf(r->why, sizeof r->why, "two scenes are equally near to the slips, within their errors");
            return r->n;
        }
    r->verdict = SS_NAMED;
    return nearest;
}

static ss_status
check_scenes(const ss_signal *signal, size_t column, const ss_scene *scene, size_t n,
             const ss_rank_opts *opts, ss_error *err)
{
    for (size_t i = 0; i < n; i++) {
        ss_status st = ss_pull_check(signal, column, &scene[i], opts, err);
        if (st != SS_OK)
            return st;
        if (pull_of(&scene[i]) * pull_of(&scene[0]) < 0)
            return ss_fail(err, SS_EINVAL, "scenes that are pulled to either side are not compared");
    }
    return SS_OK;
}

static ss_status
compare_all(ss_ranking *r, size_t *named, const falls *f, const ss_scene *scene, const ss_rank_opts *opts,
            ss_error *err)
{
    trial *t = calloc(r->n, sizeof *t);
    double least = INFINITY;
    ss_status st = t != NULL ? SS_OK : ss_fail_memory(err, NULL);
    for (size_t i = 0; st == SS_OK && i < r->n; i++) {
        const ss_stretch part = { opts->progress, (double)i / (double)r->n, (double)(i + 1) / (double)r->n };
        st = try_scene(&t[i], &r->row[i], f, &scene[i], opts->spread, &part, err);
        least = fmin(least, r->row[i].value[SS_BY_RESIDUAL]);
    }
    for (size_t i = 0; st == SS_OK && i < r->n; i++)
        r->row[i].distance[SS_BY_RESIDUAL] = r->row[i].value[SS_BY_RESIDUAL] - least;
    if (st == SS_OK)
        *named = name_scene(r, t, f->noise);
    free(t);
    return st;
}

ss_status
ss_pull_compare(ss_ranking *r, size_t *named, const ss_signal *signal, size_t column,
                const ss_scene *scene, const ss_rank_opts *opts, ss_error *err)
{
    ss_features *features = NULL;
    falls f = { .y = NULL };
    *named = r->n;
    ss_status st = check_scenes(signal, column, scene, r->n, opts, err);
    if (st == SS_OK)
        st = ss_features_find(&features, signal, column, NULL, err);
    if (st != SS_OK)
        return st;
    if (!ss_pull_lacks_falls(r->why, sizeof r->why, features, signal, column, &scene[0])) {
        st = ss_falls_gather(&f, features, signal, column, sign(pull_of(&scene[0])));
        r->noise = f.noise / f.power;
        if (st != SS_OK)
            ss_fail(err, st, "%s", ss_strerror(st));
        else if (f.n < PULL_FEWEST)
            snprintf(r->why, sizeof r->why, "%zu falls that are whole are too few", f.n);
        else
            st = compare_all(r, named, &f, scene, opts, err);
    }
    ss_falls_free(&f);
    ss_features_free(features);
    return st;
}
