/* ss-contour.c -- contours of wavelet coefficients, or of a recording, over time and frequency. */
#include "options.h"
#include "jobs.h"

#include <math.h>
#include <poll.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char usage[] =
"usage: ss-contour [options] [FILE] | gnuplot -p\n"
"       ss-contour --follow=FILE [options] SECONDS [FILE]\n"
"Draw contours of |W| in dB below the largest, over time and frequency, below the\n"
"signal: of coefficients, or of a recording, transformed as it is read.\n"
"      --levels=N       contour lines (18)\n"
"      --span=DB        their range below the largest |W| (80, or down to noise)\n"
"      --fill           colours between the lines, too\n"
"      --level=DB       0 dB is |W| of DB re 1, not the largest |W|\n"
"      --palette=NAME   viridis, cividis, plasma, inferno, magma, grey; or NAME_r\n"
"      --ridge          mark at each time the frequencies where |W| is largest;\n"
"                       with -o FILE.tsv, .csv, .json or --format write them\n"
"      --fmin=HZ, --fmax=HZ  draw these frequencies (all); for times see --from\n"
"      --detrend=NAME   of a recording, subtract none, mean or linear first\n"
"      --signal=FILE    for panel (a); -c, --column=NAME|N: its column\n"
"      --events=FILE    mark these times, as ss-sim --events writes them\n"
"      --features=FILE  draw maxima, spikes, transitions, as of ss-features\n"
"      --follow=FILE    redraw the last SECONDS of a signal as it comes\n"
"      --title=TEXT     default: scene or model of the signal\n"
TOOL_READING_USAGE
"      --style=STYLE    paper (default) or screen, half as large again\n"
"  -o, --output=FILE    .gp .png .svg .pdf .eps; --format=tsv|csv|json of --ridge\n"
"  -q, --quiet   -v, --verbose   -h, --help   --version\n";

typedef struct drawing {
    const char *path, *output;
    const char *signal_path, *column, *events, *features, *follow;      /* NULL: not given */
    double seconds;             /* to follow */
    ss_coefficients *own;       /* of a file; NULL: of the overview */
    ss_overview *overview;      /* of a recording */
    const ss_coefficients *coefficients;
    ss_contour_opts opts;
    ss_overlay *times, *overlay;       /* of events and features */
    ss_detrend detrend;
    int palette;                /* of ss_palettes, if it was given */
    tool_reading reading;
    tool_kind kind;             /* of the output */
} drawing;

static void
draw_contours(const drawing *d, const char *path, ss_plot_opts *opts)
{
    FILE *script = tool_draw(path, opts);
    tool_drawn(script, ss_plot_contour(script, d->coefficients, &d->opts, opts, &tool_error));
}

/* The lowest frequency of a recording whose length is not known: a useful one has some cycles of it. */
#define LOWEST 5e-4             /* of the rate */

/* A stream holds coefficients; a file may hold a signal instead, of which the map of one column, that which was asked
 * for, or "a", or the only one, is drawn as its rows come. */
static void
open_input(drawing *d)
{
    ss_error other;
    ss_reader *reader = NULL;
    ss_morlet_opts opts;
    struct stat is;
    d->opts.progress = d->reading.opts.progress = (ss_progress){ tool_progress, d };
    d->reading.opts.rewinds = d->detrend != SS_DETREND_NONE;
    if (strcmp(d->path, "-") == 0 || (stat(d->path, &is) == 0 && !S_ISREG(is.st_mode))) {
        d->coefficients = d->own = tool_read_coefficients(d->path);
        return;
    }
    ss_status st = ss_coefficients_read(&d->own, NULL, tool_reads(d->path), &tool_error);
    if (st != SS_EKIND) {
        tool_check(st);
        d->coefficients = d->own;
        return;
    }
    st = ss_reader_new(&reader, NULL, d->path, &d->reading.opts, &other);
    tool_check_error(st, st == SS_EKIND ? &tool_error : &other);
    const ss_header *head = ss_reader_header(reader);
    size_t column = tool_column(head, d->path, d->column);
    ss_morlet_opts_init(&opts, sizeof opts);
    opts.fmin = d->opts.fmin > 0 ? d->opts.fmin : LOWEST * head->rate;
    opts.fmax = d->opts.fmax;
    opts.detrend = d->detrend;
    tool_check(ss_overview_read(&d->overview, reader, column, &opts, &tool_error));
    ss_reader_free(reader);
    d->coefficients = d->overview->coefficients;
    d->opts.signal = d->overview->signal;
    d->opts.top = d->overview->top;
    if (isnan(d->opts.noise))
        d->opts.noise = d->overview->noise;
    d->opts.fmin = d->opts.fmax = 0;
    d->opts.progress = (ss_progress){ NULL, NULL };     /* the rest takes no time */
}

