/* path.c -- reduce one column over another, of any length, to what a picture shows: of a long line, the parts
 * that cross a cell of half a pixel which the line has not crossed before.
 *
 * The line goes from point to point, each farther than a cell from the one before, so that a line through new
 * cells is not broken.  Lines are four cells wide: a part through cells that were crossed shows nothing new. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "plot/script.h"

enum {
    KEPT = 1 << 19,             /* rows of a signal that is drawn as it is */
    CELLS = 2 * SCRIPT_COLUMNS, /* along each axis */
    BLOCK = 8                   /* along each axis of a block */
};

typedef struct reduction reduction;
typedef ss_status use_row(reduction *r, size_t row, const double at[2], ss_error *err);

struct reduction {
    ss_reader *reader;
    ss_header head;             /* of the source, from its start in the picture on */
    size_t column[2], first, end;       /* rows that are drawn: those before end */
    size_t rows;                /* that were read */
    script_clock clock;
    script_extent extent[2];
    unsigned char *crossed;     /* 1 for each cell that was */
    unsigned char *in_block;    /* the number of these in each block */
    int begins;                 /* does a line begin? */
    double last[2], before[2];  /* else, its last two points, in cells */
    int was_new;                /* did the part between them cross new ones? */
    int is_kept;                /* is that part kept? */
    double *point;              /* those that are kept: x, y, x, y, ... */
    size_t n, room;
    FILE *gaps;                 /* the text of a note */
};

/* Use each row that is drawn. */
static ss_status
read_rows_of(reduction *r, use_row *use, ss_error *err)
{
    size_t piece = ss_reader_piece(r->reader), n = 1;
    double **wanted = calloc(r->head.n_columns, sizeof *wanted), *value = malloc(2 * piece * sizeof *value);
    ss_status st = wanted != NULL && value != NULL ? ss_reader_rewind(r->reader, err) : ss_fail_memory(err, NULL);
    for (int k = 0; st == SS_OK && k < 2; k++)
        wanted[r->column[k]] = value + (size_t)k * piece;
    for (r->rows = 0; st == SS_OK && n > 0; r->rows += n) {
        st = ss_reader_rows(r->reader, wanted, piece, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++) {
            const double at[2] = { wanted[r->column[0]][i], wanted[r->column[1]][i] };
            if (r->rows + i >= r->first && r->rows + i < r->end)
                st = use(r, r->rows + i, at, err);
        }
    }
    free(wanted);
    free(value);
    return st;
}

static ss_status
measure(reduction *r, size_t row, const double at[2], ss_error *err)
{
    (void)err;
    for (int i = 0; i < 2 && !ss_script_is_missing(&r->clock, row); i++)
        r->extent[i] = (script_extent){ fmin(r->extent[i].lo, at[i]), fmax(r->extent[i].hi, at[i]) };
    return SS_OK;
}

static ss_status
keep_point(reduction *r, size_t row, const double at[2], ss_error *err)
{
    double *more = ss_list_grow(r->point, &r->room, 2 * r->n + 2, sizeof *more);
    (void)row;
    if (more == NULL)
        return ss_fail_memory(err, NULL);
    r->point = more;
    memcpy(more + 2 * r->n++, at, 2 * sizeof *at);
    return SS_OK;
}

/* --- a long line ---------------------------------------------------------------------------- */

/* Cross all cells from one to another; 1: one of them is new.  In a full block three of four are passed over:
 * what is then not seen of another block is shorter than lines are wide. */
static int
cross(reduction *r, const double from[2], const double to[2])
{
    const double unit = 65536;          /* of a cell */
    int steps = (int)ceil(fmax(fabs(to[0] - from[0]), fabs(to[1] - from[1]))), new = 0;
    long x = (long)(from[0] * unit), dx = steps > 0 ? (long)((to[0] - from[0]) * unit / steps) : 0;
    long y = (long)(from[1] * unit), dy = steps > 0 ? (long)((to[1] - from[1]) * unit / steps) : 0;
    for (int i = 0, step; i <= steps; i += step, x += step * dx, y += step * dy) {
        long column = x >> 16, row = y >> 16;
        unsigned char *in_block = &r->in_block[row / BLOCK * (CELLS / BLOCK) + column / BLOCK];
        unsigned char *cell = &r->crossed[row * CELLS + column];
        step = *in_block == BLOCK * BLOCK ? 4 : 1;
        if (step > 1 || *cell)
            continue;
        *cell = 1;
        ++*in_block;
        new = 1;
    }
    return new;
}

/* Keep the point at a cell. */
static ss_status
keep_cell(reduction *r, const double cell[2], ss_error *err)
{
    double at[2];
    for (int i = 0; i < 2; i++)
        at[i] = r->extent[i].lo + cell[i] * ((r->extent[i].hi - r->extent[i].lo) / (CELLS - 1));
    return keep_point(r, 0, at, err);
}

/* Let the points that follow begin another line. */
static ss_status
add_gap(reduction *r, ss_error *err)
{
    if (r->n == 0)
        return SS_OK;
    ss_print(r->gaps, "%s%zu:%zu", ftell(r->gaps) > 0 ? " " : "", r->n, r->n + 1);
    return keep_cell(r, r->last, err);
}

