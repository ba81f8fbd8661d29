/* coefficients.c -- coefficients with the grid they stand on, and their text stream.
 *
 * The stream's notes hold every option that the grid follows from, so that a reader rebuilds the
 * grid and holds each row against it: a row that is missing, doubled or out of place is found.
 * Rows of different scales may come in any order, those of one scale with b ascending. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "error.h"
#include "morlet/plan.h"
#include "signal/stream.h"

static const char magic[] = "# stickslip coefficients 1";
static const char columns[] = "# columns: m a/s b/s f/Hz re im edge";
enum { N_COLUMNS = 7 };

static const char *const norm_name[] = { "l2", "l1" };
static const char *const engine_name[] = { "auto", "quadrature", "fft" };
static const char *const detrend_name[] = { "none", "mean", "linear" };

void
ss_coefficients_free(ss_coefficients *coefficients)
{
    if (coefficients == NULL)
        return;
    ss_header_free(coefficients->head);
    free(coefficients->scale);
    free(coefficients->w);
    free(coefficients->gap);
    free(coefficients);
}

static int
is_edge(const ss_coefficients *c, const ss_scale *scale, size_t k)
{
    return ss_scale_edge(scale, k, c->n, c->head->rate)
        || ss_near_gap(c->gap, c->n_gaps, c->head->start + ss_scale_b(scale, k), sqrt(2) * scale->a);
}

int
ss_coefficients_edge(const ss_coefficients *coefficients, size_t i, size_t k)
{
    return is_edge(coefficients, &coefficients->scale[i], k);
}

double
ss_coefficients_max(const ss_coefficients *coefficients)
{
    double outside = -1, all = 0;
    for (size_t i = 0; i < coefficients->n_scales; i++) {
        const ss_scale *scale = &coefficients->scale[i];
        const double *w = coefficients->w + 2 * scale->offset;
        for (size_t k = 0; k < scale->n; k++) {
            double level = hypot(w[2 * k], w[2 * k + 1]);
            all = fmax(all, level);
            if (level > outside && !ss_coefficients_edge(coefficients, i, k))
                outside = level;
        }
    }
    return outside >= 0 ? outside : all;
}

/* --- transforming -------------------------------------------------------------------------- */

static ss_status
note_number(ss_header *head, const char *key, double value)
{
    char text[SS_NUMBER_MAX];
    ss_number_format(text, value);
    return ss_header_note(head, key, text);
}

static ss_status
note_options(ss_header *head, const ss_signal *signal, size_t column, const ss_morlet_opts *opts)
{
    const ss_column *col = &signal->head->column[column];
    int failed = note_number(head, "samples", (double)signal->n)
        || ss_header_note(head, "column", col->name)
        || (col->unit[0] != '\0' && ss_header_note(head, "unit", col->unit))
        || note_number(head, "center", opts->center) || note_number(head, "voices", opts->voices)
        || (opts->dense ? ss_header_note(head, "dense", "yes")
                        : note_number(head, "step", opts->step))
        || ss_header_note(head, "norm", norm_name[opts->norm])
        || ss_header_note(head, "admissible", opts->admissible ? "yes" : "no")
        || ss_header_note(head, "detrend", detrend_name[opts->detrend])
        || note_number(head, "accuracy", opts->accuracy)
        || ss_header_note(head, "method", engine_name[opts->engine]);
    return failed ? SS_ENOMEM : SS_OK;
}

static ss_status
fill(ss_coefficients *coef, const ss_signal *signal, size_t column, const ss_morlet *plan,
     const ss_morlet_opts *opts, ss_error *err)
{
    ss_status st = ss_header_select(&coef->head, signal->head, &column, 1, 0);
    if (st != SS_OK || (st = note_options(coef->head, signal, column, opts)) != SS_OK
        || (st = ss_header_gaps(&coef->gap, &coef->n_gaps, coef->head)) != SS_OK)
        return st;
    coef->n = signal->n;
    coef->center = opts->center;
    coef->n_scales = plan->n_scales;
    coef->scale = malloc(plan->n_scales * sizeof *coef->scale);
    coef->w = malloc(2 * plan->total * sizeof *coef->w);
    if (coef->scale == NULL || coef->w == NULL)
        return SS_ENOMEM;
    memcpy(coef->scale, plan->scale, plan->n_scales * sizeof *coef->scale);
    return ss_morlet_execute(plan, signal->values + column * signal->n, coef->w, err);
}

