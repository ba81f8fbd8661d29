/* ss-contour.c -- contours of wavelet coefficients over time and frequency. */
#include "common.h"

#include <errno.h>
#include <float.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
"usage: ss-contour [options] [FILE] | gnuplot -p\n"
"Draw wavelet coefficients: contours of |W| in dB below the largest, over time\n"
"and frequency, under the signal that an HDF5 file has beside them.\n"
"      --levels=N       contour lines (18)\n"
"      --span=DB        that they span below the largest |W| (80)\n"
"      --signal=FILE    the signal for panel (a)\n"
"  -c, --column=NAME|N  its column, default the one transformed\n"
"      --events=FILE    mark these times, as ss-sim --events writes them\n"
"      --title=TEXT     default: scene or model of the signal\n"
"      --from=S         from this time on the source's clock [s]\n"
"      --to=S           up to this time [s]\n"
"      --style=STYLE    paper (default) or screen, half as large again\n"
"  -o, --output=FILE    a gnuplot script (.gp) or a picture (.png, .svg, .pdf);\n"
"                       default: the script on standard output\n"
"  -q, --quiet          no warnings\n"
"  -v, --verbose        say what was read\n"
"  -h, --help           show this text and exit\n"
"      --version        show the version and exit\n";

enum {
    OPT_LEVELS = TOOL_OPT_FIRST, OPT_SPAN, OPT_SIGNAL, OPT_EVENTS, OPT_TITLE, OPT_FROM, OPT_TO
};

typedef struct drawing {
    ss_coefficients *coefficients;
    ss_contour_opts opts;
} drawing;

static ss_status
write_script(FILE *out, const ss_plot_opts *opts, void *user, ss_error *err)
{
    const drawing *d = user;
    return ss_plot_contour(out, d->coefficients, &d->opts, opts, err);
}

/* The signal for panel (a): the one asked for, or the one that an HDF5 file has, or none. */
static ss_signal *
find_signal(drawing *d, const char *path, const char *signal_path, const char *column)
{
    ss_signal *signal = NULL;
    const ss_header *head = d->coefficients->head;
    if (signal_path != NULL)
        signal = tool_read_signal(signal_path, NULL);
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

/* Times: the first field of every line that is no comment, below the line that says what they are. */
static void
read_events(ss_contour_opts *opts, const char *path)
{
    static const char magic[] = "# stickslip events 1";
    FILE *in = tool_open(path);
    char *line = NULL, *end;
    double *event = NULL;
    size_t size = 0, room = 0, number = 1, n = 0;
    ssize_t length = getline(&line, &size, in);
    if (length >= 0)
        line[strcspn(line, "\r\n")] = '\0';
    if (length >= 0 ? strcmp(line, magic) != 0 : !ferror(in))
        tool_die("%s:1: not a list of events, which begins '%s'", tool_input_name(path), magic);
    while (getline(&line, &size, in) >= 0) {
        number++;
        if (line[0] == '#' || line[strspn(line, " \t\r\n")] == '\0')
            continue;
        if (n == room) {
            room = 2 * room + 64;
            event = realloc(event, room * sizeof *event);
            if (event == NULL)
                tool_die("%s", ss_strerror(SS_ENOMEM));
        }
        event[n++] = ss_number_parse(line, &end);
        if (end == line || strchr(" \t\r\n,", *end) == NULL)
            tool_die("%s:%zu: expected a time in seconds", tool_input_name(path), number);
    }
    if (ferror(in))
        tool_die("%s: %s", tool_input_name(path), strerror(errno));
    free(line);
    if (in != stdin)
        fclose(in);
    opts->event = event;
    opts->n_events = n;
}

static int
is_stdin(const char *path)
{
    return path != NULL && strcmp(path, "-") == 0;
}

int
main(int argc, char *argv[])
{
    static const struct option longopts[] = {
        { "levels", required_argument, NULL, OPT_LEVELS },
        { "span", required_argument, NULL, OPT_SPAN },
        { "signal", required_argument, NULL, OPT_SIGNAL }, { "column", required_argument, NULL, 'c' },
        { "events", required_argument, NULL, OPT_EVENTS },
        { "title", required_argument, NULL, OPT_TITLE },
        { "style", required_argument, NULL, TOOL_OPT_STYLE },
        { "from", required_argument, NULL, OPT_FROM }, { "to", required_argument, NULL, OPT_TO },
        TOOL_LONGOPTS };
    ss_plot_opts opts = ss_plot_defaults;
    drawing d = { NULL, ss_contour_defaults };
    const char *output = NULL, *signal_path = NULL, *column = NULL, *events = NULL;

    tool_begin(argv, "ss-contour", usage);
    for (int c; (c = getopt_long(argc, argv, "c:o:qvh", longopts, NULL)) != -1;)
        switch (c) {
        case OPT_LEVELS: d.opts.levels = (int)tool_integer("--levels", optarg, 1, 100); break;
        case OPT_SPAN: d.opts.span = tool_number("--span", optarg, 0.001, 1000); break;
        case OPT_SIGNAL: signal_path = optarg; break;
        case 'c': column = optarg; break;
        case OPT_EVENTS: events = optarg; break;
        case OPT_TITLE: opts.title = optarg; break;
        case TOOL_OPT_STYLE: opts.style = tool_style(optarg); break;
        case OPT_FROM: opts.from = tool_number("--from", optarg, -DBL_MAX, DBL_MAX); break;
        case OPT_TO: opts.to = tool_number("--to", optarg, -DBL_MAX, DBL_MAX); break;
        case 'o': output = optarg; break;
        default: tool_option(c);
        }
    const char *path = tool_input(argc, argv, optind);
    tool_output_kind(output, TOOL_PICTURES, TOOL_GP);
    if (opts.from >= opts.to)
        tool_usage("--from does not lie before --to");
    if (is_stdin(path) + is_stdin(signal_path) + is_stdin(events) > 1)
        tool_usage("standard input can be read only once");
    d.coefficients = tool_read_coefficients(path);
    ss_signal *signal = find_signal(&d, path, signal_path, column);
    if (column != NULL && signal == NULL)
        tool_usage("--column chooses from a signal, and there is none; give it with --signal");
    if (events != NULL)
        read_events(&d.opts, events);
    tool_note("%s: %zu scales of %zu samples, %zu events", tool_input_name(path),
              d.coefficients->n_scales, d.coefficients->n, d.opts.n_events);
    tool_draw(output, &opts, write_script, &d);
    free((double *)d.opts.event);
    ss_signal_free(signal);
    ss_coefficients_free(d.coefficients);
    tool_end();
    return 0;
}
