/* needs.c -- find the cheapest model whose errors are allowed, and write a sentence that says so. */
#include <stickslip/trade.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "study/trade/common.h"

#define ALIKE 1.2                   /* times within this factor differ by chance */

/* --- from text ----------------------------------------------------------------------------- */

static int
is_count(size_t what)
{
    return what == SS_COMPARED_EVENTS || what == SS_COMPARED_MICROSLIPS;
}

static ss_status
find_name(size_t *what, const char *text, size_t length, ss_error *err)
{
    char names[400] = "";
    for (size_t i = 0; ss_compared_name(i) != NULL; i++) {
        const char *name = ss_compared_name(i);
        if (strlen(name) == length && strncmp(name, text, length) == 0) {
            *what = i;
            return SS_OK;
        }
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i > 0 ? ", " : "", name);
    }
    return ss_fail(err, SS_EINVAL, "'%.*s' is none of %s", (int)length, text, names);
}

static ss_status
parse_need(ss_need *need, const char *text, size_t length, ss_error *err)
{
    const char *equals = memchr(text, '=', length);
    ss_status st = find_name(&need->what, text, equals != NULL ? (size_t)(equals - text) : length, err);
    if (st != SS_OK)
        return st;
    const char *name = ss_compared_name(need->what), *unit = ss_compared_unit(need->what);
    need->within = 0;
    if (equals == NULL)
        return is_count(need->what) ? SS_OK
            : ss_fail(err, SS_EINVAL, "%s needs an error that it may have, as in %s=0.01", name, name);
    char *end;
    need->within = ss_number_parse(equals + 1, &end);
    if (unit[0] != '\0' && strncmp(end, unit, strlen(unit)) == 0)
        end += strlen(unit);
    if (end == equals + 1 || end != text + length || !(need->within >= 0 && isfinite(need->within)))
        return ss_fail(err, SS_EINVAL, "'%.*s' is not %s=ERROR, an error of 0 or more", (int)length, text,
                       name);
    return SS_OK;
}

ss_status
ss_needs_parse(ss_need need[SS_COMPARED_MOST], size_t *n, const char *list, ss_error *err)
{
    if (need == NULL || n == NULL || list == NULL)
        return SS_FAIL_NULL(err);
    *n = 0;
    for (const char *p = list;; p++) {
        ss_need one;
        size_t length = strcspn(p, ",");
        ss_status st = parse_need(&one, p, length, err);
        for (size_t i = 0; st == SS_OK && i < *n; i++)
            if (need[i].what == one.what)
                st = ss_fail(err, SS_EINVAL, "'%s' is repeated", ss_compared_name(one.what));
        if (st != SS_OK)
            return st;
        need[(*n)++] = one;
        p += length;
        if (*p == '\0')
            return SS_OK;
    }
}

/* --- the answer ---------------------------------------------------------------------------- */

int
ss_models_keeps(const ss_models_row *row, const ss_need *need, size_t n)
{
    if (row == NULL || need == NULL || row->status != SS_OK)
        return 0;
    for (size_t i = 0; i < n; i++)
        if (!(row->error[need[i].what] <= need[i].within))
            return 0;
    return 1;
}

static int
is_answer(const ss_models *models, size_t i, const ss_need *need, size_t n)
{
    return i != SS_MODELS_SETTLED && ss_models_keeps(&models->row[i], need, n);
}

const ss_models_row *
ss_models_cheapest(const ss_models *models, const ss_need *need, size_t n)
{
    if (models == NULL)
        return NULL;
    const ss_models_row *best = NULL;
    double least = INFINITY;
    for (size_t i = 0; i < models->n; i++)
        if (is_answer(models, i, need, n))
            least = fmin(least, models->row[i].seconds);
    for (size_t i = 0; i < models->n; i++)
        if (is_answer(models, i, need, n) && models->row[i].seconds <= ALIKE * least)
            best = &models->row[i];
    return best;
}

static void
write_need(FILE *out, const ss_need *need)
{
    const char *name = ss_compared_name(need->what);
    if (is_count(need->what) && need->within == 0)
        fprintf(out, "the number of %s", name);
    else if (is_count(need->what))
        fprintf(out, "%s within %g", name, need->within);
    else if (ss_compared_unit(need->what)[0] != '\0')
        fprintf(out, "%s within %g %s", name, need->within, ss_compared_unit(need->what));
    else
        fprintf(out, "%s within %g %%", name, 100 * need->within);
}

/* Write the needs for which this row is the cheapest, as "A, B and C".  Returns their number. */
static size_t
write_needs(FILE *out, const ss_models *models, const ss_models_row *row, const ss_need *need, size_t n)
{
    size_t all = 0, done = 0;
    for (size_t i = 0; i < n; i++)
        all += ss_models_cheapest(models, &need[i], 1) == row;
    for (size_t i = 0; i < n; i++)
        if (ss_models_cheapest(models, &need[i], 1) == row) {
            fputs(done == 0 ? "" : done + 1 == all ? " and " : ", ", out);
            write_need(out, &need[i]);
            done++;
        }
    return all;
}

/* Write which row suffices for which needs.  The rows that leave out most come first, the scene last. */
static void
write_answer(FILE *out, const ss_models *models, const ss_need *need, size_t n)
{
    const char *then = "";
    for (size_t i = models->n; i-- > 0;) {
        const ss_models_row *row = &models->row[i];
        int wanted = 0;
        for (size_t k = 0; k < n; k++)
            wanted |= ss_models_cheapest(models, &need[k], 1) == row;
        if (!wanted)
            continue;
        fputs(then, out);
        if (i > 0)
            fprintf(out, "%s suffices for ", row->name);
        size_t needs = write_needs(out, models, row, need, n);
        if (i == 0)
            fprintf(out, " need%s %s", needs > 1 ? "" : "s", row->name);
        then = "; ";
    }
}

ss_status
ss_models_answer(char **out, const ss_models *models, const ss_need *need, size_t n, ss_error *err)
{
    if (out == NULL || models == NULL || need == NULL)
        return SS_FAIL_NULL(err);
    char *sentence = NULL;
    size_t length;
    for (size_t i = 0; i < n; i++)
        if (isnan(models->row[0].error[need[i].what]))
            return ss_fail(err, SS_EDATA, "%s cannot be kept: the scene has none",
                           ss_compared_name(need[i].what));
    FILE *text = open_memstream(&sentence, &length);
    if (text == NULL)
        return ss_fail_memory(err, NULL);
    write_answer(text, models, need, n);
    if (fclose(text) != 0) {
        free(sentence);
        return ss_fail_memory(err, NULL);
    }
    *out = sentence;
    return SS_OK;
}
