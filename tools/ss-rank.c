/* ss-rank -- which friction model explains a signal, criterion by criterion; or the scene that
 * fits. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "options.h"

static const char usage[] =
"usage: ss-rank [options] [SIGNAL [SCENE...]]\n"
"       ss-rank --motion=NAME --column=NAME [options] [RECORDING]\n"
"       ss-rank --load=NAME --column=NAME [options] [RECORDING]\n"
"Say which scene explains a signal; which law a force follows, driven by the\n"
"motion beside it; or rate and state of a friction, from steps of its load.\n"
"  -c, --column=NAME|N   the signal, the force, or the friction\n"
"  -a, --as=QUANTITY     the signal is x, v, a, f or s, the spring's force; the\n"
"                        motion is x or v (default: by unit or name)\n"
"  -s, --set=KEY=VALUE   in place of every scene's own; repeatable\n"
"  -p, --spread=PERCENT  how far parameters may be from a scene's (30)\n"
"  -F, --forcing=HZ      frequency of the base (default: found)\n"
"  -l, --long            every criterion of each scene, and what was compared\n"
"      --fit             write the scene that moves as the signal does\n"
"  -m, --motion=NAME|N   the motion: --extra=sin,cos, --delay=ROWS, --folds=HOW\n"
"      --residual=FILE   what the law leaves, row by row\n"
"      --load=NAME|N     the load point; --normal-stress=NAME|N: of shear stress;\n"
"                        --share: all steps have one a, b, Dc and stiffness\n"
TOOL_READING_USAGE
"  -o, --output=FILE     .tsv, .csv, .json; --format=tsv|csv|json of stdout; with\n"
"                        --motion or --load a picture: .gp .png .svg .pdf .eps\n"
"  -q, --quiet           no progress; -v, --verbose: what was done\n"
"  -h, --help            show this text; --version: show the version\n";

typedef struct job {
    const char *signal_path, *column_name, *known_by, *output, *load, *normal;
    char *signal_name;
    int all, as, fits, shared;          /* all: criteria; as: of ss_quantity_names; -1: not given */
    tool_texts settings;
    const char **scenes;
    size_t n_scenes;
    tool_kind kind;
    tool_reading reading;
    ss_rank_opts opts;
    const char *motion, *extra, *residual;
    ss_motion_opts motion_opts;
} job;

/* Begin a picture under the signal's name. */
static FILE *
begin_picture(const job *j, ss_plot_opts *opts)
{
    ss_plot_opts_init(opts, sizeof *opts);
    opts->title = j->signal_name;
    return tool_draw(j->output, opts);
}

/* --- the quantity -------------------------------------------------------------------------- */

/* The quantity of a unit; -1: none. */
static int
quantity_of_unit(const char *unit)
{
    char dimension;
    int per_time;
    if (ss_unit_size(unit, &dimension, &per_time) == 0)
        return -1;
    return dimension != 'N' ? SS_DISPLACEMENT + per_time : per_time == 0 ? SS_FORCE : -1;
}

/* The quantity that the name of a column is, or that a word of it shows, in upper or lower case, as in
 * friction_force_kip; -1: none does. */
static int
quantity_of_name(const char *name)
{
    static const struct { const char *word; ss_quantity is; } known[] = {
        { "displacement", SS_DISPLACEMENT }, { "position", SS_DISPLACEMENT },
        { "velocity", SS_VELOCITY }, { "speed", SS_VELOCITY },
        { "acceleration", SS_ACCELERATION }, { "acc", SS_ACCELERATION },
        { "force", SS_FORCE } };
    for (int i = 0; ss_quantity_names[i] != NULL; i++)
        if (strcmp(name, ss_quantity_names[i]) == 0)
            return i;
    if (strcmp(name, "F") == 0)
        return SS_FORCE;
    for (size_t length; *name != '\0'; name += length + (name[length] != '\0')) {
        length = strcspn(name, "_ -./()[]");
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            if (strlen(known[i].word) == length && strncasecmp(name, known[i].word, length) == 0)
                return (int)known[i].is;
    }
    return -1;
}

