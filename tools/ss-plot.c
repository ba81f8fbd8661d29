/* ss-plot.c -- a signal over time, one panel a column, or one column over another. */
#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
"usage: ss-plot [options] [FILE[:/dataset] ...] | gnuplot -p\n"
"Draw a signal: one panel a column over time, or one column over another; of\n"
"several files, one over the other; or a map of a sweep.\n"
"  -c, --column=NAME|N  draw this column (repeatable, in this order), default all\n"
"      --over=FILE      draw its first column over the first panel, or X and Y\n"
"      --difference     and the difference of the first panel in a panel below\n"
"      --features=FILE  shade the transitions that ss-features found\n"
"      --xy=X,Y         Y over X instead: a phase plane, a friction loop\n"
"      --map=X,Y,Z[,Z]  rows of ss-sweep over two keys: a column of few\n"
"                       values as regions, another as lines of equal value;\n"
"                       X,Y[,Y...] over one key: a bifurcation diagram\n"
"      --line=FILE      a line over the map: x and y in rows\n"
"      --spectrum       the power spectral density of each column, by Welch\n"
"      --resolution=HZ  its resolution; the default is of seven segments or more\n"
"      --db             in dB re 1 unit^2/Hz\n"
"      --title=TEXT     default: scene or model of the signal\n"
TOOL_READING_USAGE
"      --style=STYLE    paper (default) or screen, half as large again\n"
"  -o, --output=FILE    a gnuplot script (.gp, the default), a picture (.png,\n"
"                       .svg, .pdf, .eps), or a spectrum as .tsv, .csv or .json\n"
"      --format=FORM    these numbers on standard output: tsv, csv or json\n"
"  -q, --quiet   -v, --verbose   -h, --help   --version\n";

typedef struct drawing {
    ss_reader *reader;
    size_t *column, n;          /* panels; or with xy the two columns */
    int spectrum, xy;
    tool_kind kind;             /* of output */
} drawing;

static void
draw(const drawing *d, const char *output, ss_plot_opts *opts)
{
    FILE *out = tool_draw(output, opts);
    if (d->xy)
        tool_drawn(out, ss_plot_xy(out, d->reader, d->column[0], d->column[1], opts, &tool_error));
    else if (d->spectrum)
        tool_drawn(out, ss_plot_spectrum(out, d->reader, d->column, d->n, opts, &tool_error));
    else
        tool_drawn(out, ss_plot_signal(out, d->reader, d->column, d->n, opts, &tool_error));
}

/* Read the two columns of --xy X,Y. */
static void
set_xy(const tool_option *o, char *pair)
{
    tool_texts *name = o->to;
    char *comma = strchr(pair, ',');
    if (comma == NULL || comma == pair || comma[1] == '\0')
        tool_usage("--xy: '%s' is not X,Y", pair);
    *comma = '\0';
    name->n = 0;
    tool_set_texts(o, pair);
    tool_set_texts(o, comma + 1);
}

/* --over FILE: one at most. */
static void
set_over(const tool_option *o, char *path)
{
    char **over = o->to;
    if (*over != NULL)
        tool_usage("--over: one other signal is drawn, and '%s' is the second", path);
    *over = path;
}

/* Find the columns that are named, and return their number. */
static size_t
find_columns(const ss_table *t, const char *path, const char *names, size_t column[], size_t most)
{
    size_t n = 0;
    for (size_t length; *names != '\0'; n++, names += length + (names[length] == ',')) {
        char list[512] = "";
        length = strcspn(names, ",");
        if (n == most)
            tool_usage("--map: more than %zu columns", most);
        for (column[n] = 0; column[n] < t->n_columns; column[n]++) {
            const char *known = t->column[column[n]].name;
            if (strlen(known) == length && strncmp(known, names, length) == 0)
                break;
            tool_list(list, sizeof list, known);
        }
        if (column[n] == t->n_columns)
            tool_die("%s: no column '%.*s', there are %s", tool_input_name(path), (int)length, names, list);
    }
    return n;
}

/* Read a curve: rows of x and y.  Any other row breaks the line. */
static double *
read_line(const char *path, size_t *n)
{
    FILE *in = tool_open(path);
    char text[512], *end, *rest;
    double *line = NULL;
    int points = 0;
    for (size_t room = 0; fgets(text, sizeof text, in) != NULL; ++*n) {
        if (*n == room) {
            room = 2 * room + 64;
            line = tool_room(line, room, 2 * sizeof *line);
        }
        double x = ss_number_parse(text, &end), y = ss_number_parse(end, &rest);
        line[2 * *n] = end > text && rest > end ? x : NAN;
        line[2 * *n + 1] = y;
        for (int c = strchr(text, '\n') != NULL ? '\n' : 0; c != '\n' && c != EOF;)
            c = getc(in);               /* skip the rest of a long row */
        points += !isnan(line[2 * *n]);
    }
    if (ferror(in))
        tool_die("%s: %s", path, strerror(errno));
    if (points == 0)
        tool_die("%s: no row begins with two numbers, x and y of the line", path);
    fclose(in);
    return line;
}