ss_status
ss_transform(ss_coefficients **out, const ss_signal *signal, size_t column,
             const ss_morlet_opts *opts, ss_error *err)
{
    ss_morlet *plan = NULL;
    if (column >= signal->head->n_columns)
        return ss_fail(err, SS_EINVAL, "no column %zu, there are %zu", column + 1,
                       signal->head->n_columns);
    ss_status st = ss_morlet_new(&plan, signal->n, signal->head->rate, opts, err);
    if (st != SS_OK)
        return st;
    ss_coefficients *coef = calloc(1, sizeof *coef);
    st = coef == NULL ? SS_ENOMEM : fill(coef, signal, column, plan, opts, err);
    ss_morlet_free(plan);
    if (st == SS_OK)
        *out = coef;
    else
        ss_coefficients_free(coef);
    return st;
}

/* --- writing ------------------------------------------------------------------------------- */

static void
put(FILE *out, double x, char end)
{
    char text[SS_NUMBER_MAX];
    ss_number_format(text, x);
    fputs(text, out);
    putc(end, out);
}

static void
write_scale(const ss_coefficients *coef, const ss_scale *scale, FILE *out)
{
    char m[SS_NUMBER_MAX], a[SS_NUMBER_MAX], f[SS_NUMBER_MAX];
    const double *w = coef->w + 2 * scale->offset;
    ss_number_format(m, scale->m);
    ss_number_format(a, scale->a);
    ss_number_format(f, scale->f);
    for (size_t k = 0; k < scale->n; k++) {
        fprintf(out, "%s\t%s\t", m, a);
        put(out, ss_scale_b(scale, k), '\t');
        fprintf(out, "%s\t", f);
        put(out, w[2 * k], '\t');
        put(out, w[2 * k + 1], '\t');
        fputs(is_edge(coef, scale, k) ? "1\n" : "0\n", out);
    }
}

ss_status
ss_coefficients_write(const ss_coefficients *coefficients, FILE *out)
{
    const ss_header *head = coefficients->head;
    fprintf(out, "%s\n", magic);
    for (size_t i = 0; i < head->n_notes; i++)
        fprintf(out, "# %s\n", head->note[i]);
    fputs("# rate: ", out);
    put(out, head->rate, '\n');
    fputs("# start: ", out);
    put(out, head->start, '\n');
    fprintf(out, "%s\n", columns);
    for (size_t i = 0; i < coefficients->n_scales && !ferror(out); i++)
        write_scale(coefficients, &coefficients->scale[i], out);
    return ferror(out) ? SS_EIO : SS_OK;
}

/* --- reading ------------------------------------------------------------------------------- */

/* A scale of which rows have come. */
typedef struct part {
    ss_scale scale;             /* n is what the grid has */
    size_t n, room;             /* rows that have come, room for so many */
    double *w;
} part;

typedef struct reader {
    struct input in;
    ss_error *err;
    char *text;                 /* the current line */
    ss_coefficients *coef;
    ss_morlet_opts opts;        /* what the grid follows from */
    part *part;
    size_t n_parts, room, last; /* last: the part of the row before */
    size_t *part_of;            /* of every j that there can be, its part from 1; 0: none yet */
} reader;

enum { LARGEST_M = 500 };       /* |log2 a| */

/* The next line without its end; *more = 0 if there is none. */
static ss_status
next_line(reader *r, int *more)
{
    size_t length;
    ss_status st = ss_input_line(&r->in, &r->text, &length, r->err);
    *more = r->text != NULL;
    if (st == SS_OK && *more && strlen(r->text) != length)
        return ss_fail(r->err, SS_EDATA, "%s:%lu: a NUL byte in text", r->in.name, r->in.line);
    return st;
}

/* --- header lines */

