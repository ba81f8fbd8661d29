/* delimited_start.c -- where the data of a text table begin.
 *
 * A line with nothing but numbers, dates and times begins them.  A table with a column of words has
 * none: there it is the first line, below one without numbers, that the next two lines are like,
 * cell by cell. */
#include <stdlib.h>
#include <string.h>
#include "io/table/delimited.h"

static const char candidate[] = { '\t', ';', ',', ' ' };
enum { CANDIDATES = sizeof candidate / sizeof *candidate };

/* 1 if the cells of this line may lie between such separators. */
static int
may_separate(const struct table *t, const char *line, char separator)
{
    return separator == ' ' ? !t->labview : strchr(line, separator) != NULL;
}

/* The number of cells that belong to columns, if all of these but the last hold numbers; else 0.  LabVIEW leaves the
 * cell of x empty, and writes comments behind some rows. */
static size_t
count_cells(const struct table *t, const char *line, const char *shape, size_t numbers)
{
    size_t n = strlen(shape), first = t->labview && line[0] == '\t';
    const char *wrong = ss_delimited_may_lack(t) ? "t" : "te";
    if (t->labview && n > 1 && shape[n - 1] == 't')
        n--;
    size_t full = n;
    while (full > 1 && shape[full - 1] == 'e')
        full--;
    return numbers > 0 && n > first && strcspn(shape + first, wrong) >= full - first ? n : 0;
}

/* The number of cells of the line above, which may name the columns; 0 if there is none. */
static ss_status
count_names(struct table *t, char separator, size_t *n)
{
    size_t last = t->n_head;
    while (last > 0 && t->head[last - 1].comment)
        last--;
    *n = 0;
    char *copy = last > 0 ? strdup(t->head[last - 1].text) : NULL;
    if (copy != NULL)
        *n = ss_delimited_split(t, copy, separator);
    free(copy);
    return (last > 0 && copy == NULL) || *n == NONE ? SS_ENOMEM : SS_OK;
}

/* Empty cells at the end of the row count if each has a name above. */
ss_status
ss_delimited_is_data(struct table *t, const char *line, int *yes)
{
    size_t columns = t->n_columns;
    *yes = 0;
    for (size_t i = 0; !*yes && i < CANDIDATES; i++) {
        char separator = candidate[i];
        size_t numbers;
        if (!may_separate(t, line, separator))
            continue;
        if ((ss_delimited_may_lack(t) || !t->labview) && count_names(t, separator, &t->n_columns) != SS_OK)
            return SS_ENOMEM;
        char *shape = ss_delimited_shape(t, line, separator, &numbers);
        t->n_columns = columns;
        if (shape == NULL)
            return SS_ENOMEM;
        size_t n = count_cells(t, line, shape, numbers);
        free(shape);
        if (n == 0 || (n == 1 && separator != ';' && separator != ' '))
            continue;
        t->separator = n > 1 || separator == ';' ? separator : '\0';
        t->n_columns = n;
        *yes = 1;
    }
    return SS_OK;
}

/* --- words among the numbers --------------------------------------------------------------- */

/* The shapes of the kept lines if they have this separator, NULL for a comment.  NULL: no memory. */
static char **
shapes_of(struct table *t, char separator)
{
    size_t numbers;
    char **shape = calloc(t->n_head + 1, sizeof *shape);
    for (size_t i = 0; shape != NULL && i < t->n_head; i++)
        if (!t->head[i].comment
            && (shape[i] = ss_delimited_shape(t, t->head[i].text, separator, &numbers)) == NULL) {
            while (i-- > 0)
                free(shape[i]);
            free(shape);
            return NULL;
        }
    return shape;
}

/* 1 if two rows have cells of the same kinds.  The second may lack its empty cells at the end. */
static int
is_like(const char *shape, const char *row)
{
    for (; *shape != '\0' && *row != '\0'; shape++, row++)
        if (*shape != *row && *row != 'e')
            return 0;
    return *row == '\0' && strchr(shape, 'n') == NULL;
}

/* The first line with numbers and words that has two lines like it below, or one if there are no more. */
static size_t
find_like(const struct table *t, char *const *shape)
{
    for (size_t i = 0; i < t->n_head; i++) {
        if (shape[i] == NULL || strchr(shape[i], 'n') == NULL || strpbrk(shape[i], "te") == NULL)
            continue;
        if (i > 0 && shape[i - 1] != NULL && strchr(shape[i - 1], 'n') != NULL)
            continue;
        size_t alike = 0, below = i + 1;
        for (; below < t->n_head && alike < 2; below++)
            if (shape[below] != NULL && !is_like(shape[i], shape[below]))
                break;
            else
                alike += shape[below] != NULL;
        if (alike == 2 || (below == t->n_head && i > 0))
            return i;
    }
    return t->n_head;
}

ss_status
ss_delimited_ends_mixed(struct table *t, int *yes)
{
    size_t numbers;
    *yes = 0;
    if (t->n_head == 0 || t->head[t->n_head - 1].comment)
        return SS_OK;
    char *shape = ss_delimited_shape(t, t->head[t->n_head - 1].text, t->separator, &numbers);
    if (shape == NULL)
        return SS_ENOMEM;
    *yes = shape[0] == 'n' && strpbrk(shape, "te") != NULL;
    free(shape);
    return SS_OK;
}

size_t
ss_delimited_find_mixed(struct table *t)
{
    size_t found = t->n_head;
    for (size_t i = 0; found == t->n_head && i < CANDIDATES; i++) {
        char **shape = shapes_of(t, candidate[i]);
        if (shape == NULL)
            return NONE;
        found = find_like(t, shape);
        if (found < t->n_head) {
            t->separator = candidate[i];
            t->n_columns = strlen(shape[found]);
        }
        for (size_t k = 0; k < t->n_head; k++)
            free(shape[k]);
        free(shape);
    }
    return found;
}
