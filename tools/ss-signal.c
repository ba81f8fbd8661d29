/* ss-signal.c -- benchmark signals. */
#include "options.h"

#include <float.h>
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
"  -o, --output=FILE    write to FILE.tsv, .au, .csv, .json, .wav or .h5\n"
"      --format=FORM    on standard output: tsv (default), au, csv, json, wav\n"
"  -q, --quiet          no warnings; -v, --verbose: report the length\n"
"  -h, --help           show this text; --version: show the version\n";

/* Options that only some kinds have. */
#define SET(wave) (1u << (wave))
static const struct {
    const char *name;
    unsigned kinds;
} only[] = {
    { "frequency", SET(SS_SINE) | SET(SS_CHIRP) | SET(SS_RINGDOWN) },
    { "to", SET(SS_CHIRP) },
    { "damping", SET(SS_RINGDOWN) },
    { "at", SET(SS_SINE) | SET(SS_IMPULSE) | SET(SS_STEP) | SET(SS_RINGDOWN) },
    { "seed", SET(SS_NOISE) },
};

int
main(int argc, char *argv[])
{
    static const char *const kinds[] = { "sine", "impulse", "step", "chirp", "ringdown", "noise",
                                         NULL };
    const ss_range any = { -DBL_MAX, DBL_MAX }, times = { -1e12, 1e12 }, frequencies = { 0, 1e100 };
    const ss_range seeds = { 0, 0x7fffffff }, rates = { DBL_MIN, DBL_MAX }, durations = { 0, 1e12 };
    const ss_range damping_ratios = { 0, 1 - DBL_EPSILON / 2 };
    ss_wave_opts opts;
    const char *output = NULL;
    tool_kind kind = TOOL_TSV;
    ss_wave_opts_init(&opts, sizeof opts);
    int seed = (int)opts.seed;
    ss_signal *signal;
    const tool_option options[] = {
        TOOL_NUMBER('r', "rate", &opts.rate, rates),
        TOOL_NUMBER('d', "duration", &opts.duration, durations),
        TOOL_NUMBER('a', "amplitude", &opts.amplitude, any),
        TOOL_NUMBER('f', "frequency", &opts.frequency, frequencies),
        TOOL_NUMBER(0, "to", &opts.frequency_end, frequencies),
        TOOL_NUMBER(0, "damping", &opts.damping, damping_ratios),
        TOOL_NUMBER(0, "at", &opts.at, times), TOOL_WHOLE(0, "seed", &seed, seeds),
        TOOL_OUTPUT(&output), TOOL_FORMAT(&kind) };

    tool_begin(argv, "ss-signal", usage);
    int first = TOOL_PARSE(argc, argv, options, NULL);
    opts.seed = (unsigned long)seed;
    if (first == argc)
        tool_usage("KIND is missing: sine, impulse, step, chirp, ringdown or noise");
    ss_wave wave = (ss_wave)tool_choice("KIND", tool_input(argc, argv, first), kinds);
    for (size_t i = 0; i < sizeof only / sizeof *only; i++)
        if (tool_given(only[i].name) && !(only[i].kinds & SET(wave)))
            tool_usage("--%s does not apply to kind %s", only[i].name, kinds[wave]);
    /* values that are in range but hardly intended */
    double n = round(opts.duration * opts.rate), at = opts.at * opts.rate;
    double highest = wave == SS_CHIRP ? fmax(opts.frequency, opts.frequency_end) : opts.frequency;
    if ((SET(wave) & only[0].kinds) && highest > opts.rate / 2)
        tool_warn("%g Hz is above half the rate, %g Hz, and folds down", highest, opts.rate / 2);
    if (wave == SS_IMPULSE && tool_given("at") && !(at > -0.5 && round(at) < n))
        tool_usage("--at %g: the record goes from 0 to %g s, so no sample is nearest", opts.at, (n - 1) / opts.rate);
    kind = tool_output_kind(output, TOOL_SIGNALS, kind);

    tool_check(ss_wave_new(&signal, wave, &opts, &tool_error));
    tool_note("%s: %zu sample%s", kinds[wave], signal->n, tool_s(signal->n));
    tool_write(signal, output, kind);
    ss_signal_free(signal);
    tool_end();
    return 0;
}