/* The quantity of a column; *by becomes the reason for it. */
static ss_quantity
quantity_of(const ss_column *column, int as, const char **by)
{
    int found = -1;
    *by = "--as";
    if (as >= 0)
        return (ss_quantity)as;
    *by = "its name";
    if ((found = quantity_of_name(column->name)) >= 0)
        return (ss_quantity)found;
    *by = "its unit";
    if ((found = quantity_of_unit(column->unit)) >= 0)
        return (ss_quantity)found;
    *by = "default";
    if (column->name[0] != '\0')
        tool_warn("column %s is taken as an acceleration; --as says what it is", column->name);
    return SS_ACCELERATION;
}

/* --- work ---------------------------------------------------------------------------------- */

/* Note the result, even if it is not conclusive. */
static void
note_work(const ss_ranking *r, char *const name[], const ss_rank_opts *opts)
{
    if (isnan(r->row[0].total)) {
        tool_note("no scene was adjusted: %s", r->why);
        return;
    }
    if (!isnan(r->forcing_frequency))
        tool_note("base at %.4g Hz, %s; %zu scene%s adjusted to the signal within %.3g %%",
              r->forcing_frequency, opts->forcing_frequency > 0 ? "as given" : "found", r->n,
              tool_s(r->n), 100 * opts->spread);
    for (size_t i = 0; i < r->n && !isnan(r->row[i].total); i++)
        tool_note("%s: total %.4g, leaves %.3g %% of the signal's power, %.3g times the noise",
                  name[r->row[i].scene], r->row[i].total,
                  100 * pow(10, r->row[i].value[SS_BY_RESIDUAL] / 10), r->row[i].excess);
    if (r->n > 1 && !isnan(r->row[1].total))
        tool_note("%s is ahead of %s by %.3g thresholds%s%s", name[r->row[0].scene],
                  name[r->row[1].scene], r->row[1].total - r->row[0].total,
                  r->verdict == SS_NAMED ? "" : ", but ", r->why);
}

static void
rank(const job *j, const ss_signal *signal, size_t column)
{
    ss_scene *scene = tool_room(NULL, j->n_scenes, sizeof *scene);
    char **name = tool_room(NULL, j->n_scenes, sizeof *name);
    ss_ranking *r = NULL;
    for (size_t i = 0; i < j->n_scenes; i++) {
        scene[i] = tool_read_scene(j->scenes[i], &j->settings, "--set");
        name[i] = tool_name_scene(j->scenes[i], &j->settings);
    }
    tool_check(ss_ranking_new(&r, signal, column, scene, j->n_scenes, &j->opts, &tool_error));
    note_work(r, name, &j->opts);
    const ss_ranking_text about = {
        .signal = j->signal_name, .column = signal->head->column[column].name,
        .known_by = j->known_by, .scene = (const char *const *)name, .brief = !j->all };
    tool_check(ss_ranking_write(r, &about, &j->opts, tool_output(j->output), tool_stream(j->kind), &tool_error));
    for (size_t i = 0; i < j->n_scenes; i++)
        free(name[i]);
    free(name);
    free(scene);
    ss_ranking_free(r);
}

static void
fit_contact(const job *j, const ss_signal *signal, size_t column, const ss_scene *start)
{
    ss_fit f;
    tool_check(ss_scene_fit(&f, signal, column, start, &j->opts, &tool_error));
    if (!f.conclusive)
        tool_die("%s: cannot tell: %s", tool_input_name(j->signal_path), f.why);
    FILE *out = tool_output(j->output);
    fprintf(out, "# Compliant contact fitted to %s, column %s.  Mass, stiffness, damping,\n"
            "# static_friction / friction and release rule are those given; standard errors:\n",
            j->signal_name,
            signal->head->column[column].name);
    for (size_t i = 0; i < SS_FIT_KEYS; i++)
        fprintf(out, "#   %-17s %.2g %%\n", f.key[i].name, 100 * f.key[i].found.error / f.key[i].found.value);
    fprintf(out, "# Left of the signal: %.3g %%, and %.3g %% if the motion need not be settled; its noise\n"
            "# is %.3g %%.\n", 100 * f.residual, 100 * f.residual_started, 100 * f.noise);
    if (ss_scene_write(&f.scene, out, NULL) != SS_OK)
        tool_die("write failed");
}