static ss_status
read_note(reader *r, const char *key, const char *value)
{
    char *end;
    ss_header *head = r->coef->head;
    double *number = strcmp(key, "rate") == 0 ? &head->rate
        : strcmp(key, "start") == 0 ? &head->start : NULL;
    if (number == NULL) {
        if (head->n_notes == MAX_NOTES)
            return ss_fail(r->err, SS_EDATA, "%s:%lu: more than 4096 notes", r->in.name,
                           r->in.line);
        ss_status st = ss_header_note(head, key, value);
        return st != SS_EINVAL ? st : ss_fail(r->err, SS_EDATA, "%s:%lu: '%s' cannot be the key of "
                                              "a note", r->in.name, r->in.line, key);
    }
    *number = ss_number_parse(value, &end);
    if (end == value || *end != '\0' || !isfinite(*number))
        return ss_fail(r->err, SS_EDATA, "%s:%lu: %s '%s' is not a number", r->in.name, r->in.line,
                       key, value);
    return SS_OK;
}

static ss_status
check_magic(const reader *r, int more)
{
    if (!more)
        return ss_fail(r->err, SS_EDATA, "%s: empty, no coefficients", r->in.name);
    if (strncmp(r->text, "\211HDF", 4) == 0)
        return ss_fail(r->err, SS_EDATA, "%s: HDF5 cannot be read from a stream; give its path",
                       r->in.name);
    if (strncmp(r->text, "# stickslip signal", 18) == 0)
        return ss_fail(r->err, SS_EDATA, "%s:1: a signal where coefficients are expected; "
                       "ss-morlet makes them", r->in.name);
    if (strcmp(r->text, magic) != 0)
        return ss_fail(r->err, SS_EDATA, "%s:1: not a coefficient stream, which begins '%s'",
                       r->in.name, magic);
    return SS_OK;
}

/* Everything up to and with the line of columns. */
static ss_status
read_header(reader *r)
{
    int more;
    ss_status st = next_line(r, &more);
    if (st != SS_OK || (st = check_magic(r, more)) != SS_OK)
        return st;
    while ((st = next_line(r, &more)) == SS_OK && more && strcmp(r->text, columns) != 0) {
        if (strncmp(r->text, "# ", 2) != 0 || strncmp(r->text, columns, 10) == 0)
            return ss_fail(r->err, SS_EDATA, "%s:%lu: expected '%s'", r->in.name, r->in.line,
                           columns);
        char *colon = strstr(r->text, ": ");
        if (colon == NULL)
            continue;                   /* a comment of someone's */
        *colon = '\0';
        if ((st = read_note(r, r->text + 2, colon + 2)) != SS_OK)
            return st;
    }
    if (st == SS_OK && !more)
        return ss_fail(r->err, SS_EDATA, "%s: ends before '%s'", r->in.name, columns);
    return st;
}

static ss_status
required(const reader *r, const char *key, const char **value)
{
    *value = ss_header_find_note(r->coef->head, key);
    if (*value == NULL)
        return ss_fail(r->err, SS_EDATA, "%s: no line '# %s: ...'", r->in.name, key);
    return SS_OK;
}

static ss_status
required_number(const reader *r, const char *key, double hi, double *x)
{
    const char *value;
    char *end;
    ss_status st = required(r, key, &value);
    if (st != SS_OK)
        return st;
    *x = ss_number_parse(value, &end);
    if (end == value || *end != '\0' || !(*x > 0 && *x <= hi))
        return ss_fail(r->err, SS_EDATA, "%s: '# %s: %s' is out of range", r->in.name, key, value);
    return SS_OK;
}