/* Keep the part from the last point of the line to this one, if it crosses new cells or is next to one that
 * does, so that the ends of parts are not seen. */
static ss_status
add_part(reduction *r, const double cell[2], ss_error *err)
{
    int is_new = cross(r, r->last, cell);
    ss_status st = SS_OK;
    if ((is_new || r->was_new) && !r->is_kept) {
        st = add_gap(r, err);
        if (st == SS_OK)
            st = keep_cell(r, r->before, err);
        if (st == SS_OK)
            st = keep_cell(r, r->last, err);
    }
    r->is_kept = is_new || r->was_new;
    r->was_new = is_new;
    return st == SS_OK && r->is_kept ? keep_cell(r, cell, err) : st;
}

static ss_status
add_point(reduction *r, size_t row, const double at[2], ss_error *err)
{
    double cell[2];
    if (ss_script_is_missing(&r->clock, row)) {
        r->begins = 1;
        return SS_OK;
    }
    for (int i = 0; i < 2; i++) {
        double range = r->extent[i].hi - r->extent[i].lo;
        cell[i] = range > 0 ? (at[i] - r->extent[i].lo) / range * (CELLS - 1) : 0;
    }
    if (r->begins) {
        memcpy(r->before, cell, sizeof cell);
        memcpy(r->last, cell, sizeof cell);
        r->is_kept = r->was_new = 0;
    } else if (fabs(cell[0] - r->last[0]) <= 1 && fabs(cell[1] - r->last[1]) <= 1) {
        return SS_OK;
    }
    ss_status st = add_part(r, cell, err);
    memcpy(r->before, r->last, sizeof cell);
    memcpy(r->last, cell, sizeof cell);
    r->begins = 0;
    return st;
}

/* --- the whole ------------------------------------------------------------------------------ */

/* Make a signal of the points.  Those of a long line are on a clock of their own. */
static ss_status
give_points(reduction *r, ss_signal **out, int is_long, const char *gaps)
{
    ss_header *head = NULL;
    size_t columns = r->column[0] == r->column[1] ? 1 : 2;
    ss_status st = ss_header_select(&head, ss_reader_header(r->reader), r->column, columns, r->first);
    if (st == SS_OK && is_long) {
        head->start = 0;
        head->rate = 1;
        st = ss_header_note(head, "gaps", gaps);
    }
    if (st == SS_OK)
        st = ss_signal_new(out, head, r->n);
    for (size_t c = 0; st == SS_OK && c < columns; c++)
        for (size_t i = 0; i < r->n; i++)
            (*out)->values[c * r->n + i] = r->point[2 * i + c];
    ss_header_free(head);
    return st;
}

static ss_status
thin(reduction *r, ss_signal **out, ss_error *err)
{
    char *text = NULL;
    size_t length;
    r->crossed = calloc((size_t)CELLS * CELLS, 1);
    r->in_block = calloc((size_t)CELLS / BLOCK * CELLS / BLOCK, 1);
    r->gaps = open_memstream(&text, &length);
    r->begins = 1;
    int has_room = r->crossed != NULL && r->in_block != NULL && r->gaps != NULL;
    ss_status st = has_room ? read_rows_of(r, add_point, err) : SS_ENOMEM;
    if (r->gaps != NULL && fclose(r->gaps) != 0)
        st = SS_ENOMEM;
    if (st == SS_OK)
        st = give_points(r, out, 1, text);
    free(text);
    free(r->crossed);
    free(r->in_block);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

ss_status
ss_plot_path(ss_signal **out, size_t *rows, ss_reader *reader, size_t x, size_t y, double start,
             const ss_plot_opts *opts, ss_error *err)
{
    if (out == NULL || rows == NULL || reader == NULL || opts == NULL)
        return SS_FAIL_NULL(err);
    const ss_header *head = ss_reader_header(reader);
    reduction r = { .reader = reader, .head = *head, .column = { x, y },
                    .extent = { SCRIPT_NO_EXTENT, SCRIPT_NO_EXTENT } };
    script_span span;
    *out = NULL;
    if (x >= head->n_columns || y >= head->n_columns)
        return ss_fail_column(err, x > y ? x : y, head->n_columns);
    r.head.start = start;
    ss_script_find_rows(&r.first, &r.end, &r.head, opts);
    r.clock = (script_clock){ .start = head->start, .rate = head->rate };
    ss_status st = ss_header_gaps(&r.clock.gap, &r.clock.n_gaps, head);
    if (st == SS_OK)
        st = read_rows_of(&r, measure, err);
    if (st == SS_OK)
        st = ss_script_find_span(&span, &r.head, r.rows, opts, err);
    for (int i = 0; i < 2 && st == SS_OK && r.extent[i].lo <= r.extent[i].hi; i++)
        st = ss_script_check(head->column[r.column[i]].name, (double[]){ r.extent[i].lo, r.extent[i].hi }, 2, err);
    int is_long = st == SS_OK && span.n > KEPT && r.extent[0].lo <= r.extent[0].hi;
    if (is_long)
        st = thin(&r, out, err);
    else if (st == SS_OK && (st = read_rows_of(&r, keep_point, err)) == SS_OK)
        st = give_points(&r, out, 0, NULL);
    *rows = r.rows;
    free(r.point);
    free(r.clock.gap);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}
