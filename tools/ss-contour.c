/* ss-contour.c -- contours of wavelet coefficients over time and frequency. */
#include "common.h"

#include <float.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
"usage: ss-contour [options] [FILE] | gnuplot -p\n"
"Draw wavelet coefficients: contours of |W| in dB below the largest, over time\n"
"and frequency, below the signal if the HDF5 file has it.\n"
"      --levels=N       contour lines (18)\n"
"      --span=DB        their range below the largest |W| (80, or to the noise)\n"
"      --fill           colours between the lines, too\n"
"      --palette=NAME   viridis, cividis, plasma, inferno, magma or grey\n"
"      --ridge          mark at each time the frequencies where |W| is largest\n"
"      --fmin=HZ, --fmax=HZ  draw these frequencies (all); for times see --from\n"
"      --signal=FILE    the signal for panel (a)\n"
"  -c, --column=NAME|N  its column, default the one transformed\n"
"      --events=FILE    mark these times, as ss-sim --events writes them\n"
"      --features=FILE  draw maxima, spikes, transitions, as of ss-features\n"
"      --title=TEXT     default: scene or model of the signal\n"
TOOL_READING_USAGE
"      --style=STYLE    paper (default) or screen, half as large again\n"
"  -o, --output=FILE    a gnuplot script (.gp) or a picture (.png, .svg, .pdf);\n"
"                       default: the script on standard output\n"
"  -q, --quiet          no warnings; -v, --verbose: report the input\n"
"  -h, --help           show this text; --version: show the version\n";

enum {
    OPT_LEVELS = TOOL_OPT_FIRST, OPT_SPAN, OPT_FILL, OPT_PALETTE, OPT_RIDGE, OPT_FMIN, OPT_FMAX, OPT_SIGNAL, OPT_EVENTS, OPT_FEATURES,
    OPT_TITLE
};

typedef struct drawing {
    ss_coefficients *own;       /* all in memory, or else a file that has them */
    ss_store_reader *reader;
    const ss_coefficients *coefficients;
    ss_contour_opts opts;
    double *event;
    ss_overlay *overlay;
    tool_reading reading;
} drawing;

static ss_status
write_script(FILE *out, const ss_plot_opts *opts, void *user, ss_error *err)
{
    const drawing *d = user;
    return ss_plot_contour(out, d->coefficients, &d->opts, opts, err);
}

/* An ss_coefficient_source. */
static ss_status
read_scale(size_t i, double *w, void *user, ss_error *err)
{
    return ss_store_reader_scale(user, i, w, err);
}

static void
open_coefficients(drawing *d, const char *path)
{
    ss_error err = { 0 };
    d->opts.progress = (ss_progress){ tool_progress, d };
    if (!tool_is_hdf5(path)) {
        d->coefficients = d->own = tool_read_coefficients(path);
        return;
    }
    tool_check(ss_store_reader_new(&d->reader, tool_reads(path), &err), &err);
    d->coefficients = ss_store_reader_grid(d->reader);
    d->opts.source = read_scale;
    d->opts.source_user = d->reader;
}

/* Panel (a) shows the time of panel (b), so a signal of another time or clock causes a warning. */
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

/* The signal for panel (a): the one asked for, or the one that an HDF5 file has, or none. */
static ss_signal *
find_signal(drawing *d, const char *path, const char *signal_path, const char *column)
{
    ss_signal *signal = NULL;
    const ss_header *head = d->coefficients->head;
    if (signal_path != NULL)
        compare_clocks(signal = tool_read_signal(signal_path, &d->reading.opts), signal_path, d->coefficients);
    else if (tool_is_hdf5(path) && ss_store_has_signal(path))
        signal = tool_read_signal(signal_path = path, NULL);
    if (signal == NULL)
        return NULL;
    if (column == NULL && head->n_columns > 0
        && ss_header_column(signal->head, head->column[0].name) >= 0)
        column = head->column[0].name;
    d->opts.signal = signal;
    d->opts.column = tool_column(signal->head, signal_path, column);
    return signal;
}

/* --- times in files ------------------------------------------------------------------------ */

static void
read_events(drawing *d, const char *path)
{
    ss_error err = { 0 };
    FILE *in = tool_open(path);
    tool_check(ss_event_times_read(&d->event, &d->opts.n_events, in, tool_input_name(path), &err), &err);
    if (in != stdin)
        fclose(in);
    d->opts.event = d->event;
}

static void
read_features(drawing *d, const char *path)
{
    ss_error err = { 0 };
    FILE *in = tool_open(path);
    tool_check(ss_overlay_read(&d->overlay, in, tool_input_name(path), &err), &err);
    if (in != stdin)
        fclose(in);
    d->opts.overlay = d->overlay;
}

static int
is_stdin(const char *path)
{
    return path != NULL && strcmp(path, "-") == 0;
}