/* --- a pull -------------------------------------------------------------------------------- */

/* Write a median, and beside it the value of the given scene, unless that is NaN. */
static void
write_median(FILE *out, const char *what, ss_number m, const char *unit, double given)
{
    char nominal[64] = "";
    double off = 100 * (m.value / given - 1);
    if (isfinite(given) && given != 0)
        snprintf(nominal, sizeof nominal, "; given: %.4g, %+.0f %%", given, off);
    fprintf(out, "#   %-17s %.4g +- %.2g %s, scatter %.2g%s\n", what, m.value, m.error, unit, m.scatter,
            nominal);
}

static void
warn_of_rig(const char *what, double found, double given, double spread)
{
    if (fabs(found / given - 1) > spread)
        tool_warn("%s of the slips is %.2g times that of the given scene", what, found / given);
}

/* Write the slips of a Coulomb slider without damping, one by one. */
static void
write_slips(FILE *out, const ss_pull *p, const ss_signal *signal, double k_over_m, double loading)
{
    const ss_features *f = p->features;
    fprintf(out, "# %zu of %zu falls of the force are its slips.  Medians, standard errors, and the standard\n"
            "# deviation of the slips; the stiffness is that given, mass and speed follow.\n"
            "# Left of the power of the falls: %.3g %%, %.3g times the noise.\n",
            p->n_slips, f->n, 100 * p->left, p->excess);
    write_median(out, "static_friction", f->number[SS_STATIC_FRICTION], "N", NAN);
    write_median(out, "friction", f->number[SS_FRICTION], "N", NAN);
    write_median(out, "drop", f->number[SS_DROP], "N", NAN);
    write_median(out, "k/m", f->number[SS_K_OVER_M], "1/s^2", k_over_m);
    write_median(out, "loading", f->number[SS_LOADING_SLOPE], "N/s", loading);
    fprintf(out, "# Each slip: onset [s], static_friction [N] and error, friction [N] and error, k/m [1/s^2]\n"
            "# and error:\n");
    for (size_t i = 0; i < f->n; i++) {
        const ss_loading *l = &f->loading[i];
        if (!isnan(l->friction.value))
            fprintf(out, "#   %.4f %.4g %.1g %.4g %.1g %.4g %.1g\n", signal->head->start + f->transition[i].onset,
                    l->static_friction.value, l->static_friction.error, l->friction.value,
                    l->friction.error, l->k_over_m.value, l->k_over_m.error);
    }
}

/* Write the result for another scene: the numbers that all slips share, and the frictions. */
static void
write_common(FILE *out, const ss_pull *p)
{
    fprintf(out, "# %zu of %zu falls of the force, fitted together by simulation: standard errors; of the\n"
            "# frictions medians, and the standard deviation of the slips.  The stiffness%s that given.\n"
            "# Left of the power of the falls: %.3g %%, %.3g times the noise.\n",
            p->n_slips, p->features->n, p->scene.surface_velocity != 0 && p->scene.base_velocity != 0
            ? " and the belt's speed are" : " is", 100 * p->left, p->excess);
    for (size_t i = 0; i < p->n_keys; i++) {
        const ss_fitted *k = &p->key[i];
        fprintf(out, "#   %-17s %.4g +- %.2g %s; given: %.4g, %+.0f %%\n", k->name, k->found.value,
                k->found.error, k->unit, k->given, 100 * (k->found.value / k->given - 1));
    }
    write_median(out, "static_friction", p->static_friction, "N", NAN);
    write_median(out, "friction", p->friction, "N", NAN);
}

static void
warn_of_pull(const ss_pull *p, double k_over_m, double loading, double spread)
{
    if (p->n_keys == 0) {
        warn_of_rig("k/m", p->features->number[SS_K_OVER_M].value, k_over_m, spread);
        warn_of_rig("loading", p->features->number[SS_LOADING_SLOPE].value, loading, spread);
    }
    for (size_t i = 0; i < p->n_keys; i++)
        warn_of_rig(p->key[i].name, p->key[i].found.value, p->key[i].given, spread);
    const ss_number *damping = &p->features->number[SS_SLIP_DAMPING];
    if (p->n_keys == 0 && damping->value > 3 * damping->error)
        tool_warn("the slips show a damping ratio of %.3g +- %.2g: the scene has none", damping->value, damping->error);
    else if (!p->explains && p->n_keys == 0)
        tool_warn("the slips leave %.3g times the noise: friction is not constant in slip, so k/m may be off by "
                  "more than its error", p->excess);
    else if (!p->explains)
        tool_warn("the slips leave %.3g times the noise: friction is not that of the scene, so its numbers may "
                  "be off by more than their errors", p->excess);
}