/* Warn of a signal with another clock, as panel (a) shows the time of panel (b). */
static void
compare_clocks(const ss_signal *signal, const char *path, const ss_coefficients *c)
{
    double start = signal->head->start, end = start + (double)signal->n / signal->head->rate;
    double from = c->head->start, to = from + (double)c->n / c->head->rate;
    double sample = 1 / fmin(signal->head->rate, c->head->rate);
    if (fabs(signal->head->rate - c->head->rate) > 1e-6 * c->head->rate)
        tool_warn("%s: sampled at %.9g Hz, and the coefficients at %.9g Hz: is it their signal?",
                  tool_input_name(path), signal->head->rate, c->head->rate);
    if (start > from + sample || end < to - sample)
        tool_warn("%s: from %.6g to %.6g s, the coefficients from %.6g to %.6g s: is it their "
                  "signal?", tool_input_name(path), start, end, from, to);
}

/* The signal for panel (a): the one that was asked for, or the one in an HDF5 file; NULL: there is none. */
static ss_signal *
find_signal(drawing *d)
{
    ss_signal *signal = NULL;
    const ss_header *head = d->coefficients->head;
    const char *path = d->signal_path, *column = d->column;
    d->reading.opts.progress = (ss_progress){ NULL, NULL };
    if (path != NULL)
        compare_clocks(signal = tool_read_signal(path, &d->reading.opts), path, d->coefficients);
    else if (strcmp(d->path, "-") != 0) {
        ss_status st = ss_signal_read(&signal, NULL, path = d->path, NULL, &tool_error);
        if (st != SS_EKIND)                     /* the file has one */
            tool_check(st);
    }
    if (signal == NULL)
        return NULL;
    if (column == NULL && head->n_columns > 0
        && ss_header_column(signal->head, head->column[0].name) >= 0)
        column = head->column[0].name;
    d->opts.signal = signal;
    d->opts.column = tool_column(signal->head, path, column);
    return signal;
}

enum { REDRAWN = 8 };           /* pictures while a window passes */

/* The last samples of a signal, and of these the ones that a picture shows. */
typedef struct view {
    drawing *drawing;
    ss_plot_opts *plot;
    const ss_header *head;
    double **x;
    size_t column, first, n;
    uint64_t at;                /* of the first, in the whole signal */
} view;

static void
draw_view(void *user)
{
    view *v = user;
    drawing *d = v->drawing;
    ss_signal *shown;
    ss_morlet_opts opts;
    ss_morlet_opts_init(&opts, sizeof opts);
    opts.fmin = d->opts.fmin;
    opts.fmax = d->opts.fmax;
    opts.detrend = d->detrend;
    tool_check(ss_signal_new(&shown, v->head, v->n, &tool_error));
    shown->head->start += (double)v->at / v->head->rate;
    for (size_t c = 0; c < v->head->n_columns; c++)
        memcpy(shown->values + c * v->n, v->x[c] + v->first, v->n * sizeof **v->x);
    tool_check(ss_morlet_transform(&d->own, shown, v->column, &opts, &tool_error));
    d->coefficients = d->own;
    d->opts.signal = shown;
    d->opts.column = v->column;
    d->opts.fmin = d->opts.fmax = 0;
    draw_contours(d, d->follow, v->plot);
    ss_signal_free(shown);
}

