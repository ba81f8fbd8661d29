/* coefficients.c -- coefficients that are read.
 *
 * The stream's notes hold every option that the grid follows from, so that a reader rebuilds the grid and holds
 * each row against it: a row that is missing, doubled or out of place is found.  The edges follow from the grid,
 * too, and are not read.  Rows of different scales may come in any order, those of one scale with b ascending.  A
 * stream written before its length was known says that at its end. */
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/number.h"
#include "base/list.h"
#include "map/plan.h"
#include "io/format.h"

enum { LARGEST_M = 500 };       /* the largest |log2 a| */

/* A scale of which rows have been read. */
typedef struct part {
    ss_scale scale;             /* n is the grid's, SIZE_MAX until that is known */
    size_t n, room;             /* rows that have been read; room for rows */
    double *w;
} part;

typedef struct coefficient_reader {
    ss_reader *in;
    unsigned long row;          /* of AU, the one that is read */
    ss_error *err;
    ss_coefficients *coef;      /* its n is 0 until the length is known */
    ss_morlet_opts opts;        /* the options that determine the grid */
    part **part;                /* of every possible j, from the largest on; NULL: no row has it */
    size_t possible, n_parts;
} coefficient_reader;

/* SS_EDATA, with the number of the current line of text, or row of AU. */
SS_PRINTF(2, 3)
static ss_status
refuse(const coefficient_reader *r, const char *format, ...)
{
    char why[256];
    unsigned long line = r->in->source->line;
    va_list args;
    va_start(args, format);
    ss_print_text(why, sizeof why, format, args);
    va_end(args);
    return ss_fail(r->err, SS_EDATA, "%s:%s%lu: %s", r->in->source->name, line > 0 ? "" : " row ",
                   line > 0 ? line : r->row, why);
}

/* Set the number of translations of a scale, and what else follows from j and a. */
static ss_status
set_scale(coefficient_reader *r, ss_scale *scale, int j, double a)
{
    ss_error why = { 0 };
    if (ss_morlet_scale_at(scale, j, a, r->coef->n, r->coef->head->rate, &r->opts, &why) != SS_OK)
        return refuse(r, "%s", why.text);
    scale->n = r->coef->n == 0 ? SIZE_MAX : scale->n;
    return SS_OK;
}

static ss_status
append_row(coefficient_reader *r, const double number[COEFFICIENT_COLUMNS])
{
    const int voices = r->opts.voices;
    double m = number[0], a = number[1], f = number[3], j = rint(m * voices);
    if (!(fabs(m) <= LARGEST_M) || fabs(m * voices - j) > 1e-9 || !(fabs(a / exp2(m) - 1) < 1e-12)
        || !(fabs(f * 2 * M_PI * a / r->opts.center - 1) < 1e-12))
        return refuse(r, "m, a and f are not those of a scale with center %g and %d voice%s", r->opts.center,
                      voices, PLURAL(voices));
    part **known = &r->part[LARGEST_M * voices - (int)j], *p = *known;
    if (p == NULL) {
        if ((p = *known = calloc(1, sizeof *p)) == NULL)
            return SS_ENOMEM;
        ss_status st = set_scale(r, &p->scale, (int)j, a);
        if (st != SS_OK)
            return st;
        r->n_parts++;
    }
    if (p->n == p->scale.n)
        return refuse(r, "scale %g has %zu coefficient%s, this is one more", p->scale.m, p->n, PLURAL(p->n));
    double b = ss_scale_b(&p->scale, p->n);
    if (!(fabs(number[2] - b) <= 1e-12 * b))
        return refuse(r, "b is %.9g s where the grid has %.9g s", number[2], b);
    double *w = ss_list_room(p->w, &p->room, p->n, 2 * sizeof *w);
    if (w == NULL)
        return SS_ENOMEM;
    p->w = w;
    p->w[2 * p->n] = number[4];
    p->w[2 * p->n++ + 1] = number[5];
    return SS_OK;
}

/* Set the length of the record, and the number of translations of each scale, which follows from it. */
static ss_status
set_length(coefficient_reader *r, double samples)
{
    if (r->coef->n > 0)
        return refuse(r, "the number of samples is given twice");
    if (!(samples >= 1 && samples <= 0x1p53 && samples == floor(samples)))
        return refuse(r, "%g samples are not the length of a record", samples);
    r->coef->n = (size_t)samples;
    for (size_t i = 0; i < r->possible; i++) {
        part *p = r->part[i];
        ss_status st = p != NULL ? set_scale(r, &p->scale, p->scale.j, p->scale.a) : SS_OK;
        if (st != SS_OK)
            return st;
        if (p != NULL && p->n > p->scale.n)
            return refuse(r, "scale %g has %zu coefficient%s, not %zu", p->scale.m, p->scale.n, PLURAL(p->scale.n),
                          p->n);
    }
    return SS_OK;
}

