/* npy.c -- NumPy's .npy: a header and the numbers of one array, of one type or of named fields.
 *
 * The header is a Python dictionary of three keys: descr, fortran_order and shape.  (NumPy Enhancement
 * Proposal 1.)  The columns of a 2-D array are its shorter dimension, as in HDF5. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/columns.h"
#include "base/error.h"
#include "base/list.h"
#include "signal/header.h"
#include "io/frames.h"
#include "io/table/sheet.h"
#include "io/table/text.h"

enum {
    MAGIC_BYTES = 8, HEADER_MOST = 1 << 20, RECORD_MOST = 1 << 20 };

struct field {
    char name[64];
    sample_type type;
    size_t at;                  /* its first byte in a record */
};

struct npy {
    ss_source base;
    struct input *in;
    struct field *field;
    size_t n_fields, room, record;      /* record: bytes of all fields */
    int named, fortran;
    uint64_t shape[2];
    int dimensions;
    size_t rows, columns, row;          /* row: the next to be given */
    int no_memory;
    double *value;                      /* of a record */
    struct kept all;                    /* values of an array whose columns follow each other in the file */
};

/* --- the header ---------------------------------------------------------------------------- */

/* Skip blanks and this character.  Returns the text behind it; NULL if another follows, or p is NULL. */
static const char *
expect(const char *p, char c)
{
    if (p == NULL)
        return NULL;
    p += strspn(p, " \n");
    return *p == c ? p + 1 : NULL;
}

static int
is_next(const char *p, char c)
{
    return expect(p, c) != NULL;
}

/* Read a string in single or double quotes, without escapes.  Returns its end, or NULL. */
static const char *
read_string(const char *p, char *text, size_t size)
{
    char quote = is_next(p, '"') ? '"' : '\'';
    p = expect(p, quote);
    const char *end = p != NULL ? strchr(p, quote) : NULL;
    if (end == NULL || (size_t)(end - p) >= size || memchr(p, '\\', (size_t)(end - p)) != NULL)
        return NULL;
    memcpy(text, p, (size_t)(end - p));
    text[end - p] = '\0';
    return end + 1;
}

/* The type of "<f8", ">i2" or "|u1", or of bytes that are left out, "|V4"; bytes is 0 if it cannot be read. */
static sample_type
type_of(const char *text)
{
    static const char kinds[] = "fiubV";
    sample_type type = { .little_endian = text[0] != '>', .is_float = text[1] == 'f',
                         .is_unsigned = text[1] == 'u' || text[1] == 'b' };
    char *end;
    if (text[0] == '\0' || strchr("<>|=", text[0]) == NULL || text[1] == '\0'
        || strchr(kinds, text[1]) == NULL)
        return type;
    unsigned long bytes = strtoul(text + 2, &end, 10);
    int known = type.is_float ? bytes == 4 || bytes == 8
        : text[1] == 'V' ? bytes > 0 && bytes <= RECORD_MOST
        : bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8;
    if (text[2] >= '0' && text[2] <= '9' && *end == '\0' && known)
        type.bytes = (unsigned)bytes;
    return type;
}

/* Add a field.  Returns 0 if its type cannot be read, or there is no memory. */
static int
add_field(struct npy *a, const char *name, const char *type)
{
    struct field *more = ss_list_room(a->field, &a->room, a->n_fields, sizeof *more);
    struct field f = { .type = type_of(type), .at = a->record };
    if (more != NULL)
        a->field = more;
    a->no_memory = more == NULL;
    if (more == NULL || f.type.bytes == 0 || a->record > RECORD_MOST || a->n_fields == MAX_COLUMNS)
        return 0;
    a->record += f.type.bytes;
    if (type[1] == 'V')
        return 1;
    snprintf(f.name, sizeof f.name, "%s", name);
    more[a->n_fields++] = f;
    return 1;
}

/* Read a type, or a list of (name, type).  Returns its end, or NULL. */
static const char *
read_descr(struct npy *a, const char *p)
{
    char type[32] = "", name[sizeof a->field->name];
    if (a->n_fields > 0)                        /* the header has the key twice */
        return NULL;
    if (!is_next(p, '[')) {
        p = read_string(p, type, sizeof type);
        return p != NULL && type[1] != 'V' && add_field(a, "", type) ? p : NULL;
    }
    a->named = 1;
    for (p = expect(p, '['); p != NULL && !is_next(p, ']');) {
        p = expect(p, '(');
        p = p != NULL ? expect(read_string(p, name, sizeof name), ',') : NULL;
        p = p != NULL ? expect(read_string(p, type, sizeof type), ')') : NULL;
        if (p == NULL || !add_field(a, name, type))
            return NULL;
        p = is_next(p, ',') ? expect(p, ',') : p;
    }
    return expect(p, ']');
}

static const char *
read_shape(struct npy *a, const char *p)
{
    if (a->dimensions > 0)                      /* the header has the key twice */
        return NULL;
    for (p = expect(p, '('); p != NULL && !is_next(p, ')');) {
        char *end;
        p += strspn(p, " ");
        if (*p < '0' || *p > '9' || a->dimensions == 2)
            return NULL;
        a->shape[a->dimensions++] = strtoull(p, &end, 10);
        p = is_next(end, ',') ? expect(end, ',') : end;
    }
    return expect(p, ')');
}

static const char *
read_flag(struct npy *a, const char *p)
{
    p += strspn(p, " ");
    a->fortran = strncmp(p, "True", 4) == 0;
    return a->fortran ? p + 4 : strncmp(p, "False", 5) == 0 ? p + 5 : NULL;
}

