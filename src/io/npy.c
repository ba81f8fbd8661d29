/* npy.c -- NumPy's .npy: a header and the numbers of one array, of one type or of named fields.
 *
 * The header is a Python dictionary of three keys: descr, fortran_order and shape.  (NumPy Enhancement
 * Proposal 1.)  The columns of a 2-D array are its shorter dimension, as in HDF5. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "signal/header.h"
#include "io/frames.h"
#include "io/table/sheet.h"
#include "io/table/text.h"

enum { MAGIC_BYTES = 8, HEADER_MOST = 1 << 20, RECORD_MOST = 1 << 20 };
#define QUOTE "\1"              /* of strings in the header as it is parsed */

struct field {
    sample_type type;
    size_t at;                  /* its first byte in a record */
};

struct npy {
    ss_source base;
    struct input *in;
    struct field *field;
    size_t n_fields, room, record;      /* record: bytes of all fields */
    int named, fortran;
    size_t rows, columns;
    double *value;                      /* of a row */
    struct kept all;                    /* values of an array whose columns follow each other in the file */
};

/* Copy a line without the blanks outside of strings, and with QUOTE for either kind of quotes around these. */
static char *
tidy(const char *p)
{
    char *copy = malloc(strlen(p) + 1), *to = copy, quote = '\0';
    for (; copy != NULL && *p != '\0'; p++)
        if (quote != '\0' ? *p == quote : *p == '\'' || *p == '"') {
            quote = quote != '\0' ? '\0' : *p;
            *to++ = *QUOTE;
        } else if (quote != '\0' || *p != ' ')
            *to++ = *p;
    if (copy != NULL)
        *to = '\0';
    return copy;
}

/* Skip this text, if it stands at *p. */
static int
skip(const char **p, const char *text)
{
    size_t n = strlen(text);
    int found = strncmp(*p, text, n) == 0;
    *p += found ? n : 0;
    return found;
}

/* Add a field of the type at *p: "<f8", ">i2" or "|u1"; or leave out bytes, "|V4". */
static ss_status
add_field(struct npy *a, const char *name, const char **p)
{
    char order, kind, number[32];
    unsigned bytes;
    int length = 0;
    if (sscanf(*p, QUOTE "%c%c%7u" QUOTE "%n", &order, &kind, &bytes, &length) != 3 || length == 0)
        return SS_EDATA;
    sample_type type = { bytes, kind == 'f', kind == 'u' || kind == 'b', order != '>' };
    int known = kind == 'f' ? bytes == 4 || bytes == 8 : kind == 'V' ? a->named && bytes > 0
        : strchr("iub", kind) != NULL && (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8);
    if (strchr("<>|=", order) == NULL || !known || bytes > RECORD_MOST || a->record > RECORD_MOST
        || a->n_fields == MAX_COLUMNS)
        return SS_EDATA;
    struct field *more = ss_list_room(a->field, &a->room, a->n_fields, sizeof *more);
    if (more == NULL)
        return SS_ENOMEM;
    *p += length;
    a->field = more;
    more[a->n_fields] = (struct field){ type, a->record };
    a->record += bytes;
    if (kind == 'V')
        return SS_OK;
    snprintf(number, sizeof number, "ch%zu", ++a->n_fields);
    return a->named ? ss_header_add_column(a->base.head, *name != '\0' ? name : number, "", NULL) : SS_OK;
}

/* Read a type, or a list of (name, type). */
static ss_status
read_descr(struct npy *a, const char **p)
{
    char name[64];
    ss_status st = SS_OK;
    a->named = skip(p, "[");
    if (!a->named)
        return add_field(a, "", p);
    for (; st == SS_OK && !skip(p, "]"); skip(p, ",")) {
        int begun = skip(p, "(" QUOTE);
        size_t n = strcspn(*p, QUOTE "\\");
        snprintf(name, sizeof name, "%.*s", (int)n, *p);
        *p += n;
        st = begun && n < sizeof name && skip(p, QUOTE ",") ? add_field(a, name, p) : SS_EDATA;
        if (st == SS_OK && !skip(p, ")"))
            st = SS_EDATA;
    }
    return st;
}

/* Read the dictionary.  SS_EDATA: it is none, or its array is no signal; SS_ENOMEM. */
static ss_status
read_dictionary(struct npy *a, const char *p)
{
    uint64_t rows = 0, columns = 1;
    ss_status st = skip(&p, "{") ? SS_OK : SS_EDATA;
    for (int n = 0; st == SS_OK && !skip(&p, "}"); skip(&p, ","))
        if (a->record == 0 && skip(&p, QUOTE "descr" QUOTE ":"))
            st = read_descr(a, &p);
        else if (skip(&p, QUOTE "fortran_order" QUOTE ":"))
            st = (a->fortran = skip(&p, "True")) || skip(&p, "False") ? SS_OK : SS_EDATA;
        else if (rows == 0 && skip(&p, QUOTE "shape" QUOTE ":")) {
            sscanf(p, "(%" SCNu64 "%n,%" SCNu64 "%n", &rows, &n, &columns, &n);
            p += n;
            skip(&p, ",");
            st = skip(&p, ")") ? SS_OK : SS_EDATA;
        } else
            st = SS_EDATA;
    if (st != SS_OK || *p != '\0' || a->n_fields == 0 || (a->named && columns > 1) || rows == 0 || columns == 0)
        return st != SS_OK ? st : SS_EDATA;
    int wide = rows < columns;                  /* it is read as the transposed array in the other order */
    a->rows = (size_t)(wide ? columns : rows);
    a->columns = a->named ? a->n_fields : (size_t)(wide ? rows : columns);
    a->fortran = a->columns > 1 && !a->named && a->fortran != wide;
    return a->columns <= MAX_COLUMNS && a->rows <= SIZE_MAX / sizeof(double) / 4 / a->columns ? SS_OK : SS_EDATA;
}

