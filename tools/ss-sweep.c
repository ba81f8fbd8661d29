/* ss-sweep -- the periodic state of a scene in numbers, over a grid of its parameters. */
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "common.h"

static const char usage[] =
"usage: ss-sweep [options] --vary=KEY=FROM:TO:N[:log] ... SCENE\n"
"Find the periodic state that the scene settles to at every point of a grid and\n"
"write one row each.  SCENE is a file, - or the name of a shipped scene.\n"
"  -y, --vary=K=A:B:N    N values of K from A to B, with :log in equal ratios\n"
"                        (repeatable; the last varies fastest)\n"
"  -m, --measure=LIST    of stops,stick,amplitude,x_max,v_max,a_max,energy,\n"
"                        period,cycles,microslips,transition,x_phase,v_phase,\n"
"                        floquet,floquet2,floquet_angle (default: what the\n"
"                        model has of stops ... period without x_max)\n"
"  -s, --set=KEY=VALUE   put VALUE in place of the scene's own (repeatable)\n"
"      --shoot           Newton's method instead of waiting for the end\n"
"  -t, --tol=TOL         how near to periodic, see the manual (default 1e-9)\n"
"      --max-period=N    sub-harmonics looked for (8)\n"
"      --max-cycles=N    after so many it is called aperiodic (10000)\n"
"      --max-steps=N     integration steps of a point (1e7)\n"
"      --settle-cycles=N simulate so many cycles instead of looking for the end\n"
"      --method=NAME     of ss-sim (default exact where there is one)\n"
"  -j, --threads=N       work on N points at a time (1)\n"
"      --shard=I/N       every N-th point only: index I modulo N\n"
"  -r, --resume=FILE     append to FILE what it lacks, or begin it\n"
"  -o, --output=FILE     .tsv, whole or absent (default: standard output)\n"
"  -q, --quiet   -v, --verbose   -h, --help   --version\n";

enum { OPT_SHOOT = TOOL_OPT_FIRST, OPT_PERIOD, OPT_CYCLES, OPT_STEPS, OPT_SETTLE, OPT_METHOD,
       OPT_SHARD };

typedef struct request {
    const char *scene_path, *path, *resume;
    const char **settings;
    size_t n_settings;
    ss_axis *axis;
    ss_sweep_opts opts;
    ss_measure pick[SS_MEASURES];       /* the measures, in the order asked for */
    size_t n_picks;
    FILE *out;
    size_t rows, failed;
} request;

/* --- options ------------------------------------------------------------------------------- */

static void
pick_measure(request *req, const char *name, size_t length)
{
    for (ss_measure m = 0; m < SS_MEASURES; m++) {
        const char *known = ss_measure_name(m);
        if (strlen(known) != length || strncmp(known, name, length) != 0)
            continue;
        if (req->opts.steady.measures & 1u << m)
            tool_usage("--measure: '%s' is there twice", known);
        req->opts.steady.measures |= 1u << m;
        req->pick[req->n_picks++] = m;
        return;
    }
    char list[512] = "";
    for (ss_measure m = 0; m < SS_MEASURES; m++)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", m > 0 ? ", " : "",
                 ss_measure_name(m));
    tool_usage("--measure: '%.*s' is none of %s", (int)length, name, list);
}

static void
pick_measures(request *req, const char *names)
{
    req->opts.steady.measures = 0;
    req->n_picks = 0;
    for (const char *name = names;; name++) {
        size_t length = strcspn(name, ",");
        pick_measure(req, name, length);
        name += length;
        if (*name == '\0')
            return;
    }
}

/* What the model has of the usual. */
static void
pick_usual(request *req, ss_model model)
{
    static const ss_measure usual[] = { SS_STOPS, SS_STICK_FRACTION, SS_AMPLITUDE, SS_V_MAX,
                                        SS_A_MAX, SS_ENERGY, SS_PERIOD };
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++) {
        ss_steady_opts has = ss_steady_defaults;
        has.measures = 1u << usual[i];
        if (ss_steady_check(&has, model, NULL) == SS_OK)
            pick_measure(req, ss_measure_name(usual[i]), strlen(ss_measure_name(usual[i])));
    }
}