/* The options that the grid follows from. */
static ss_status
read_options(reader *r)
{
    ss_coefficients *coef = r->coef;
    const char *dense = ss_header_find_note(coef->head, "dense"), *column, *unit;
    double samples, voices;
    ss_status st;
    r->opts = ss_morlet_defaults;
    r->opts.dense = dense != NULL && strcmp(dense, "yes") == 0;
    if ((st = required_number(r, "samples", 0x1p53, &samples)) != SS_OK
        || (st = required_number(r, "center", 1000, &r->opts.center)) != SS_OK
        || (st = required_number(r, "voices", 1024, &voices)) != SS_OK
        || (st = required(r, "column", &column)) != SS_OK)
        return st;
    if (!r->opts.dense && (st = required_number(r, "step", 1e100, &r->opts.step)) != SS_OK)
        return st;
    if (samples != floor(samples) || voices != floor(voices))
        return ss_fail(r->err, SS_EDATA, "%s: samples and voices are not whole numbers",
                       r->in.name);
    coef->n = (size_t)samples;
    coef->center = r->opts.center;
    r->opts.voices = (int)voices;
    ss_error why = { "" };
    if (ss_morlet_check(coef->n, coef->head->rate, &r->opts, &why) != SS_OK)
        return ss_fail(r->err, SS_EDATA, "%s: %s", r->in.name, why.text);
    unit = ss_header_find_note(coef->head, "unit");
    return ss_header_add_column(coef->head, column, unit != NULL ? unit : "");
}

/* --- rows */

static ss_status
read_numbers(const reader *r, double number[N_COLUMNS])
{
    const char *at = r->text;
    for (int i = 0; i < N_COLUMNS; i++) {
        char *end;
        number[i] = ss_number_parse(at, &end);
        if (end == at || !isfinite(number[i]))
            return ss_fail(r->err, SS_EDATA, "%s:%lu: column %d is not a number", r->in.name,
                           r->in.line, i + 1);
        if (*end != (i + 1 < N_COLUMNS ? '\t' : '\0'))
            return ss_fail(r->err, SS_EDATA, "%s:%lu: expected %d numbers separated by tabs",
                           r->in.name, r->in.line, N_COLUMNS);
        at = end + 1;
    }
    return SS_OK;
}

static ss_status
new_part(reader *r, int j, const double number[])
{
    ss_error why = { "" };
    if (r->n_parts == r->room) {
        size_t room = 2 * r->room + 16;
        part *more = room > SIZE_MAX / sizeof *more ? NULL : realloc(r->part, room * sizeof *more);
        if (more == NULL)
            return SS_ENOMEM;
        r->part = more;
        r->room = room;
    }
    part *p = &r->part[r->n_parts];
    *p = (part){ .n = 0 };
    if (ss_morlet_scale_at(&p->scale, j, number[1], r->coef->n, r->coef->head->rate, &r->opts, &why)
        != SS_OK)
        return ss_fail(r->err, SS_EDATA, "%s:%lu: %s", r->in.name, r->in.line, why.text);
    r->n_parts++;
    return SS_OK;
}

/* Make the part of this row the last one. */
static ss_status
find_part(reader *r, const double number[])
{
    double m = number[0], a = number[1], f = number[3], j = rint(m * r->opts.voices);
    if (!(fabs(m) <= LARGEST_M) || fabs(m * r->opts.voices - j) > 1e-9
        || !(fabs(a / exp2(m) - 1) < 1e-12)
        || !(fabs(f * 2 * M_PI * a / r->opts.center - 1) < 1e-12))
        return ss_fail(r->err, SS_EDATA, "%s:%lu: m, a and f are not those of a scale with center "
                       "%g and %d voices", r->in.name, r->in.line, r->opts.center, r->opts.voices);
    size_t *known = &r->part_of[(int)j + LARGEST_M * r->opts.voices];
    if (*known == 0) {
        ss_status st = new_part(r, (int)j, number);
        if (st != SS_OK)
            return st;
        *known = r->n_parts;
    }
    r->last = *known - 1;
    return SS_OK;
}

static ss_status
append(part *p, double re, double im)
{
    if (p->n == p->room) {
        size_t room = 2 * p->room + 64;
        double *more = room > SIZE_MAX / (2 * sizeof *more) ? NULL
            : realloc(p->w, 2 * room * sizeof *more);
        if (more == NULL)
            return SS_ENOMEM;
        p->w = more;
        p->room = room;
    }
    p->w[2 * p->n] = re;
    p->w[2 * p->n++ + 1] = im;
    return SS_OK;
}