static void
fit_pull(const job *j, const ss_signal *signal, size_t column, const ss_scene *start)
{
    const double k_over_m = start->stiffness / start->mass;
    const double loading = fabs(start->stiffness * (start->base_velocity - start->surface_velocity));
    ss_pull *p = NULL;
    if (j->opts.quantity != SS_SPRING)
        tool_die("column %s is taken as %s; a pull is fitted to the spring's force, --as s",
                 signal->head->column[column].name, ss_quantity_names[j->opts.quantity]);
    tool_check(ss_pull_fit(&p, signal, column, start, &j->opts, &tool_error));
    if (p->verdict != SS_NAMED)
        tool_die("%s: %s: %s", tool_input_name(j->signal_path),
                 p->verdict == SS_NONE_FITS ? "none of these" : "cannot tell", p->why);
    warn_of_pull(p, k_over_m, loading, j->opts.spread);
    FILE *out = tool_output(j->output);
    fprintf(out, "# Pulled slider with %s friction, fitted to %s, column %s.\n", p->n_keys == 0 ? "Coulomb"
            : ss_model_name(start->model), j->signal_name, signal->head->column[column].name);
    if (p->n_keys == 0)
        write_slips(out, p, signal, k_over_m, loading);
    else
        write_common(out, p);
    if (ss_scene_write(&p->scene, out, NULL) != SS_OK)
        tool_die("write failed");
    ss_pull_free(p);
}

/* --- a motion and a force ------------------------------------------------------------------- */

/* Say what the motion is. */
static void
set_motion(job *j, const ss_column *motion)
{
    char dimension;
    int per_time, of = j->as;
    const double size = ss_unit_size(motion->unit, &dimension, &per_time);
    if (of < 0 && (of = quantity_of_unit(motion->unit)) < 0)
        of = quantity_of_name(motion->name);
    if (of != SS_DISPLACEMENT && of != SS_VELOCITY)
        tool_die("column %s: neither its unit nor its name says whether it is a displacement or a velocity; "
                 "--as=x or --as=v does", motion->name);
    j->motion_opts.is_velocity = of == SS_VELOCITY;
    if (j->extra == NULL)
        return;
    if (size == 0 || dimension != 'r' || per_time > 0)
        tool_usage("--extra=sin,cos needs an angle, in rad or deg, and column %s is none", motion->name);
    j->motion_opts.angle = size;
}

/* Write the motion, the force, what the first law predicts, what it leaves, and the recording's own time. */
static void
write_residual(const job *j, const ss_signal *signal, size_t motion, size_t force, const ss_motion_ranking *r)
{
    const size_t n = signal->n, column[] = { motion, force, signal->head->n_columns - 1 };
    const double *x = signal->values + motion * n, *f = signal->values + force * n;
    const double *t = signal->values + column[2] * n;
    static const char *const name[] = { "predicted", "left", "stamp" };
    ss_signal *out = NULL;
    ss_header *head = NULL;
    tool_check(ss_header_select(&head, signal->head, column, 2, 0, &tool_error));
    for (size_t i = 0; i < 3; i++) {
        const ss_column *alike = &signal->head->column[i < 2 ? force : column[2]];
        tool_check(ss_header_add_column(head, name[i], alike->unit, &tool_error));
    }
    tool_check(ss_signal_new(&out, head, n, &tool_error));
    for (size_t i = 0; i < n; i++) {
        const double row[] = { x[i], f[i], r->predicted[i], f[i] - r->predicted[i], t[i] };
        for (size_t k = 0; k < sizeof row / sizeof *row; k++)
            out->values[k * n + i] = row[k];
    }
    tool_write(out, j->residual, tool_output_kind(j->residual, TOOL_SIGNALS, TOOL_TSV));
    ss_header_free(head);
    ss_signal_free(out);
}