static int
read_dictionary(struct npy *a, const char *p)
{
    char key[32];
    for (p = expect(p, '{'); p != NULL && !is_next(p, '}');) {
        p = expect(read_string(p, key, sizeof key), ':');
        if (p == NULL)
            return 0;
        p = strcmp(key, "descr") == 0 ? read_descr(a, p) : strcmp(key, "shape") == 0 ? read_shape(a, p)
            : strcmp(key, "fortran_order") == 0 ? read_flag(a, p) : NULL;
        p = is_next(p, ',') ? expect(p, ',') : p;
    }
    p = expect(p, '}');
    return p != NULL && p[strspn(p, " ")] == '\0' && a->n_fields > 0;
}

/* Find rows and columns of the array that the header describes.  Returns 0 if it is no signal. */
static int
arrange(struct npy *a)
{
    uint64_t rows = a->shape[0], columns = a->dimensions == 2 ? a->shape[1] : 1;
    if (a->dimensions < 1 || (a->named && a->dimensions == 2) || rows == 0 || columns == 0)
        return 0;
    if (rows < columns) {                       /* read it as the transposed array in the other order */
        uint64_t swap = rows;
        rows = columns;
        columns = swap;
        a->fortran = !a->fortran;
    }
    a->fortran = a->fortran && columns > 1;     /* records of fields have no other order */
    a->columns = a->named ? a->n_fields : (size_t)columns;
    a->rows = (size_t)rows;
    return columns <= MAX_COLUMNS && rows <= SIZE_MAX / sizeof(double) / 4 / a->columns;
}

/* Read the header as text, to be freed. */
static ss_status
read_header(struct input *in, char **text, ss_error *err)
{
    *text = NULL;
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
    *text = strndup(in->buffer + in->lo + before, length);
    in->lo += before + length;
    if (*text == NULL)
        return ss_fail_memory(err, in->name);
    (*text)[strcspn(*text, "\n")] = '\0';
    return SS_OK;
}

/* --- the numbers --------------------------------------------------------------------------- */

/* Read the next value or, if there are named fields, the next record; `at` values precede it. */
static ss_status
read_record(struct npy *a, uint64_t at, ss_error *err)
{
    struct input *in = a->in;
    ss_status st = ss_input_need(in, a->record, err);
    if (st != SS_OK)
        return st;
    if (in->hi - in->lo < a->record)
        return ss_fail(err, SS_EDATA, "%s: truncated: %llu of %zu values", in->name, (unsigned long long)at,
                       a->rows * a->columns);
    for (size_t f = 0; f < a->n_fields; f++)
        a->value[f] = ss_sample_raw(in->buffer + in->lo + a->field[f].at, a->field[f].type);
    in->lo += a->record;
    return SS_OK;
}

/* Give all columns of the next rows. */
static ss_status
give_npy(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct npy *a = (struct npy *)s;
    size_t left = a->rows - a->row, rows = left < max ? left : max;
    ss_status st = SS_OK;
    for (size_t c = 0; st == SS_OK && a->fortran && rows > 0 && c < a->columns; c++)
        st = ss_kept_copy(&a->all, c * a->rows + a->row, rows, column[c], err);
    for (size_t i = 0; !a->fortran && i < rows; i++)
        for (size_t c = 0; st == SS_OK && c < a->columns; c += a->n_fields) {
            st = read_record(a, (a->row + i) * a->columns + c, err);
            for (size_t f = 0; f < a->n_fields; f++)
                column[c + f][i] = a->value[f];
        }
    a->row += rows;
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

/* Read the header, and all values if they do not come row by row. */
static ss_status
begin_npy(struct npy *a, const ss_read_opts *opts, ss_error *err)
{
    char *text = NULL, number[32];
    ss_status st = ss_refuse_table(a->in->name, opts, err);
    if (st == SS_OK)
        st = read_header(a->in, &text, err);
    if (st == SS_OK && (!read_dictionary(a, text) || !arrange(a)))
        st = a->no_memory ? SS_ENOMEM
            : ss_fail(err, SS_EDATA, "%s: this array is not read: %.200s; numpy.save('FILE', "
                      "array.astype('f8')) writes one of one or two dimensions that is", a->in->name,
                      ss_cell_trim(text));
    free(text);
    for (size_t c = 0; st == SS_OK && c < a->columns; c++) {
        snprintf(number, sizeof number, "ch%zu", c + 1);
        const char *name = a->named ? a->field[c].name : "";
        st = ss_header_add_column(a->base.head, *name != '\0' ? name : number, "", NULL);
    }
    if (st == SS_OK && (a->value = malloc(a->n_fields * sizeof *a->value)) == NULL)
        st = SS_ENOMEM;
    ss_kept_begin(&a->all, a->in->name, opts->folder, 1);
    for (uint64_t i = 0; st == SS_OK && a->fortran && i < a->rows * a->columns; i++)
        if ((st = read_record(a, i, err)) == SS_OK)
            st = ss_kept_add(&a->all, a->value, err);
    return st == SS_OK ? ss_kept_end(&a->all, err) : st;
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
    ss_status st = begin_npy(a, o->opts, err);
    if (st == SS_ENOMEM)
        ss_fail_memory(err, o->in->name);
    return st != SS_OK ? st : ss_sheet_of_source(out, o->opts, a->named, o->in->size > 0 ? o->in->progress
                                                 : (ss_progress){ NULL, NULL }, err);
}

FORMAT(npy) = { .name = "npy", .magic = "\223NUMPY", .open = open_npy };
