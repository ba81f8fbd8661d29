/* csv.h -- writing comma-separated values: the functions in the table of that format. */
#ifndef CSV_H
#define CSV_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/signal.h>

ss_status ss_csv_begin(FILE *out, const ss_header *head, const char *magic, ss_error *err);
size_t ss_csv_number(char *to, double x, int last);
/* Write a cell, in quotes if it needs them; nothing for "-", an unknown value. */
void ss_csv_word(FILE *out, const char *word);

#endif
