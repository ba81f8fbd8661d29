/* kept.c -- rows that are put away in a file without a name, if they are more than a piece, and are read
 * again from there. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>
#include "base/error.h"
#include "base/list.h"
#include "io/kept.h"

enum { PIECE = 1 << 18 };               /* so many numbers are in memory, or one row */

/* Open a file without a name, which nobody else sees and which ends with the process. */
static FILE *
open_nameless(const char *first)
{
    const char *folder[] = { first, "/var/tmp", "/tmp" };
    char name[512];
    for (size_t i = 0; i < sizeof folder / sizeof *folder; i++) {
        int fits = folder[i] != NULL && folder[i][0] != '\0'
            && snprintf(name, sizeof name, "%s/stickslip.XXXXXX", folder[i]) < (int)sizeof name;
        int fd = fits ? mkstemp(name) : -1;
        if (fd < 0)
            continue;
        unlink(name);
        FILE *file = fdopen(fd, "w+");
        if (file == NULL)
            close(fd);
        return file;
    }
    return NULL;
}

static size_t
rows_in_piece(const struct kept *k)
{
    return k->width < PIECE ? PIECE / k->width : 1;
}

void
ss_kept_begin(struct kept *k, const char *name, const char *folder, size_t width)
{
    *k = (struct kept){ .name = name, .folder = folder, .width = width, .block = k->block, .room = k->room,
                        .file = k->file };
    if (k->file != NULL)
        rewind(k->file);
}

ss_status
ss_kept_check(const struct kept *k, ss_error *err)
{
    char name[300];
    if (k->error == 0)
        return SS_OK;
    snprintf(name, sizeof name, "%.200s: a temporary file for its rows", k->name);
    return ss_fail_errno(err, name, k->error);
}

/* Write the block to the file, and empty it. */
static ss_status
write_block(struct kept *k, ss_error *err)
{
    if ((k->file == NULL && (k->file = open_nameless(k->folder)) == NULL)
        || fwrite(k->block, k->width * sizeof *k->block, k->held, k->file) != k->held || fflush(k->file) != 0)
        k->error = errno;
    k->is_away = 1;
    k->first = k->n;
    k->held = 0;
    return ss_kept_check(k, err);
}

ss_status
ss_kept_add(struct kept *k, const double row[], ss_error *err)
{
    ss_status st = k->held == rows_in_piece(k) ? write_block(k, err) : SS_OK;
    if (st != SS_OK)
        return st;
    double *more = ss_list_grow(k->block, &k->room, (k->held + 1) * k->width, sizeof *more);
    if (more == NULL)
        return ss_fail_memory(err, k->name);
    k->block = more;
    memcpy(more + k->held++ * k->width, row, k->width * sizeof *more);
    k->n++;
    return SS_OK;
}

ss_status
ss_kept_end(struct kept *k, ss_error *err)
{
    return k->is_away ? write_block(k, err) : SS_OK;
}

const double *
ss_kept_fetch(struct kept *k, uint64_t i)
{
    size_t piece = rows_in_piece(k);
    if (i >= k->n || k->error != 0)
        return NULL;
    k->first = i / piece * piece;
    k->held = k->n - k->first < piece ? (size_t)(k->n - k->first) : piece;
    return ss_kept_copy(k, k->first, k->held, k->block, NULL) == SS_OK ? ss_kept_row(k, i) : NULL;
}

ss_status
ss_kept_copy(struct kept *k, uint64_t first, size_t n, double *to, ss_error *err)
{
    size_t bytes = k->width * sizeof *to;
    if (!k->is_away)
        memcpy(to, k->block + first * k->width, n * bytes);
    else if (fseeko(k->file, (off_t)(first * bytes), SEEK_SET) != 0 || fread(to, bytes, n, k->file) != n)
        k->error = errno != 0 ? errno : EIO;
    return ss_kept_check(k, err);
}

void
ss_kept_free(struct kept *k)
{
    if (k->file != NULL)
        fclose(k->file);
    free(k->block);
}