/* A line "# samples: N" among the rows ends a stream. */
static ss_status
read_late_note(void *reader, char *line, ss_error *err)
{
    static const char length[] = "# samples: ";
    (void)err;
    if (strncmp(line, length, sizeof length - 1) != 0)
        return SS_OK;
    return set_length(reader, ss_number_parse(line + sizeof length - 1, NULL));
}

static ss_status
assemble(coefficient_reader *r)
{
    ss_coefficients *coef = r->coef;
    size_t total = 0;
    if (r->n_parts == 0)
        return ss_fail(r->err, SS_EDATA, "%s: a header without coefficients", r->in->source->name);
    if (coef->n == 0)
        return refuse(r, "cut short: a stream ends with its number of samples");
    if ((coef->scale = malloc(r->n_parts * sizeof *coef->scale)) == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < r->possible; i++) {
        part *p = r->part[i];
        if (p == NULL)
            continue;
        if (p->n < p->scale.n)
            return refuse(r, "ends with %zu of the %zu coefficients of scale %g", p->n, p->scale.n, p->scale.m);
        p->scale.offset = total;
        coef->scale[coef->n_scales++] = p->scale;
        total += p->n;
    }
    if ((coef->w = malloc(2 * total * sizeof *coef->w)) == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < r->possible; i++) {
        part *p = r->part[i];
        if (p == NULL)
            continue;
        memcpy(coef->w + 2 * p->scale.offset, p->w, 2 * p->n * sizeof *p->w);
        free(p->w);                     /* now, as there may be no memory for all of them twice */
        p->w = NULL;
    }
    return SS_OK;
}

/* In AU, a row at scale 0 ends a stream: its b is the time of the last sample. */
static ss_status
read_all(coefficient_reader *r, FILE *in, const char *name)
{
    double row[COEFFICIENT_COLUMNS], *column[COEFFICIENT_COLUMNS];
    size_t n = 1;
    struct opening o = { .kind = SS_KIND_COEFFICIENTS, .late_note = read_late_note, .user = r };
    ss_error why;
    ss_status st = ss_reader_open(&r->in, in, name, &o, r->err);
    if (st != SS_OK)
        return st;
    const ss_header *head = r->in->source->head;
    int known = head->n_columns == COEFFICIENT_COLUMNS && !head->has_time;
    for (size_t i = 0; known && i < COEFFICIENT_COLUMNS; i++)
        known = strcmp(head->column[i].name, ss_coefficient_columns[i][0]) == 0
            && strcmp(head->column[i].unit, ss_coefficient_columns[i][1]) == 0;
    if (!known)
        return ss_fail_wanted(ss_fail(r->err, SS_EKIND, "%s: the columns are not those of wavelet "
                                      "coefficients, m a/s b/s f/Hz re im edge", r->in->source->name),
                              SS_KIND_COEFFICIENTS, r->err);
    r->coef = calloc(1, sizeof *r->coef);
    if (r->coef == NULL)
        return SS_ENOMEM;
    st = ss_header_select(&r->coef->head, head, NULL, 0, 0, NULL);      /* without columns */
    if (st == SS_OK)
        r->coef->head->has_time = 1;
    if (st == SS_OK && (st = ss_coefficients_take_notes(r->coef, &r->opts, &why)) == SS_EDATA)
        ss_fail(r->err, st, "%s: %s", r->in->source->name, why.text);
    if (st != SS_OK)
        return st;
    r->possible = 2 * LARGEST_M * (size_t)r->opts.voices + 1;
    r->part = calloc(r->possible, sizeof(part *));
    if (r->part == NULL)
        return SS_ENOMEM;
    for (int c = 0; c < COEFFICIENT_COLUMNS; c++)
        column[c] = &row[c];
    while (st == SS_OK && n > 0) {
        st = ss_reader_rows(r->in, column, 1, &n, r->err);
        r->row += st == SS_OK ? n : 0;
        if (st == SS_OK && n > 0)
            st = row[1] == 0 ? set_length(r, rint(row[2] * r->coef->head->rate) + 1) : append_row(r, row);
    }
    return st == SS_OK ? assemble(r) : st;
}

ss_status
ss_coefficients_read(ss_coefficients **out, FILE *in, const char *name, ss_error *err)
{
    coefficient_reader r = { .err = err };
    if (out == NULL || name == NULL)
        return SS_FAIL_NULL(err);
    const struct format *format = in == NULL ? ss_format_of_file(name) : NULL;
    if (format != NULL)
        return format->open_map(out, name, err);
    ss_status st = read_all(&r, in, name);
    for (size_t i = 0; r.part != NULL && i < r.possible; i++) {
        if (r.part[i] != NULL)
            free(r.part[i]->w);
        free(r.part[i]);
    }
    free(r.part);
    ss_reader_free(r.in);
    if (st == SS_OK)
        *out = r.coef;
    else
        ss_coefficients_free(r.coef);
    return st;
}
