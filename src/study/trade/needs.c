/* needs.c -- find the cheapest model whose errors are allowed, and write a sentence that says so. */
#include <stickslip/trade.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "study/trade/trade.h"

#define ALIKE 1.2                   /* times within this factor differ by chance */

static int
is_count(size_t what)
{
    return what == SS_COMPARED_EVENTS || what == SS_COMPARED_MICROSLIPS;
}

/* Read NAME=ERROR, or the NAME of a count. */
static ss_status
parse_need(ss_need *need, const char *text, size_t length, ss_error *err)
{
    size_t letters = strcspn(text, ",="), i = 0;
    char names[400] = "", *end = (char *)text + letters;
    const char *name;
    for (; (name = ss_compared_name(i)) != NULL; i++) {
        if (strlen(name) == letters && strncmp(name, text, letters) == 0)
            break;
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i > 0 ? ", " : "", name);
    }
    *need = (ss_need){ i, 0 };
    if (name == NULL)
        return ss_fail(err, SS_EINVAL, "'%.*s' is none of %s", (int)letters, text, names);
    if (letters == length)
        return is_count(i) ? SS_OK
            : ss_fail(err, SS_EINVAL, "%s needs an error that it may have, as in %s=0.01", name, name);
    need->within = ss_number_parse(text + letters + 1, &end);
    int is_number = end > text + letters + 1 && need->within >= 0 && isfinite(need->within);
    const char *unit = is_count(i) || ss_compared_unit(i)[0] != '\0' ? ss_compared_unit(i) : "%";
    if (unit[0] != '\0' && strncmp(end, unit, strlen(unit)) == 0) {
        need->within /= unit[0] == '%' ? 100 : 1;
        end += strlen(unit);
    }
    return is_number && end == text + length ? SS_OK
        : ss_fail(err, SS_EINVAL, "'%.*s' is not %s=ERROR, an error of 0 or more", (int)length, text, name);
}

ss_status
ss_needs_parse(ss_need need[SS_COMPARED_MOST], size_t *n, const char *list, ss_error *err)
{
    if (need == NULL || n == NULL || list == NULL)
        return SS_FAIL_NULL(err);
    const char *more = ",";
    for (*n = 0; *more == ','; list = more + 1) {
        ss_need one;
        more = list + strcspn(list, ",");
        ss_status st = parse_need(&one, list, (size_t)(more - list), err);
        for (size_t i = 0; st == SS_OK && i < *n; i++)
            if (need[i].what == one.what)
                st = ss_fail(err, SS_EINVAL, "'%s' is repeated", ss_compared_name(one.what));
        if (st != SS_OK)
            return st;
        need[(*n)++] = one;
    }
    return SS_OK;
}

/* --- the answer ---------------------------------------------------------------------------- */

int
ss_models_keeps(const ss_models_row *row, const ss_need *need, size_t n)
{
    int keeps = row->status == SS_OK;
    for (size_t i = 0; i < n; i++)
        keeps = keeps && row->error[need[i].what] <= need[i].within;
    return keeps;
}

/* The cheapest row that keeps the need; among rows whose times differ by less than a fifth, the simplest scene.
 * The settled state is left out: it is the same model. */
static const ss_models_row *
cheapest(const ss_models *models, const ss_need *need)
{
    const ss_models_row *best = NULL;
    double least = INFINITY;
    for (int choose = 0; choose < 2; choose++)
        for (size_t i = 0; i < models->n; i++) {
            const ss_models_row *row = &models->row[i];
            if (i == SS_MODELS_SETTLED || !ss_models_keeps(row, need, 1))
                continue;
            least = fmin(least, row->seconds);
            best = choose && row->seconds <= ALIKE * least ? row : best;
        }
    return best;
}

static void
write_need(FILE *out, const ss_need *need)
{
    const char *name = ss_compared_name(need->what), *unit = ss_compared_unit(need->what);
    int count = is_count(need->what), ratio = !count && unit[0] == '\0';
    if (count && need->within == 0)
        fprintf(out, "the number of %s", name);
    else
        fprintf(out, "%s within %g%s%s", name, ratio ? 100 * need->within : need->within,
                count ? "" : " ", ratio ? "%" : unit);
}

/* Write which row suffices for which needs: "coulomb suffices for A and B; C needs compliant".  The rows that
 * leave out most come first, the scene last. */
static void
write_answer(FILE *out, const ss_models *models, const ss_need *need, size_t n)
{
    const char *then = "";
    for (size_t i = models->n; i-- > 0;) {
        const ss_models_row *row = &models->row[i];
        size_t all = 0, done = 0;
        for (size_t k = 0; k < n; k++)
            all += cheapest(models, &need[k]) == row;
        if (all == 0)
            continue;
        fputs(then, out);
        if (i > 0)
            fprintf(out, "%s suffices for ", row->name);
        for (size_t k = 0; k < n; k++)
            if (cheapest(models, &need[k]) == row) {
                fputs(done == 0 ? "" : done + 1 == all ? " and " : ", ", out);
                write_need(out, &need[k]);
                done++;
            }
        if (i == 0)
            fprintf(out, " need%s %s", all > 1 ? "" : "s", row->name);
        then = "; ";
    }
}

ss_status
ss_models_answer(char **out, const ss_models *models, const ss_need *need, size_t n, ss_error *err)
{
    if (out == NULL || models == NULL || need == NULL)
        return SS_FAIL_NULL(err);
    size_t length;
    *out = NULL;
    for (size_t i = 0; i < n; i++)
        if (isnan(models->row[0].error[need[i].what]))
            return ss_fail(err, SS_EDATA, "%s cannot be kept: the scene has none",
                           ss_compared_name(need[i].what));
    FILE *text = open_memstream(out, &length);
    if (text != NULL)
        write_answer(text, models, need, n);
    if (text != NULL && fclose(text) == 0)
        return SS_OK;
    free(*out);
    *out = NULL;
    return ss_fail_memory(err, NULL);
}