static void
write_law(const job *j, const ss_motion_ranking *r)
{
    ss_scene scene = r->scene;
    if (r->verdict != SS_NAMED)
        tool_die("%s: %s", tool_input_name(j->signal_path), r->answer);
    if (scene.model == NULL)
        tool_die("%s: the units of motion and force make no scene: --unit says which they are",
                 tool_input_name(j->signal_path));
    for (size_t i = 0; i < j->settings.n; i++) {
        char key[64];
        const char *equals = strchr(j->settings.text[i], '=');
        if (equals == NULL)
            tool_usage("--set: '%s' is not KEY=VALUE", j->settings.text[i]);
        snprintf(key, sizeof key, "%.*s", (int)(equals - j->settings.text[i]), j->settings.text[i]);
        if (ss_scene_set_text(&scene, key, equals + 1, &tool_error) != SS_OK)
            tool_usage("--set: %s", tool_error.text);
    }
    tool_check(ss_scene_check(&scene, &tool_error));
    for (size_t i = 0; i < r->n_numbers; i++)
        if (strstr(r->number[i].name, "_negative") != NULL && isnan(ss_scene_get(&scene, r->number[i].name)))
            tool_warn("the scene lacks %s: its model has the same on both sides", r->number[i].name);
    FILE *out = tool_output(j->output);
    fprintf(out, "# %s, by %s.\n# Something must move it: base_amplitude and base_frequency, or ss-sim --base=FILE.\n",
            r->answer, j->signal_name);
    tool_check(ss_scene_write(&scene, out, &tool_error));
}

static int
is_set(const job *j, const char *key)
{
    for (size_t i = 0; i < j->settings.n; i++)
        if (strncmp(j->settings.text[i], key, strlen(key)) == 0)
            return 1;
    return 0;
}

static void
rank_motion(job *j)
{
    if (j->fits && !(is_set(j, "mass=") && is_set(j, "stiffness=")))
        tool_usage("--fit needs --set=mass=KG and --set=stiffness=N/m of the rig in which the law is to move");
    ss_motion_ranking *r = NULL;
    ss_plot_opts plot;
    ss_signal *signal = tool_read_signal(j->signal_path, &j->reading.opts);
    const size_t motion = tool_column(signal->head, j->signal_path, j->motion);
    const size_t force = tool_column(signal->head, j->signal_path, j->column_name);
    if (motion == force)
        tool_usage("--motion and --column are the same column");
    set_motion(j, &signal->head->column[motion]);
    j->motion_opts.time = signal->values + (signal->head->n_columns - 1) * signal->n;
    j->motion_opts.progress = (ss_progress){ tool_progress, j };
    tool_check(ss_motion_ranking_new(&r, signal, motion, force, &j->motion_opts, &tool_error));
    if (j->fits)
        write_law(j, r);
    else if (j->kind < TOOL_STREAM) {
        FILE *script = begin_picture(j, &plot);
        tool_drawn(script, ss_plot_motion(script, signal, motion, force, r, &plot, &tool_error));
    } else
        tool_check(ss_motion_ranking_write(r, tool_output(j->output), tool_stream(j->kind), &tool_error));
    if (j->residual != NULL && r->rows == 0)
        tool_warn("%s, so no residual is written", r->answer);
    else if (j->residual != NULL)
        write_residual(j, signal, motion, force, r);
    ss_motion_ranking_free(r);
    ss_signal_free(signal);
}

/* --- a load point whose speed steps --------------------------------------------------------- */