static void
draw_map(const char *path, const char *names, const char *line, const char *output,
         ss_plot_opts *opts)
{
    enum { COLUMNS = 8 };
    ss_table *table = NULL;
    size_t column[COLUMNS];
    FILE *in = tool_open(path);
    double *curve = line != NULL ? read_line(line, &opts->n_curve) : NULL;
    tool_check(ss_table_read(&table, in, tool_input_name(path), SS_KIND_SWEEP, &tool_error));
    if (in != stdin)
        fclose(in);
    size_t n = find_columns(table, path, names, column, COLUMNS);
    opts->curve = curve;
    tool_note("%s: %zu point%s", tool_input_name(path), table->n, tool_s(table->n));
    FILE *out = tool_draw(output, opts);
    ss_status st = ss_plot_sweep(out, table, column, n, opts, &tool_error);
    if (st == SS_EINVAL)                        /* the choice of columns, not what stands in them */
        tool_usage("--map %s: %s", names, tool_error.text);
    tool_drawn(out, st);
    ss_table_free(table);
    free(curve);
}

/* Choose the columns that are named, or all. */
static void
choose_columns(drawing *d, const char *path, const tool_texts *name)
{
    const ss_header *head = ss_reader_header(d->reader);
    d->n = name->n > 0 ? name->n : head->n_columns;
    d->column = tool_room(NULL, d->n + 1, sizeof *d->column);
    for (size_t i = 0; i < d->n; i++) {
        const char *wanted = name->n > 0 ? name->text[i] : "";
        if ((strcmp(wanted, "t") == 0 || strcmp(wanted, "time") == 0) && ss_header_column(head, wanted) < 0)
            tool_die("%s: time is the clock, not a column%s", tool_input_name(path), d->xy
                     ? "; --column Y draws Y over it" : ", which every panel has as its axis");
        d->column[i] = name->n > 0 ? tool_column(head, path, wanted) : i;
    }
}

/* Warn if a column is drawn over one of another unit. */
static void
compare_units(const ss_column *under, const ss_header *over, int column, const char *path)
{
    const ss_column *c = &over->column[column];
    if (under->unit[0] != '\0' && c->unit[0] != '\0' && strcmp(under->unit, c->unit) != 0)
        tool_warn("%s: %s is in %s and lies over %s in %s", tool_input_name(path), c->name, c->unit, under->name,
                  under->unit);
}

/* Those of another signal that lie over the columns of a signal: of the same names, or else its first. */
static void
compare_all_units(const drawing *d, const ss_header *over, int alike, const char *path)
{
    const ss_column *under = ss_reader_header(d->reader)->column;
    int found = 0;
    for (size_t i = 0; i < d->n && alike; i++) {
        int same = ss_header_column(over, under[d->column[i]].name);
        found |= same >= 0;
        if (same >= 0)
            compare_units(&under[d->column[i]], over, same, path);
    }
    if (!found && !d->xy && d->n > 0 && over->n_columns > 0)
        compare_units(&under[d->column[0]], over, 0, path);
}

/* Draw the named columns of a signal, or all, or one over another, in the form of d, and n others over it. */
static void
draw_signal(const char *path, const tool_texts *name, drawing d, char *const over[], size_t n, const char *features,
            const char *output, ss_read_opts *reading, ss_plot_opts *opts)
{
    const char *names[SS_PLOT_OVER + 1] = { tool_file_name(path) };
    ss_reader *others[SS_PLOT_OVER];
    ss_read_opts plainly, *as = opts->alike ? reading : &plainly;
    ss_read_opts_init(&plainly, sizeof plainly);
    plainly.folder = reading->folder;
    plainly.rewinds = reading->rewinds = d.xy || d.spectrum || opts->difference;
    d.reader = tool_read_rows(path, reading);
    choose_columns(&d, path, name);
    const ss_header *head = ss_reader_header(d.reader);
    for (size_t k = 0; k < n; k++) {
        others[k] = tool_read_rows(over[k], as);
        names[k + 1] = tool_file_name(over[k]);
        compare_all_units(&d, ss_reader_header(others[k]), opts->alike, over[k]);
    }
    opts->over = others;
    opts->n_over = n;
    opts->name = names;
    tool_note("%s: columns: %zu, at %.9g Hz", tool_input_name(path), head->n_columns, head->rate);
    ss_overlay *overlay = tool_read_overlay(features, SS_KIND_FEATURES);
    opts->features = overlay;
    if (d.kind >= TOOL_STREAM)
        tool_check(ss_spectrum_write(d.reader, d.column, d.n, opts, tool_output(output), tool_stream(d.kind),
                                     &tool_error));
    else
        draw(&d, output, opts);
    ss_overlay_free(overlay);
    for (size_t k = 0; k < n; k++)
        ss_reader_free(others[k]);
    ss_reader_free(d.reader);
    free(d.column);
}

