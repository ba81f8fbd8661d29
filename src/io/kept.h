/* kept.h -- rows of numbers that are read again: few of them in memory, many in a file without a name. */
#ifndef KEPT_H
#define KEPT_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stickslip/status.h>

/* All zeros before ss_kept_begin. */
struct kept {
    const char *name, *folder;  /* of the source, for messages; of the file, or NULL */
    size_t width;               /* numbers a row */
    uint64_t n;                 /* rows */
    double *block;              /* some of them, one after the other, or all of few */
    size_t room, held, at;      /* numbers; rows in it; of these, the one that is given next */
    uint64_t given;             /* rows */
    int is_away;                /* are rows not in the block? */
    FILE *file;                 /* of these, or NULL */
};

/* Begin with no rows.  name must live as long as *kept, folder up to ss_kept_end. */
void ss_kept_begin(struct kept *kept, const char *name, const char *folder, size_t width);
/* Room for the numbers of one more row, and, when they are there, add it. */
ss_status ss_kept_new(struct kept *kept, double **row, ss_error *err);
static inline void
ss_kept_add(struct kept *kept)
{
    kept->held++;
    kept->n++;
}
/* There are no more rows. */
ss_status ss_kept_end(struct kept *kept, ss_error *err);

/* After that: go back to the first row; and the next one, valid until the next call, or NULL. */
ss_status ss_kept_rewind(struct kept *kept, ss_error *err);
ss_status ss_kept_fetch(struct kept *kept, ss_error *err);      /* the next block, of which none may be left */
static inline ss_status
ss_kept_next(struct kept *kept, const double **row, ss_error *err)
{
    ss_status st = kept->at == kept->held && kept->given < kept->n ? ss_kept_fetch(kept, err) : SS_OK;
    int there = st == SS_OK && kept->given < kept->n;
    *row = there ? kept->block + kept->at++ * kept->width : NULL;
    kept->given += (uint64_t)there;
    return st;
}
/* Or copy n rows that are there, from this one on; a rewind must follow before the next. */
ss_status ss_kept_copy(struct kept *kept, uint64_t first, size_t n, double *to, ss_error *err);
void ss_kept_free(struct kept *kept);

#endif