static const char *
palette(const char *text)
{
    enum { MOST = 16 };
    const char *name[MOST + 1] = { NULL };
    for (size_t i = 0; i < MOST && ss_palette_name(i) != NULL; i++)
        name[i] = ss_palette_name(i);
    return name[tool_choice("--palette", text, name)];
}

int
main(int argc, char *argv[])
{
    static const struct option longopts[] = {
        { "levels", required_argument, NULL, OPT_LEVELS },
        { "span", required_argument, NULL, OPT_SPAN },
        { "fill", no_argument, NULL, OPT_FILL },
        { "palette", required_argument, NULL, OPT_PALETTE },
        { "ridge", no_argument, NULL, OPT_RIDGE },
        { "fmin", required_argument, NULL, OPT_FMIN },
        { "fmax", required_argument, NULL, OPT_FMAX },
        { "signal", required_argument, NULL, OPT_SIGNAL },
        { "column", required_argument, NULL, 'c' },
        { "events", required_argument, NULL, OPT_EVENTS },
        { "features", required_argument, NULL, OPT_FEATURES },
        { "title", required_argument, NULL, OPT_TITLE },
        { "style", required_argument, NULL, TOOL_OPT_STYLE },
        TOOL_READING_LONGOPTS,
        TOOL_LONGOPTS };
    ss_plot_opts opts = ss_plot_defaults;
    drawing d = { .opts = ss_contour_defaults };
    const char *output = NULL, *signal_path = NULL, *column = NULL, *events = NULL;
    const char *features = NULL;

    tool_begin(argv, "ss-contour", usage);
    tool_reading_begin(&d.reading, argc);
    for (int c; (c = getopt_long(argc, argv, "c:o:qvh", longopts, NULL)) != -1;)
        switch (c) {
        case OPT_LEVELS: d.opts.levels = (int)tool_integer("--levels", optarg, 1, (long)ss_contour_levels.to); break;
        case OPT_SPAN:
            d.opts.span = tool_number_in("--span", optarg, ss_contour_spans);
            d.opts.noise = 0;
            break;
        case OPT_FILL: d.opts.fill = 1; break;
        case OPT_PALETTE: d.opts.palette = palette(optarg); break;
        case OPT_RIDGE: d.opts.ridge = 1; break;
        case OPT_FMIN: d.opts.fmin = tool_number_in("--fmin", optarg, ss_morlet_ranges.frequency); break;
        case OPT_FMAX: d.opts.fmax = tool_number_in("--fmax", optarg, ss_morlet_ranges.frequency); break;
        case OPT_SIGNAL: signal_path = optarg; break;
        case 'c': column = optarg; break;
        case OPT_EVENTS: events = optarg; break;
        case OPT_FEATURES: features = optarg; break;
        case OPT_TITLE: opts.title = optarg; break;
        case TOOL_OPT_STYLE: opts.style = tool_style(optarg); break;
        case 'o': output = optarg; break;
        default:
            if (!tool_reading_option(&d.reading, c, optarg))
                tool_option(c);
        }
    const char *path = tool_input(argc, argv, optind);
    if (d.opts.fmin > 0 && d.opts.fmax > 0 && d.opts.fmin >= d.opts.fmax)
        tool_usage("--fmin does not lie below --fmax");
    tool_output_kind(output, TOOL_PICTURES, TOOL_GP);
    tool_reading_end(&d.reading, column);
    opts.from = d.reading.from;         /* the lines go on to the border */
    opts.to = d.reading.to;
    d.reading.opts.from = d.reading.opts.to = 0;
    if (is_stdin(path) + is_stdin(signal_path) + is_stdin(events)
        + is_stdin(features) > 1)
        tool_usage("standard input can be read only once");
    open_coefficients(&d, path);
    ss_signal *signal = find_signal(&d, path, signal_path, column);
    if (column != NULL && signal == NULL)
        tool_usage("--column needs a signal; give one with --signal");
    if (events != NULL)
        read_events(&d, events);
    if (features != NULL)
        read_features(&d, features);
    tool_note("%s: %zu scales of %zu samples, %zu events; %zu transitions, %zu maxima, "
              "%zu spikes", tool_input_name(path), d.coefficients->n_scales, d.coefficients->n,
              d.opts.n_events, d.overlay != NULL ? d.overlay->n_spans : 0,
              d.overlay != NULL ? d.overlay->n_maxima : 0, d.overlay != NULL ? d.overlay->n_spikes : 0);
    tool_draw(output, &opts, write_script, &d);
    free(d.event);
    tool_reading_free(&d.reading);
    ss_overlay_free(d.overlay);
    ss_signal_free(signal);
    ss_coefficients_free(d.own);
    ss_store_reader_free(d.reader);
    tool_end();
    return 0;
}