/* Draw the last seconds whenever the signal has gone on by a part of them: at fixed samples, while rows are read on,
 * and at the end.  While one picture is drawn others may be left out, but not the last before the signal pauses. */
static void
follow(drawing *d, ss_plot_opts *plot)
{
    tool_writes(d->follow);
    tool_end_at_rows(NULL);
    ss_reader *reader = tool_read_rows(d->path, &d->reading.opts);
    view v = { .drawing = d, .plot = plot, .head = ss_reader_header(reader) };
    v.column = tool_column(v.head, d->path, d->column);
    double samples = d->seconds * v.head->rate;
    if (!(samples >= REDRAWN && samples < 1e8))
        tool_usage("%g s are %.0f samples: from 8 to 1e8 can be followed", d->seconds, samples);
    size_t window = (size_t)samples, hop = window / REDRAWN, piece = ss_reader_piece(reader), n, held = 0;
    uint64_t seen = 0, drawn = 0;
    double **to = tool_columns(v.head->n_columns, 0);
    v.x = tool_columns(v.head->n_columns, 2 * window + piece);
    do {
        for (size_t c = 0; c < v.head->n_columns; c++)
            to[c] = v.x[c] + held;
        n = tool_rows(reader, to, piece);
        held += n;
        seen += n;
        for (uint64_t due = seen - seen % hop; n > 0 && due >= window && due > drawn; ) {
            v.n = window;
            v.at = due - window;
            v.first = held - (size_t)(seen - v.at);
            if (tool_start(draw_view, &v, 0))
                drawn = due;
            else if (!ss_reader_waits(reader))
                break;
            else
                poll(NULL, 0, 10);
        }
        for (size_t c = 0; c < v.head->n_columns && held >= 2 * window; c++)
            memmove(v.x[c], v.x[c] + held - window - hop, (window + hop) * sizeof **v.x);
        held = held >= 2 * window ? window + hop : held;
    } while (n > 0);
    tool_start(NULL, NULL, 1);
    v.n = held < window ? held : window;
    v.at = seen - v.n;
    v.first = held - v.n;
    draw_view(&v);
    ss_reader_free(reader);
    free(v.x);
    free(to);
}

static const char *const detrends[] = { "none", "mean", "linear", NULL };