static void
fit_load(job *j)
{
    static const char key[] = "stiffness=";
    ss_steps *steps = NULL;
    ss_plot_opts plot;
    ss_steps_opts opts;
    ss_steps_opts_init(&opts, sizeof opts);
    opts.shared = j->shared;
    for (size_t i = 0; i < j->settings.n; i++) {
        if (strncmp(j->settings.text[i], key, sizeof key - 1) != 0)
            tool_usage("--set %s: with --load only stiffness can be given", j->settings.text[i]);
        opts.stiffness = tool_number("--set stiffness", j->settings.text[i] + sizeof key - 1, 1e-12, 1e12);
    }
    ss_signal *signal = tool_read_signal(j->signal_path, &j->reading.opts);
    const size_t load = tool_column(signal->head, j->signal_path, j->load);
    const size_t friction = tool_column(signal->head, j->signal_path, j->column_name);
    if (j->normal != NULL)
        opts.normal = (int)tool_column(signal->head, j->signal_path, j->normal);
    const char *unit = opts.normal >= 0 ? signal->head->column[opts.normal].unit : "";
    if (load == friction)
        tool_usage("--load and --column name the same column, %s", signal->head->column[load].name);
    if (strcmp(signal->head->column[friction].unit, unit) != 0)
        tool_die("column %s is in '%s': friction has no unit, and --normal-stress has that of its shear stress",
                 signal->head->column[friction].name, signal->head->column[friction].unit);
    if (signal->head->column[load].unit[0] == '\0')
        tool_die("column %s has no unit: --unit %s=um says that it is in um", j->load, j->load);
    tool_check(ss_steps_find(&steps, signal, load, friction, &opts, &tool_error));
    for (size_t i = 0; i < steps->n; i++)
        tool_note("step at %.9g s: %zu rows, noise of %.2g", steps->step[i].at, steps->step[i].n,
                  steps->step[i].law[steps->step[i].best].noise);
    if (j->kind < TOOL_STREAM) {
        FILE *script = begin_picture(j, &plot);
        tool_drawn(script, ss_plot_steps(script, steps, &plot, &tool_error));
    } else
        tool_check(ss_steps_write(steps, tool_output(j->output), tool_stream(j->kind), &tool_error));
    ss_steps_free(steps);
    ss_signal_free(signal);
}

/* Set the signal and the scenes that are named.  Without any, the scenes are those of the paper, or, for a
 * fit, the one from which it starts. */
static void
set_files(job *j, int n, char *file[])
{
    static const char *usual[16] = { "compliant-light" };
    j->signal_path = n > 0 ? file[0] : "-";
    j->scenes = n > 1 ? (const char **)file + 1 : usual;
    j->n_scenes = n > 1 ? (size_t)n - 1 : 0;
    if (n > 1 || j->fits)
        return;
    while (j->n_scenes < sizeof usual / sizeof *usual && ss_shipped_scenes[j->n_scenes].name != NULL) {
        usual[j->n_scenes] = ss_shipped_scenes[j->n_scenes].name;
        j->n_scenes++;
    }
}

/* What goes with --motion. */
static void
check_motion(job *j, int files)
{
    if (j->column_name == NULL)
        tool_usage("--motion needs --column, the force");
    if (files > 1)
        tool_usage("--motion takes no scene");
    if (j->extra != NULL && strcmp(j->extra, "sin,cos") != 0 && strcmp(j->extra, "cos,sin") != 0)
        tool_usage("--extra: '%s' is not sin,cos", j->extra);
    if (j->as >= 0 && j->as != SS_DISPLACEMENT && j->as != SS_VELOCITY)
        tool_usage("--as: with --motion it is x or v");
    if (!j->fits && j->settings.n > 0)
        tool_usage("--set goes with --fit where there is no scene");
    if (tool_given("spread") || tool_given("forcing") || j->all)
        tool_usage("--spread, --forcing and --long are for scenes");
    j->reading.opts.stamps = 1;
}

