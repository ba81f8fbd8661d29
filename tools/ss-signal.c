/* ss-signal.c -- benchmark signals. */
#include "common.h"

#include <float.h>
#include <getopt.h>
#include <math.h>

static const char usage[] =
"usage: ss-signal [options] KIND\n"
"Write a benchmark signal of one column, a, to standard output.  KIND is one of\n"
"  sine      A cos(2 pi F (t - T))\n"
"  impulse   A in the sample nearest to T, else 0\n"
"  step      A from T on, else 0\n"
"  chirp     A cos of a phase whose frequency goes linearly from F to F2\n"
"  ringdown  A exp(-s (t - T)) cos(2 pi F (t - T)) from T on, else 0\n"
"  noise     Gaussian white noise of standard deviation A\n"
"  -r, --rate=HZ        sample rate, default 2000 Hz\n"
"  -d, --duration=S     length, default 10 s\n"
"  -a, --amplitude=A    default 1\n"
"  -f, --frequency=F    sine, chirp, ringdown (damped): default 10 Hz\n"
"      --to=F2          chirp: frequency at the end, default 100 Hz\n"
"      --damping=D      ringdown: damping ratio, 0 <= D < 1, default 0.05\n"
"      --at=T           sine, impulse, step, ringdown: default 0 s\n"
"      --seed=N         noise: default 1\n"
"  -o, --output=FILE    write to FILE.tsv, .au, .csv or .h5\n"
"      --format=FORM    on standard output: tsv (default), au or csv\n"
"  -q, --quiet          no warnings; -v, --verbose: report the length\n"
"  -h, --help           show this text; --version: show the version\n";

enum { OPT_TO = TOOL_OPT_FIRST, OPT_DAMPING, OPT_AT, OPT_SEED };

/* Options that only some kinds have. */
#define SET(wave) (1u << (wave))
static const struct {
    int option;
    const char *name;
    unsigned kinds;
} only[] = {
    { 'f', "--frequency", SET(SS_SINE) | SET(SS_CHIRP) | SET(SS_RINGDOWN) },
    { OPT_TO, "--to", SET(SS_CHIRP) },
    { OPT_DAMPING, "--damping", SET(SS_RINGDOWN) },
    { OPT_AT, "--at", SET(SS_SINE) | SET(SS_IMPULSE) | SET(SS_STEP) | SET(SS_RINGDOWN) },
    { OPT_SEED, "--seed", SET(SS_NOISE) },
};
enum { N_ONLY = sizeof only / sizeof *only, AT = 3 };     /* AT: --at in it */

/* Warn of, or refuse, values that are in range but hardly intended.  used: set of indices in only[]. */
static void
check_sense(ss_wave wave, const ss_wave_opts *o, unsigned used)
{
    double n = round(o->duration * o->rate), highest = o->frequency;
    if (wave == SS_CHIRP)
        highest = fmax(highest, o->frequency_end);
    if ((SET(wave) & only[0].kinds) && highest > o->rate / 2)
        tool_warn("%g Hz is above half the rate, %g Hz, and folds down", highest, o->rate / 2);
    if (wave == SS_IMPULSE && (used & 1u << AT) && !(o->at * o->rate > -0.5
                                                     && round(o->at * o->rate) < n))
        tool_usage("--at %g: the record goes from 0 to %g s, so no sample is nearest", o->at,
                   (n - 1) / o->rate);
}

int
main(int argc, char *argv[])
{
    static const struct option longopts[] = {
        { "rate", required_argument, NULL, 'r' }, { "duration", required_argument, NULL, 'd' },
        { "amplitude", required_argument, NULL, 'a' },
        { "frequency", required_argument, NULL, 'f' }, { "to", required_argument, NULL, OPT_TO },
        { "damping", required_argument, NULL, OPT_DAMPING },
        { "at", required_argument, NULL, OPT_AT }, { "seed", required_argument, NULL, OPT_SEED },
        { "format", required_argument, NULL, TOOL_OPT_FORMAT }, TOOL_LONGOPTS };
    static const char *const kinds[] = { "sine", "impulse", "step", "chirp", "ringdown", "noise",
                                         NULL };
    ss_wave_opts opts = ss_wave_defaults;
    const char *output = NULL;
    tool_kind kind = TOOL_TSV;
    unsigned used = 0;                          /* set of indices in only[] */
    ss_signal *signal;
    ss_error err = { 0 };

    tool_begin(argv, "ss-signal", usage);
    for (int c; (c = getopt_long(argc, argv, "r:d:a:f:o:qvh", longopts, NULL)) != -1;) {
        for (int i = 0; i < N_ONLY; i++)
            used |= only[i].option == c ? 1u << i : 0;
        switch (c) {
        case 'r': opts.rate = tool_number("--rate", optarg, DBL_MIN, DBL_MAX); break;
        case 'd': opts.duration = tool_number("--duration", optarg, 0, 1e12); break;
        case 'a': opts.amplitude = tool_number("--amplitude", optarg, -DBL_MAX, DBL_MAX); break;
        case 'f': opts.frequency = tool_number("--frequency", optarg, 0, 1e100); break;
        case OPT_TO: opts.frequency_end = tool_number("--to", optarg, 0, 1e100); break;
        case OPT_DAMPING: opts.damping = tool_number("--damping", optarg, 0, 1 - DBL_EPSILON / 2);
            break;
        case OPT_AT: opts.at = tool_number("--at", optarg, -1e12, 1e12); break;
        case OPT_SEED: opts.seed = (unsigned long)tool_integer("--seed", optarg, 0, 0x7fffffff);
            break;
        case 'o': output = optarg; break;
        case TOOL_OPT_FORMAT: kind = tool_format(optarg); break;
        default: tool_option(c);
        }
    }
    if (optind == argc)
        tool_usage("KIND is missing: sine, impulse, step, chirp, ringdown or noise");
    ss_wave wave = (ss_wave)tool_choice("KIND", tool_input(argc, argv, optind), kinds);
    for (int i = 0; i < N_ONLY; i++)
        if ((used & 1u << i) && !(only[i].kinds & SET(wave)))
            tool_usage("%s does not apply to kind %s", only[i].name, kinds[wave]);
    check_sense(wave, &opts, used);
    kind = tool_output_kind(output, TOOL_SIGNALS, kind);

    tool_check(ss_wave_new(&signal, wave, &opts, &err), &err);
    tool_note("%s: %zu samples", kinds[wave], signal->n);
    tool_write_signal(signal, output, kind);
    ss_signal_free(signal);
    tool_end();
    return 0;
}
