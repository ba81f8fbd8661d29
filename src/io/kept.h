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
    double *block;              /* the rows from this one on, one after the other; all of few rows */
    uint64_t first;
    size_t held, room;          /* rows and numbers in it */
    FILE *file;                 /* of the rows that are not in the block, or NULL */
    int is_away, error;         /* are there such rows?  errno of the first that could not be read */
};

/* Begin with no rows.  name must live as long as *kept, folder up to ss_kept_end. */
void ss_kept_begin(struct kept *kept, const char *name, const char *folder, size_t width);
ss_status ss_kept_add(struct kept *kept, const double row[], ss_error *err);
/* There are no more rows. */
ss_status ss_kept_end(struct kept *kept, ss_error *err);

/* Row i, valid until the next call; NULL: there is none, or it cannot be read, which ss_kept_check reports. */
const double *ss_kept_fetch(struct kept *kept, uint64_t i);
static inline const double *
ss_kept_row(struct kept *kept, uint64_t i)
{
    return i - kept->first < kept->held ? kept->block + (i - kept->first) * kept->width : ss_kept_fetch(kept, i);
}
ss_status ss_kept_check(const struct kept *kept, ss_error *err);
/* Copy n rows that are there, from this one on. */
ss_status ss_kept_copy(struct kept *kept, uint64_t first, size_t n, double *to, ss_error *err);
void ss_kept_free(struct kept *kept);

#endif