static void
parse(drawing *d, ss_plot_opts *plot, int argc, char *argv[])
{
    const tool_option options[] = {
        TOOL_WHOLE(0, "levels", &d->opts.levels, ss_contour_ranges.levels),
        TOOL_NUMBER(0, "span", &d->opts.span, ss_contour_ranges.span), TOOL_FLAG(0, "fill", &d->opts.fill),
        TOOL_NUMBER(0, "level", &d->opts.level, ss_contour_ranges.level),
        TOOL_CHOICE(0, "detrend", &d->detrend, detrends),
        TOOL_CHOICE(0, "palette", &d->palette, ss_palettes),
        TOOL_FLAG(0, "ridge", &d->opts.ridge),
        TOOL_NUMBER(0, "fmin", &d->opts.fmin, ss_morlet_ranges.frequency),
        TOOL_NUMBER(0, "fmax", &d->opts.fmax, ss_morlet_ranges.frequency),
        TOOL_TEXT(0, "signal", &d->signal_path), TOOL_TEXT('c', "column", &d->column),
        TOOL_TEXT(0, "events", &d->events), TOOL_TEXT(0, "features", &d->features),
        TOOL_TEXT(0, "follow", &d->follow), TOOL_TEXT(0, "title", &plot->title), TOOL_STYLE(&plot->style),
        TOOL_OUTPUT(&d->output), TOOL_FORMAT_OF_WORDS(&d->kind) };
    int first = TOOL_PARSE(argc, argv, options, &d->reading);
    if (d->follow != NULL && first == argc)
        tool_usage("--follow=FILE needs SECONDS, the length of what it shows");
    if (d->follow != NULL)
        d->seconds = tool_number("--follow", argv[first++], 1e-9, 1e9);
    if (d->follow != NULL && (d->output != NULL || d->signal_path != NULL))
        tool_usage("--follow excludes --output and --signal");
    d->path = tool_input(argc, argv, first);
    if (tool_given("palette"))
        d->opts.palette = ss_palettes[d->palette];
    if (tool_given("span") || tool_given("level"))
        d->opts.noise = 0;
    if (d->opts.fmin > 0 && d->opts.fmax > 0 && d->opts.fmin >= d->opts.fmax)
        tool_usage("--fmin does not lie below --fmax");
    if (tool_given("format") && (!d->opts.ridge || d->follow != NULL))
        tool_usage("--format is of the rows of --ridge");
    d->kind = d->follow != NULL ? tool_output_kind(d->follow, TOOL_PICTURES, TOOL_PNG)
        : tool_output_kind(d->output, d->opts.ridge ? TOOL_PICTURES | TOOL_WORDS : TOOL_PICTURES, d->kind);
    if (d->kind < TOOL_STREAM && d->follow == NULL)
        tool_script_to(d->output);
    tool_reading_end(&d->reading, &d->column, d->column != NULL);
    tool_one_stdin((const char *const[]){ d->path, d->signal_path, d->events, d->features }, 4);
}

/* Draw what there is, or write its ridges. */
static void
draw(drawing *d, ss_plot_opts *opts)
{
    static const ss_overlay none;
    const ss_overlay *o = d->overlay != NULL ? d->overlay : &none;
    open_input(d);
    if (d->overview != NULL && d->signal_path != NULL)
        tool_usage("--signal is for coefficients; %s is a signal", d->path);
    if (d->overview == NULL && d->detrend != SS_DETREND_NONE)
        tool_usage("--detrend is for a recording; %s has coefficients, for which ss-morlet --detrend is", d->path);
    opts->from = d->reading.from;       /* so that lines reach the border */
    opts->to = d->reading.to;
    d->reading.opts.from = d->reading.opts.to = 0;
    ss_signal *signal = d->overview == NULL ? find_signal(d) : NULL;
    if (d->column != NULL && d->opts.signal == NULL)
        tool_usage("--column needs a signal; give one with --signal");
    tool_note("%s: %zu scale%s of %zu samples; events: %zu, transitions: %zu, maxima: %zu, spikes: %zu",
              tool_input_name(d->path), d->coefficients->n_scales, tool_s(d->coefficients->n_scales),
              d->coefficients->n, d->opts.n_events, o->n_spans, o->n_maxima, o->n_spikes);
    if (d->kind < TOOL_STREAM)
        draw_contours(d, d->output, opts);
    else
        tool_check(ss_ridge_write(d->coefficients, &d->opts, opts, tool_output(d->output), tool_stream(d->kind),
                                  &tool_error));
    ss_signal_free(signal);
}

int
main(int argc, char *argv[])
{
    ss_plot_opts opts;
    static drawing d = { .kind = TOOL_GP };

    ss_plot_opts_init(&opts, sizeof opts);
    ss_contour_opts_init(&d.opts, sizeof d.opts);
    tool_begin(argv, "ss-contour", usage);
    parse(&d, &opts, argc, argv);
    if ((d.times = tool_read_overlay(d.events, SS_KIND_EVENTS)) != NULL) {
        d.opts.event = d.times->event;
        d.opts.n_events = d.times->n_events;
    }
    d.opts.overlay = d.overlay = tool_read_overlay(d.features, SS_KIND_FEATURES);
    if (d.follow != NULL)
        follow(&d, &opts);
    else
        draw(&d, &opts);
    tool_end();
    return 0;
}