static void
parse(job *j, int argc, char *argv[])
{
    const ss_range percents = { 0, 99 }, frequencies = { 1e-9, 1e12 };
    const ss_range delays = { 0, 100 };
    static const char *const of_load[] = { "load", "normal-stress", "share", "column", "set", "output", "format", "time",
        "time-unit", "rate", "table", "gaps", "resample", "from", "to", "scale", "unit", "quiet", "verbose", NULL };
    static const char *const folds[] = { "by-range", "halves", "interleaved", NULL };
    double percent = 100 * j->opts.spread;
    const tool_option options[] = {
        TOOL_TEXT('m', "motion", &j->motion), TOOL_TEXT(0, "extra", &j->extra),
        TOOL_TEXT(0, "residual", &j->residual), TOOL_NUMBER(0, "delay", &j->motion_opts.delay, delays),
        TOOL_CHOICE(0, "folds", &j->motion_opts.folds, folds),
        TOOL_TEXT('c', "column", &j->column_name), TOOL_CHOICE('a', "as", &j->as, ss_quantity_names),
        TOOL_TEXTS('s', "set", &j->settings), TOOL_NUMBER('p', "spread", &percent, percents),
        TOOL_NUMBER('F', "forcing", &j->opts.forcing_frequency, frequencies),
        TOOL_TEXT(0, "load", &j->load), TOOL_TEXT(0, "normal-stress", &j->normal),
        TOOL_FLAG(0, "share", &j->shared), TOOL_FLAG(0, "fit", &j->fits), TOOL_FLAG('l', "long", &j->all),
        TOOL_OUTPUT(&j->output), TOOL_FORMAT_OF_WORDS(&j->kind) };
    int first = TOOL_PARSE(argc, argv, options, &j->reading);
    j->opts.spread = percent / 100;
    tool_reading_end(&j->reading, &j->column_name, j->column_name != NULL);
    j->reading.opts.n_needed = 0;               /* others may tell more of the motion */
    if (j->motion != NULL)
        check_motion(j, argc - first);
    else if (j->extra != NULL || j->residual != NULL || tool_given("delay") || tool_given("folds"))
        tool_usage("--extra, --residual, --delay and --folds need --motion");
    if (j->load == NULL && (j->normal != NULL || j->shared))
        tool_usage("%s needs --load", j->shared ? "--share" : "--normal-stress");
    if (j->load != NULL && (tool_given_others(of_load) || argc - first > 1))
        tool_usage("with --load, of the other options only --column, --normal-stress, --share, --set stiffness "
                   "and those of reading mean something, and no scene is read");
    j->reading.opts.stamps |= j->load != NULL;
    if (j->fits && argc - first > 2)
        tool_usage("--fit takes one scene");
    if (j->fits)
        tool_writes(j->output);
    else
        j->kind = tool_output_kind(j->output, j->motion != NULL || j->load != NULL ? TOOL_WORDS | TOOL_PICTURES
                                   : TOOL_WORDS, j->kind);
    set_files(j, argc - first, argv + first);
}

/* Rank or fit scenes by one column. */
static void
rank_signal(job *j)
{
    ss_signal *signal = tool_read_signal(j->signal_path, &j->reading.opts);
    size_t column = tool_column(signal->head, j->signal_path, j->column_name);
    j->opts.quantity = quantity_of(&signal->head->column[column], j->as, &j->known_by);
    tool_note("%s: %zu samples, column %s taken as %s, by %s", tool_input_name(j->signal_path),
              signal->n, signal->head->column[column].name, ss_quantity_names[j->opts.quantity],
              j->known_by);
    for (size_t i = signal->head->n_columns; i-- > 0;) {        /* others: the first whose name shows a quantity */
        int of = i != column ? quantity_of_name(signal->head->column[i].name) : -1;
        if (of >= 0)
            j->opts.also[of] = (int)i;
    }
    j->opts.progress = (ss_progress){ tool_progress, j };
    if (j->fits) {
        ss_scene start = tool_read_scene(j->scenes[0], &j->settings, "--set");
        (ss_scene_is_pulled(&start) ? fit_pull : fit_contact)(j, signal, column, &start);
    } else
        rank(j, signal, column);
    ss_signal_free(signal);
}

int
main(int argc, char *argv[])
{
    static job j = { .kind = TOOL_TSV, .as = -1 };

    tool_begin(argv, "ss-rank", usage);
    ss_rank_opts_init(&j.opts, sizeof j.opts);
    ss_motion_opts_init(&j.motion_opts, sizeof j.motion_opts);
    parse(&j, argc, argv);
    j.signal_name = tool_name_scene(j.signal_path, NULL);
    j.reading.opts.progress = (ss_progress){ tool_reading_progress, &j };
    if (j.motion != NULL)
        rank_motion(&j);
    else if (j.load != NULL)
        fit_load(&j);
    else
        rank_signal(&j);
    tool_end();
    return 0;
}