static ss_status
read_header(struct npy *a, ss_error *err)
{
    struct input *in = a->in;
    ss_status st = ss_input_whole(in, MAGIC_BYTES + 4, ".npy header", err);
    if (st != SS_OK)
        return st;
    const char *p = in->buffer + in->lo;
    unsigned version = (unsigned char)p[6], bytes = version == 2 || version == 3 ? 4 : 2;
    size_t length = (size_t)ss_bytes_get(p + MAGIC_BYTES, bytes, 1), before = MAGIC_BYTES + bytes;
    if (version < 1 || version > 3 || length > HEADER_MOST)
        return ss_fail(err, SS_EDATA, "%s: .npy of version %u with a header of %zu bytes is not read; "
                       "versions 1 to 3 are", in->name, version, length);
    st = ss_input_whole(in, before + length, ".npy header", err);
    if (st != SS_OK)
        return st;
    char *text = strndup(in->buffer + in->lo + before, length), *tidied = NULL;
    in->lo += before + length;
    if (text != NULL) {
        text[strcspn(text, "\n")] = '\0';
        tidied = tidy(text);
    }
    st = tidied != NULL ? read_dictionary(a, tidied) : SS_ENOMEM;
    if (st == SS_EDATA)
        ss_fail(err, st, "%s: this array is not read: %.200s; numpy.save('FILE', array.astype('f8')) writes one "
                "of one or two dimensions that is", in->name, ss_cell_trim(text));
    free(tidied);
    free(text);
    return st;
}

/* Read the next n values, whole records; `at` values precede them. */
static ss_status
read_values(struct npy *a, uint64_t at, double *value, size_t n, ss_error *err)
{
    struct input *in = a->in;
    size_t bytes = n / a->n_fields * a->record;
    ss_status st = ss_input_need(in, bytes, err);
    if (st == SS_OK && in->hi - in->lo < bytes)
        st = ss_fail(err, SS_EDATA, "%s: truncated: %llu of %zu values", in->name,
                     (unsigned long long)at + (in->hi - in->lo) / a->record * a->n_fields, a->rows * a->columns);
    for (size_t i = 0; st == SS_OK && i < n; in->lo += a->record)
        for (size_t f = 0; f < a->n_fields; f++)
            value[i++] = ss_sample_raw(in->buffer + in->lo + a->field[f].at, a->field[f].type);
    return st;
}

/* Give all columns of the next rows. */
static ss_status
give_npy(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct npy *a = (struct npy *)s;
    size_t row = (size_t)s->row, left = a->rows - row, rows = left < max ? left : max;
    ss_status st = SS_OK;
    for (size_t c = 0; st == SS_OK && a->fortran && rows > 0 && c < a->columns; c++)
        st = ss_kept_copy(&a->all, c * a->rows + row, rows, column[c], err);
    for (size_t i = 0; st == SS_OK && !a->fortran && i < rows; i++) {
        st = read_values(a, (row + i) * a->columns, a->value, a->columns, err);
        for (size_t c = 0; c < a->columns; c++)
            column[c][i] = a->value[c];
    }
    s->row += rows;
    *n = rows;
    if (st == SS_OK && rows == 0 && (st = ss_input_need(a->in, 1, err)) == SS_OK && a->in->hi > a->in->lo)
        st = ss_fail(err, SS_EDATA, "%s: goes on after the %zu values of its array", s->name,
                     a->rows * a->columns);
    return st;
}

static void
free_npy(ss_source *s)
{
    struct npy *a = (struct npy *)s;
    ss_kept_free(&a->all);
    free(a->field);
    free(a->value);
}

static ss_status
open_npy(ss_source **out, const struct opening *o, ss_error *err)
{
    static const struct source_calls calls = { .next = give_npy, .free = free_npy };
    struct npy *a = ss_source_new(sizeof *a, &calls, o->in->name, err);
    if (a == NULL)
        return SS_ENOMEM;
    *out = &a->base;
    a->in = o->in;
    a->in->share = 0.5;                         /* of the work; the other half is to give the rows */
    ss_status st = ss_refuse_table(a->in->name, o->opts, err);
    if (st == SS_OK)
        st = read_header(a, err);
    if (st == SS_OK && !a->named)
        st = ss_frames_columns(a->base.head, a->columns);
    if (st == SS_OK && (a->value = calloc(a->columns, sizeof *a->value)) == NULL)
        st = SS_ENOMEM;
    ss_kept_begin(&a->all, a->in->name, o->opts->folder, 1);
    for (uint64_t i = 0; st == SS_OK && a->fortran && i < a->rows * a->columns; i++)
        if ((st = read_values(a, i, a->value, 1, err)) == SS_OK)
            st = ss_kept_add(&a->all, a->value, err);
    if (st == SS_OK)
        st = ss_kept_end(&a->all, err);
    if (st == SS_ENOMEM)
        ss_fail_memory(err, o->in->name);
    return st != SS_OK ? st : ss_sheet_of_source(out, o->opts, a->named, o->in->size > 0 ? o->in->progress
                                                 : (ss_progress){ NULL, NULL }, err);
}

FORMAT(npy) = { .name = "npy", .magic = "\223NUMPY", .open = open_npy };
