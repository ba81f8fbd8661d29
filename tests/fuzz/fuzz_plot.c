/* fuzz_plot.c -- scripts for gnuplot: text of files stands in strings, numbers are numbers.
 *
 * The input is cut at its zero bytes into texts (title, notes, names, units) and, behind them, numbers.
 * Every kind of script is written of them and read by a strict tokenizer: a data block holds numbers,
 * a string in double quotes letters, digits, signs without a meaning and escapes; all that is left
 * is compared with the script that harmless texts give. */
#include "fuzz.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TEXTS = 6, NUMBERS = 48, SCALES = 3, PER_SCALE = 4, LEVELS = 2 };

typedef struct material {
    char *text[TEXTS];
    double x[NUMBERS];
} material;

static void
cut(material *m, const uint8_t *bytes, size_t size)
{
    for (int i = 0; i < TEXTS; i++) {
        size_t n = 0;
        while (n < size && bytes[n] != '\0')
            n++;
        m->text[i] = calloc(n + 1, 1);
        fuzz_check(m->text[i] != NULL, "memory");
        memcpy(m->text[i], bytes, n);
        n += n < size;
        bytes += n;
        size -= n;
    }
    for (size_t i = 0; i < NUMBERS; i++) {
        m->x[i] = sin((double)i);
        if (size >= (i + 1) * sizeof m->x[i])
            memcpy(&m->x[i], bytes + i * sizeof m->x[i], sizeof m->x[i]);
    }
}

/* --- what is drawn ------------------------------------------------------------------------- */

typedef enum kind { PANELS, XY, CONTOUR, MAP, TRADE, KINDS } kind;

static ss_signal *
make_signal(const material *m)
{
    ss_signal *signal = NULL;
    ss_header *head = NULL;
    ss_header_new(&head, 100, 0, NULL);
    fuzz_check(head != NULL, "memory");
    ss_header_note(head, "scene", m->text[1], NULL);
    for (int i = 0; i < 2; i++)
        if (ss_header_add_column(head, m->text[2 + 2 * i], m->text[3 + 2 * i], NULL) != SS_OK)
            ss_header_add_column(head, i == 0 ? "a" : "b", "", NULL);
    fuzz_check(ss_signal_new(&signal, head, NUMBERS / 2, NULL) == SS_OK, "a signal");
    ss_header_free(head);
    memcpy(signal->values, m->x, sizeof m->x);
    return signal;
}

static ss_status
draw_contour(FILE *out, const material *m, const ss_signal *signal, const ss_plot_opts *opts,
             ss_error *err)
{
    ss_scale scale[SCALES];
    double w[2 * SCALES * PER_SCALE], event[] = { m->x[24] };
    ss_contour_opts contour;
    ss_contour_opts_init(&contour, sizeof contour);
    memcpy(w, m->x, sizeof w);
    for (size_t i = 0; i < SCALES; i++)
        scale[i] = (ss_scale){ .a = 0.05 / (double)(1 << i), .f = 4 << i, .b_num = 8, .b_den = 100,
                               .n = PER_SCALE, .offset = i * PER_SCALE };
    const ss_coefficients c = { .head = signal->head, .n = NUMBERS / 2, .center = 6, .n_scales = SCALES,
                                .scale = scale, .w = w };
    contour.signal = signal;
    contour.event = event;
    contour.n_events = 1;
    contour.levels = LEVELS;
    return ss_plot_contour(out, &c, &contour, opts, err);
}

static ss_status
draw_map(FILE *out, const material *m, const ss_plot_opts *opts, ss_error *err)
{
    ss_column column[] = { { m->text[2], m->text[3] }, { m->text[4], m->text[5] }, { m->text[1], "" },
                           { m->text[0], m->text[1] } };
    enum { POINTS = 9 };
    char text[4 * POINTS][SS_NUMBER_MAX], *cell[4 * POINTS], note[512], *notes[] = { note };
    snprintf(note, sizeof note, "scene: %s", m->text[1]);
    for (int i = 0; i < POINTS; i++) {
        const double row[4] = { i % 3, (double)(i / 3) + m->x[i / 3], i % 2, m->x[i] };
        for (int c = 0; c < 4; c++)
            ss_number_format(cell[4 * i + c] = text[4 * i + c], row[c]);
    }
    const ss_table table = { .n_notes = 1, .note = notes, .n_columns = 4, .column = column, .n = POINTS,
                             .cell = cell };
    return ss_plot_sweep(out, &table, (const size_t[]){ 0, 1, 2, 3 }, 4, opts, err);
}

static ss_status
draw_trade(FILE *out, const material *m, const ss_plot_opts *opts, ss_error *err)
{
    ss_trade_row row[4] = { { 0 } };
    const ss_trade trade = { .n = 4, .row = row };
    for (int i = 0; i < 4; i++) {
        row[i].method = m->text[2 + i / 2];
        row[i].seconds = m->x[2 * i];
        row[i].error_x = m->x[2 * i + 1];
        row[i].frontier = i == 0;
    }
    return ss_plot_trade(out, &trade, opts, err);
}