static void
parse_shard(ss_sweep_opts *opts, const char *text)
{
    char *slash, *end;
    long i = strtol(text, &slash, 10), n = *slash == '/' ? strtol(slash + 1, &end, 10) : 0;
    if (*slash != '/' || slash == text || end == slash + 1 || *end != '\0' || n < 1 || i < 0
        || i > n)
        tool_usage("--shard: '%s' is not I/N with I from 0 to N - 1, or from 1 to N", text);
    opts->shard = (size_t)(i % n);
    opts->shards = (size_t)n;
}

static unsigned long
count(const char *option, const char *text)
{
    return (unsigned long)tool_integer(option, text, 1, LONG_MAX);
}

static void
parse(request *req, int argc, char *argv[])
{
    static const struct option longopts[] = {
        { "vary", required_argument, NULL, 'y' }, { "measure", required_argument, NULL, 'm' },
        { "set", required_argument, NULL, 's' }, { "shoot", no_argument, NULL, OPT_SHOOT },
        { "tol", required_argument, NULL, 't' },
        { "max-period", required_argument, NULL, OPT_PERIOD },
        { "max-cycles", required_argument, NULL, OPT_CYCLES },
        { "max-steps", required_argument, NULL, OPT_STEPS },
        { "settle-cycles", required_argument, NULL, OPT_SETTLE },
        { "method", required_argument, NULL, OPT_METHOD },
        { "threads", required_argument, NULL, 'j' },
        { "shard", required_argument, NULL, OPT_SHARD },
        { "resume", required_argument, NULL, 'r' }, TOOL_LONGOPTS };
    ss_steady_opts *steady = &req->opts.steady;
    ss_error err = { "" };

    for (int c; (c = getopt_long(argc, argv, "y:m:s:t:j:r:o:qvh", longopts, NULL)) != -1;)
        switch (c) {
        case 'y':
            if (ss_axis_parse(&req->axis[req->opts.n_axes++], optarg, &err) != SS_OK)
                tool_usage("--vary: %s", err.text);
            break;
        case 'm': pick_measures(req, optarg); break;
        case 's': req->settings[req->n_settings++] = optarg; break;
        case OPT_SHOOT: steady->shoot = 1; break;
        case 't': steady->tol = tool_number("--tol", optarg, 1e-13, 1e-1); break;
        case OPT_PERIOD:
            steady->max_period = (int)tool_integer("--max-period", optarg, 1, SS_PERIOD_MAX);
            break;
        case OPT_CYCLES: steady->max_cycles = count("--max-cycles", optarg); break;
        case OPT_STEPS: steady->max_steps = count("--max-steps", optarg); break;
        case OPT_SETTLE: steady->settle = count("--settle-cycles", optarg); break;
        case OPT_METHOD: steady->method = tool_method(optarg); break;
        case 'j':
            req->opts.threads = (int)tool_integer("--threads", optarg, 1, SS_THREADS_MAX);
            break;
        case OPT_SHARD: parse_shard(&req->opts, optarg); break;
        case 'r': req->resume = optarg; break;
        case 'o': req->path = optarg; break;
        default: tool_option(c);
        }
    if (optind == argc)
        tool_usage("which scene? give a file, or a shipped one by its name");
    req->scene_path = tool_input(argc, argv, optind);
    tool_output_kind(req->path, 1u << TOOL_TSV, TOOL_TSV);
    if (req->resume != NULL && strcmp(req->resume, "-") == 0)
        tool_usage("--resume needs a file: what went to standard output cannot be read again");
    if (req->resume != NULL && req->path != NULL)
        tool_usage("--resume FILE is where the rows go: --output does not go with it");
}

/* --- text ---------------------------------------------------------------------------------- */

static void
put_number(FILE *out, double x, char behind)
{
    char text[SS_NUMBER_MAX];
    ss_number_format(text, x);
    fprintf(out, "%s%c", isnan(x) ? "-" : text, behind);
}