int
main(int argc, char *argv[])
{
    ss_plot_opts opts;
    static tool_reading reading = { .rate_letter = 'r' };
    const char *output = NULL, *features = NULL, *map = NULL, *line = NULL;
    char *over = NULL;
    static tool_texts wanted, xy;
    drawing d = { .kind = TOOL_GP };
    const tool_option options[] = {
        TOOL_FLAG(0, "spectrum", &d.spectrum), TOOL_FLAG(0, "db", &opts.decibels),
        TOOL_NUMBER(0, "resolution", &opts.resolution, ((ss_range){ 1e-300, 1e300 })),
        TOOL_TEXTS('c', "column", &wanted), TOOL_VALUE(0, "xy", set_xy, &xy),
        TOOL_VALUE(0, "over", set_over, &over), TOOL_FLAG(0, "difference", &opts.difference),
        TOOL_TEXT(0, "features", &features),
        TOOL_TEXT(0, "map", &map), TOOL_TEXT(0, "line", &line),
        TOOL_TEXT(0, "title", &opts.title), TOOL_STYLE(&opts.style), TOOL_OUTPUT(&output),
        TOOL_FORMAT_OF_WORDS(&d.kind) };

    tool_begin(argv, "ss-plot", usage);
    ss_plot_opts_init(&opts, sizeof opts);
    int first = TOOL_PARSE(argc, argv, options, &reading);
    if (xy.n > 0 && wanted.n > 0)
        tool_usage("--xy and --column exclude each other");
    char **others = argv + first + 1;
    size_t n_others = argc > first + 1 ? (size_t)(argc - first - 1) : 0;
    if (n_others > SS_PLOT_OVER)
        tool_usage("one picture has at most %d signals, not %zu", SS_PLOT_OVER + 1, n_others + 1);
    if (n_others > 0 && (over != NULL || map != NULL))
        tool_usage("unexpected argument '%s'; of several files, --over and --map draw none", others[0]);
    const char *path = tool_input(argc - (int)n_others, argv, first);
    d.kind = tool_output_kind(output, TOOL_PICTURES | (d.spectrum ? TOOL_WORDS : 0), d.kind);
    if (d.kind == TOOL_GP)
        tool_script_to(output);
    tool_reading_end(&reading, xy.n > 0 ? xy.text : wanted.text, xy.n + wanted.n);
    opts.from = reading.from;           /* so that lines reach the border */
    opts.to = reading.to;
    reading.opts.from = reading.opts.to = 0;
    /* a whole loop alone needs no clock */
    reading.opts.stamps = xy.n > 0 && n_others == 0 && !tool_given("from") && !tool_given("to") && !tool_given("gaps");
    if (map != NULL && (xy.n > 0 || wanted.n > 0 || reading.given))
        tool_usage("--map excludes --xy, --column and the options of reading");
    if (over != NULL && map != NULL)
        tool_usage("--over excludes --map");
    d.xy = xy.n > 0;
    if (features != NULL && (map != NULL || d.xy || d.spectrum))
        tool_usage("--features is over time; it excludes --map, --xy and --spectrum");
    tool_one_stdin((const char *const[]){ path, features }, 2);
    opts.alike = n_others > 0;
    if (over != NULL) {
        others = &over;
        n_others = 1;
    }
    if (opts.difference && (n_others == 0 || d.xy || d.spectrum))
        tool_usage("--difference needs --over or several files, and is over time");
    if (d.spectrum && (map != NULL || d.xy || over != NULL))
        tool_usage("--spectrum excludes --map, --xy and --over");
    if (d.kind >= TOOL_STREAM && n_others > 0)
        tool_usage("the numbers of a spectrum are those of one file");
    if ((opts.decibels || opts.resolution > 0 || d.kind >= TOOL_STREAM) && !d.spectrum)
        tool_usage("--db, --resolution and --format need --spectrum");
    if (line != NULL && map == NULL)
        tool_usage("--line needs --map");
    if (map != NULL)
        draw_map(path, map, line, output, &opts);
    else
        draw_signal(path, d.xy ? &xy : &wanted, d, others, n_others, features, output, &reading.opts, &opts);
    tool_end();
    return 0;
}
