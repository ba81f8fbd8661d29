/* csv.c -- write comma-separated values as RFC 4180 describes: a line of names, then rows.  A cell
 * that contains a comma, a quote or the end of a line is quoted; a number that is not known is an
 * empty cell.  Spreadsheets take what begins with =, +, - or @ for a formula, so a word that does
 * has an apostrophe before it, which makes it text. */
#include <string.h>
#include <stickslip/number.h>
#include "io/csv.h"

static int
is_formula(const char *word)
{
    char *end;
    if (strchr("=+-@", word[0]) == NULL || word[0] == '\0' || strcmp(word, "-inf") == 0)
        return 0;
    ss_number_parse(word, &end);
    return end == word || *end != '\0';
}

void
ss_csv_word(FILE *out, const char *word)
{
    const char *before = is_formula(word) ? "'" : "";
    if (strcmp(word, "-") == 0)
        return;
    if (strpbrk(word, ",\"\r\n") == NULL) {
        fprintf(out, "%s%s", before, word);
        return;
    }
    fprintf(out, "\"%s", before);
    for (; *word != '\0'; word++)
        fputs(*word == '"' ? "\"\"" : (char[]){ *word, '\0' }, out);
    fputc('"', out);
}

ss_status
ss_csv_begin(FILE *out, const ss_header *head, const char *magic, ss_error *err)
{
    (void)magic, (void)err;
    if (head->has_time)
        fputs(head->n_columns > 0 ? "t," : "t", out);
    for (size_t c = 0; c < head->n_columns; c++) {
        ss_csv_word(out, head->column[c].name);
        if (c + 1 < head->n_columns)
            fputc(',', out);
    }
    fputc('\n', out);
    return ferror(out) ? SS_EIO : SS_OK;
}

size_t
ss_csv_number(char *to, double x, int last)
{
    size_t n = ss_number_format(to, x);
    to[n] = last ? '\n' : ',';
    return n + 1;
}