static void
put_label(FILE *out, const char *name, const char *unit)
{
    const char *around = strpbrk(unit, "/ ") != NULL ? "()" : "";
    fprintf(out, " %s", name);
    if (*unit != '\0')
        fprintf(out, *around != '\0' ? "/(%s)" : "/%s", unit);
}

/* The scene's own numbers but for those that are varied or say how it is recorded. */
static void
put_scene(FILE *out, const request *req, const ss_scene *scene)
{
    char *text = NULL;
    size_t size;
    FILE *all = open_memstream(&text, &size);
    if (all == NULL || ss_scene_write(scene, all) != SS_OK || fclose(all) != 0)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    for (char *line = strtok(text, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        char *equals = strstr(line, " = ");
        *equals = '\0';
        int shown = strcmp(line, "settle") != 0 && strcmp(line, "duration") != 0
            && strcmp(line, "rate") != 0;
        for (size_t i = 0; i < req->opts.n_axes; i++)
            shown &= strcmp(line, req->axis[i].key) != 0;
        if (shown)
            fprintf(out, "# %s: %s\n", line, equals + 3);
    }
    free(text);
}

static void
put_axis(FILE *out, const ss_axis *axis)
{
    fprintf(out, "# vary: %s=", axis->key);
    put_number(out, axis->from, ':');
    put_number(out, axis->to, ':');
    fprintf(out, "%zu%s\n", axis->n, axis->log ? ":log" : "");
}

/* All that the rows depend on, and nothing else: a file is resumed if it begins with this text. */
static char *
make_header(const request *req, ss_scene *scene)
{
    const ss_steady_opts *s = &req->opts.steady;
    char *text = NULL, name[256];
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    tool_name_scene(name, sizeof name, req->scene_path, req->settings, req->n_settings);
    fprintf(out, "# stickslip sweep 1\n# scene: %s\n", name);
    put_scene(out, req, scene);
    for (size_t i = 0; i < req->opts.n_axes; i++)
        put_axis(out, &req->axis[i]);
    fputs("# tolerance: ", out);
    put_number(out, s->tol, '\n');
    if (s->settle > 0)
        fprintf(out, "# settle_cycles: %lu\n", s->settle);
    else
        fprintf(out, "# max_cycles: %lu\n", s->max_cycles);
    fprintf(out, "# max_period: %d\n# max_steps: %lu\n", s->max_period, s->max_steps);
    fprintf(out, "# method: %s%s\n", s->shoot ? "shooting, " : "", s->method != NULL ? s->method
            : ss_model_is_linear(scene->model) ? "exact" : "rk8pd, bsimp where stiff");
    fputs("# columns: index", out);
    for (size_t i = 0; i < req->opts.n_axes; i++) {
        const char *unit;
        ss_scene_number(scene, req->axis[i].key, &unit, NULL);
        put_label(out, req->axis[i].key, unit);
    }
    for (size_t i = 0; i < req->n_picks; i++)
        put_label(out, ss_measure_name(req->pick[i]), ss_measure_unit(req->pick[i]));
    fputs(" status\n", out);
    if (fclose(out) != 0)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    return text;
}

static int
write_row(const ss_sweep_row *row, void *user)
{
    request *req = user;
    if (tool_stopping())
        return 1;
    fprintf(req->out, "%zu\t", row->index);
    for (size_t i = 0; i < req->opts.n_axes; i++)
        put_number(req->out, row->vary[i], '\t');
    for (size_t i = 0; i < req->n_picks; i++) {
        double value = row->steady.value[req->pick[i]];
        if (req->pick[i] == SS_PERIOD && value == 0)
            fputs("aperiodic\t", req->out);
        else
            put_number(req->out, value, '\t');
    }
    fprintf(req->out, "%s\n", row->reason);
    req->rows++;
    req->failed += row->status != SS_OK;
    return ferror(req->out);
}

/* Between batches: what is done must outlive a kill. */
static int
report(double done, void *user)
{
    request *req = user;
    return (req->resume != NULL && fflush(req->out) != 0) || tool_progress(done, NULL) != 0;
}

/* --- resuming ------------------------------------------------------------------------------ */

/* The first of the next line's bytes, as far as there is room, without its end; gives the length of
 * all of it, or 0 if it was cut off. */
static long
read_line(FILE *in, char *line, size_t room)
{
    long length = 0;
    size_t n = 0;
    int c;
    while ((c = getc(in)) != EOF && c != '\n') {
        length++;
        if (n + 1 < room)
            line[n++] = (char)c;
    }
    line[n] = '\0';
    return c == '\n' ? length + 1 : 0;
}

/* Whole rows at the head of FILE, in the order in which they must come; dies if it is no part of
 * this sweep.  What lies behind *end was cut off in the middle of a line. */
static size_t
count_rows(const request *req, FILE *in, const char *header, long *end)
{
    size_t rows = 0, length = strlen(header);
    char line[64], *start = malloc(length + 1);
    if (start == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    size_t got = fread(start, 1, length, in);
    if (memcmp(start, header, got) != 0)
        tool_die("%s: another sweep than this: its header differs", req->resume);
    free(start);
    *end = got == length ? (long)length : 0;
    for (long n; got == length && (n = read_line(in, line, sizeof line)) > 0;) {
        char *tab;
        size_t due = req->opts.shard + rows * req->opts.shards, index = strtoul(line, &tab, 10);
        if (tab == line || *tab != '\t' || index != due)
            tool_die("%s: row %zu is '%.*s', but point %zu is due: another sweep or shard",
                     req->resume, rows + 1, (int)strcspn(line, "\t"), line, due);
        rows++;
        *end += n;
    }
    if (ferror(in))
        tool_die("%s: %s", req->resume, strerror(errno));
    return rows;
}

static void
resume(request *req, const char *header)
{
    long end = 0;
    req->out = tool_output_kept(req->resume);
    req->opts.first = count_rows(req, req->out, header, &end);
    tool_cut(req->out, end);
    if (end == 0)
        fputs(header, req->out);
    tool_note("%s: %zu rows are there", req->resume, req->opts.first);
}

/* A value that is varied cannot be given too. */
static void
check_settings(const request *req)
{
    for (size_t i = 0; i < req->n_settings; i++) {
        const char *name = req->settings[i] + strspn(req->settings[i], " \t");
        size_t length = strcspn(name, " \t=");
        for (size_t k = 0; k < req->opts.n_axes; k++)
            if (strlen(req->axis[k].key) == length
                && strncmp(req->axis[k].key, name, length) == 0)
                tool_usage("%s is both varied and set", req->axis[k].key);
    }
}

int
main(int argc, char *argv[])
{
    request req = { .opts = { .steady = ss_steady_defaults, .shards = 1, .threads = 1,
                              .sink = write_row, .progress.function = report } };
    ss_error err = { "" };

    tool_begin(argv, "ss-sweep", usage);
    req.settings = calloc((size_t)argc, sizeof *req.settings);
    req.axis = calloc((size_t)argc, sizeof *req.axis);
    if (req.settings == NULL || req.axis == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    parse(&req, argc, argv);
    check_settings(&req);
    ss_scene scene = tool_read_scene(req.scene_path, req.settings, req.n_settings);
    if (req.n_picks == 0)
        pick_usual(&req, scene.model);
    req.opts.axis = req.axis;
    req.opts.user = req.opts.progress.user = &req;
    if (ss_sweep_check(&scene, &req.opts, &err) != SS_OK)
        tool_usage("%s", err.text);

    char *header = make_header(&req, &scene);
    tool_end_at_rows(req.path);
    if (req.resume != NULL) {
        resume(&req, header);
    } else {
        req.out = tool_output(req.path);
        fputs(header, req.out);
    }
    ss_status st = ss_sweep_run(&scene, &req.opts, &err);
    if (st == SS_STOP && !tool_stopping())
        tool_die("write error: %s", strerror(errno));
    tool_check(st, &err);
    tool_note("%zu points, %zu of them with something missing", req.rows, req.failed);
    free(header);
    free(req.settings);
    free(req.axis);
    tool_end();
    return 0;
}