static ss_status
read_row(reader *r)
{
    double number[N_COLUMNS];
    ss_status st = read_numbers(r, number);
    if (st != SS_OK || (st = find_part(r, number)) != SS_OK)
        return st;
    part *p = &r->part[r->last];
    if (p->n == p->scale.n)
        return ss_fail(r->err, SS_EDATA, "%s:%lu: scale %g has %zu coefficients, this is one more",
                       r->in.name, r->in.line, p->scale.m, p->n);
    double b = ss_scale_b(&p->scale, p->n);
    if (!(fabs(number[2] - b) <= 1e-12 * b))
        return ss_fail(r->err, SS_EDATA, "%s:%lu: b is %.9g s where the grid has %.9g s",
                       r->in.name, r->in.line, number[2], b);
    if (number[6] != is_edge(r->coef, &p->scale, p->n))
        return ss_fail(r->err, SS_EDATA, "%s:%lu: edge is %g, not what the cone of influence gives",
                       r->in.name, r->in.line, number[6]);
    return append(p, number[4], number[5]);
}

static ss_status
take_rows(reader *r)
{
    int more;
    ss_status st;
    while ((st = next_line(r, &more)) == SS_OK && more)
        if (r->text[0] != '#' && (st = read_row(r)) != SS_OK)
            return st;
    return st;
}

/* --- the whole */

static int
longer_first(const void *a, const void *b)
{
    const part *p = a, *q = b;
    return (p->scale.j < q->scale.j) - (p->scale.j > q->scale.j);
}

static ss_status
assemble(reader *r)
{
    ss_coefficients *coef = r->coef;
    size_t total = 0;
    if (r->n_parts == 0)
        return ss_fail(r->err, SS_EDATA, "%s: a header without coefficients", r->in.name);
    for (size_t i = 0; i < r->n_parts; i++) {
        const part *p = &r->part[i];
        if (p->n < p->scale.n)
            return ss_fail(r->err, SS_EDATA, "%s:%lu: ends with %zu of the %zu coefficients of "
                           "scale %g", r->in.name, r->in.line, p->n, p->scale.n, p->scale.m);
        total += p->n;
    }
    qsort(r->part, r->n_parts, sizeof *r->part, longer_first);
    coef->scale = malloc(r->n_parts * sizeof *coef->scale);
    coef->w = malloc(2 * total * sizeof *coef->w);
    if (coef->scale == NULL || coef->w == NULL)
        return SS_ENOMEM;
    for (size_t offset = 0; coef->n_scales < r->n_parts; coef->n_scales++) {
        part *p = &r->part[coef->n_scales];
        p->scale.offset = offset;
        coef->scale[coef->n_scales] = p->scale;
        memcpy(coef->w + 2 * offset, p->w, 2 * p->n * sizeof *p->w);
        offset += p->n;
    }
    return SS_OK;
}

static ss_status
read_all(reader *r)
{
    ss_status st;
    r->coef = calloc(1, sizeof *r->coef);
    if (r->coef == NULL || (r->coef->head = ss_header_new(0, 0)) == NULL)
        return SS_ENOMEM;
    if ((st = read_header(r)) != SS_OK || (st = read_options(r)) != SS_OK
        || (st = ss_header_gaps(&r->coef->gap, &r->coef->n_gaps, r->coef->head)) != SS_OK)
        return st;
    r->part_of = calloc(2 * LARGEST_M * (size_t)r->opts.voices + 1, sizeof *r->part_of);
    if (r->part_of == NULL)
        return SS_ENOMEM;
    return (st = take_rows(r)) != SS_OK ? st : assemble(r);
}

ss_status
ss_coefficients_read(ss_coefficients **out, FILE *in, const char *name, ss_error *err)
{
    reader r = { .err = err };
    ss_status st = ss_input_open(&r.in, in, name, err);
    if (st == SS_OK)
        st = read_all(&r);
    for (size_t i = 0; i < r.n_parts; i++)
        free(r.part[i].w);
    free(r.part);
    free(r.part_of);
    ss_input_close(&r.in);
    if (st == SS_OK)
        *out = r.coef;
    else
        ss_coefficients_free(r.coef);
    return st;
}