/* The script, or NULL and its refusal looked at. */
static char *
draw(const material *m, kind k)
{
    char *text = NULL;
    size_t length = 0;
    ss_error err = { 0 };
    ss_plot_opts opts;
    ss_plot_opts_init(&opts, sizeof opts);
    ss_signal *signal = make_signal(m);
    FILE *out = open_memstream(&text, &length);
    fuzz_check(out != NULL, "memory for a stream");
    opts.title = k == PANELS ? NULL : m->text[0];
    if (k == XY) {
        opts.output = m->text[5];
        opts.format = "svg";
    }
    ss_reader *reader = NULL;
    fuzz_check(ss_reader_of_signal(&reader, signal, &err) == SS_OK, "memory for a reader");
    ss_status status = k == PANELS ? ss_plot_signal(out, reader, NULL, 0, &opts, &err)
        : k == XY ? ss_plot_xy(out, reader, 0, 1, &opts, &err)
        : k == CONTOUR ? draw_contour(out, m, signal, &opts, &err)
        : k == MAP ? draw_map(out, m, &opts, &err) : draw_trade(out, m, &opts, &err);
    fclose(out);
    ss_reader_free(reader);
    ss_signal_free(signal);
    if (status == SS_OK)
        return text;
    fuzz_check_refusal(status == SS_EINVAL ? SS_EDATA : status, &err);
    free(text);
    return NULL;
}

/* --- what a script may be -------------------------------------------------------------------- */

/* The end of a string that begins behind text, which may be anything but a mistake. */
static const char *
skip_string(const char *text)
{
    for (; *text != '"'; text++) {
        if (*text == '\\' && text[1] == 'n') {
            text++;
            continue;
        }
        if (*text == '\\') {
            for (int i = 0; i < 3; i++)
                fuzz_check(*++text >= '0' && *text <= '7', "three octal digits");
            fuzz_check(!isdigit((unsigned char)text[1]), "no digit that gnuplot would read with them");
            continue;
        }
        fuzz_check(*text != '\0' && (isalnum((unsigned char)*text) || strchr(" ()+,-./:=_", *text)),
                   "nothing in a string that gnuplot knows");
    }
    return text + 1;
}

/* Numbers and blanks up to EOD, no nan among them. */
static const char *
skip_block(const char *text)
{
    for (; strncmp(text, "EOD\n", 4) != 0; text = strchr(text, '\n') + 1)
        fuzz_check(text[strspn(text, "0123456789+-.e ")] == '\n', "numbers in a data block");
    return text + 4;
}

/* The script without data blocks, strings, the size of letters and the digits of numbers, to be
 * freed. */
static char *
outline(const char *text)
{
    static const char block[] = "<< EOD\n", font[] = " font sprintf(";
    static const char ours[] = "colours = \"0 '#7ad151', ";     /* the palette, quotes in a string */
    char *bare = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&bare, &length);
    fuzz_check(out != NULL, "memory for a stream");
    while (*text != '\0')
        if (strncmp(text, ours, sizeof ours - 1) == 0)
            text += strcspn(text, "\n");
        else if (*text == '"')
            text = skip_string(text + 1);
        else if (strncmp(text, block, sizeof block - 1) == 0)
            text = skip_block(text + sizeof block - 1);
        else if (strncmp(text, font, sizeof font - 1) == 0)
            text += strcspn(text, "\n");
        else if (isdigit((unsigned char)*text) || *text == '.')
            text++;
        else
            putc(*text++, out);
    fclose(out);
    return bare;
}

/* The same material with a letter for each text; equal texts stay equal. */
static material
make_harmless(const material *m, char letters[TEXTS][2])
{
    material harmless = *m;
    for (int i = 0; i < TEXTS; i++) {
        int first = 0;
        while (strcmp(m->text[first], m->text[i]) != 0)
            first++;
        letters[i][0] = (char)('a' + first);
        letters[i][1] = '\0';
        harmless.text[i] = letters[i];
    }
    return harmless;
}

static void
compare(const material *m, const material *harmless, kind k)
{
    char *script = draw(m, k), *other = draw(harmless, k);
    fuzz_check((script == NULL) == (other == NULL), "no text is refused");
    if (script == NULL)
        return;
    fuzz_check(strstr(script, "set output \"|") == NULL && strstr(script, "set output \"\\174") == NULL,
               "no output to a program");
    char *bare = outline(script), *other_bare = outline(other);
    fuzz_check(strcmp(bare, other_bare) == 0, "text is in strings only");
    free(bare);
    free(other_bare);
    free(script);
    free(other);
}

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    material m;
    char letters[TEXTS][2];
    cut(&m, bytes, size);
    const material harmless = make_harmless(&m, letters);
    for (int k = 0; k < KINDS; k++)
        compare(&m, &harmless, (kind)k);
    for (int i = 0; i < TEXTS; i++)
        free(m.text[i]);
    return 0;
}
