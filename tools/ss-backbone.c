/* ss-backbone -- frequency and damping of a free decay against its amplitude, and what damps it. */
#include <math.h>
#include <stdlib.h>
#include "options.h"

static const char usage[] =
"usage: ss-backbone [options] [FILE]\n"
"Follow a free decay; write its frequency and damping ratio with standard\n"
"errors, one row an amplitude, and name the mechanism that damps it.\n"
"  -c, --column=NAME|N   of the signal (default: a, else the only one)\n"
"      --mode=HZ         the strongest mode about HZ (default: of all)\n"
"      --periods=N       of each block (default: chosen)\n"
"      --mass=KG         of the rig: forces and stiffnesses, too\n"
"      --fit             write instead the scene that decays as the signal\n"
"                        does: viscous, coulomb or jenkins; needs --mass\n"
"      --envelope=db     the column is a level in dB, of a decay of --frequency\n"
"      --frequency=HZ    of the level's decay\n"
TOOL_READING_USAGE
"  -o, --output=FILE     .tsv .csv .json .gp .png .svg .pdf .eps, or with\n"
"                        --fit any name\n"
"      --format=FORM     of standard output: tsv, csv or json\n"
"      --title=TEXT      of the picture\n"
"      --style=NAME      of the picture: paper (default) or screen\n"
"  -q, --quiet           no progress; -v, --verbose: what was done\n"
"  -h, --help            show this text; --version: show the version\n";

int
main(int argc, char *argv[])
{
    static const char *const envelopes[] = { "none", "db", NULL };
    const ss_range positive = { 1e-100, 1e100 }, frequencies = { 1e-9, 1e12 }, periods = { 1.5, 1e6 };
    const char *column_name = NULL, *output = NULL;
    int fits = 0, envelope = 0;
    tool_kind kind = TOOL_TSV;
    static tool_reading reading;
    ss_backbone_opts opts;
    ss_backbone *found = NULL;
    ss_scene scene;
    ss_plot_opts plot;
    ss_backbone_opts_init(&opts, sizeof opts);
    ss_plot_opts_init(&plot, sizeof plot);
    const tool_option options[] = {
        TOOL_TEXT('c', "column", &column_name), TOOL_NUMBER(0, "mode", &opts.mode, frequencies),
        TOOL_NUMBER(0, "periods", &opts.periods, periods), TOOL_NUMBER(0, "mass", &opts.mass, positive),
        TOOL_FLAG(0, "fit", &fits), TOOL_CHOICE(0, "envelope", &envelope, envelopes),
        TOOL_NUMBER(0, "frequency", &opts.level_frequency, frequencies), TOOL_OUTPUT(&output),
        TOOL_FORMAT_OF_WORDS(&kind), TOOL_TEXT(0, "title", &plot.title), TOOL_STYLE(&plot.style) };

    tool_begin(argv, "ss-backbone", usage);
    int first = TOOL_PARSE(argc, argv, options, &reading);
    tool_reading_end(&reading, &column_name, column_name != NULL);
    if (fits && !(opts.mass > 0))
        tool_usage("--fit needs --mass");
    if (envelope != (opts.level_frequency > 0))
        tool_usage(envelope ? "--envelope needs --frequency" : "--frequency needs --envelope=db");
    if (fits)
        tool_writes(output);
    else
        kind = tool_output_kind(output, TOOL_WORDS | TOOL_PICTURES, kind);
    if (!fits && kind < TOOL_STREAM)
        tool_script_to(output);
    reading.opts.progress = (ss_progress){ tool_reading_progress, &reading };
    const char *path = tool_input(argc, argv, first);
    ss_signal *signal = tool_read_signal(path, &reading.opts);
    size_t column = tool_column(signal->head, path, column_name);
    ss_status st = ss_backbone_find(&found, signal, column, &opts, &tool_error);
    if (st == SS_OK && fits)
        st = ss_backbone_scene(&scene, found, signal, column, opts.mass, &tool_error);
    tool_check_input(st, path);
    if (found->why != NULL)
        tool_note("no decay: %s", found->why);
    if (fits)
        tool_check(ss_scene_write(&scene, tool_output(output), &tool_error));
    else if (kind < TOOL_STREAM) {
        FILE *script = tool_draw(output, &plot);
        tool_drawn(script, ss_plot_backbone(script, found, signal, column, &plot, &tool_error));
    } else
        tool_check(ss_backbone_write(found, signal, column, tool_output(output), tool_stream(kind), &tool_error));
    ss_backbone_free(found);
    ss_signal_free(signal);
    tool_end();
    return 0;
}
