/* header.h -- the header of a signal as text, for the readers and writers of all formats. */
#ifndef HEADER_H
#define HEADER_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/signal.h>

/* The most columns and notes, far more than any real file has.  They bound the memory and time of
 * hostile input. */
enum { MAX_COLUMNS = 1 << 15, MAX_NOTES = 4096 };

/* The rates of clocks [Hz] and the largest size of their starts [s]: times beyond would over- or underflow. */
#define RATE_MIN 1e-300
#define RATE_MAX 1e300
#define START_MAX 1e300
#define RATE_RANGE "1e-300 ... 1e300"

/* What no name has: a blank or a control character. */
static inline int
is_blank(char c)
{
    return (unsigned char)c <= ' ' || c == 127;
}

/* 1 if a note has one of these names, of which the last is NULL; a name that ends in "*" stands for all that begin
 * with it. */
int ss_note_is(const char *note, const char *const name[]);
/* Delete the notes of these names.  A result deletes all that it may say itself, so that no input speaks for
 * it. */
void ss_header_forget(ss_header *head, const char *const name[]);
/* The first row at time t or later, counted from 0; a row that lies less than 1e-6 sample periods before t counts
 * as at t. */
size_t ss_header_row(const ss_header *head, double t);
/* SS_EDATA: readers would refuse the header, as it has too many notes. */
ss_status ss_header_check_notes(const ss_header *head, ss_error *err);
#define WRONG_GAPS "the note 'gaps' is not from:to from:to ..., numbers of which each from is below its to"
/* The lines of a header, to be freed; SS_EDATA as above, and SS_ENOMEM without a text. */
ss_status ss_header_text(char **text, size_t *length, const ss_header *head, const char *magic, ss_error *err);
/* Read a "# key: value" line, which is changed; reason is set if the status is SS_EDATA. */
ss_status ss_header_read_line(ss_header *head, char *line, const char **reason);
/* Write " name", " name/unit" or " name/(unit)". */
void ss_write_label(FILE *out, const char *name, const char *unit);
/* A copy of a unit whose brackets match, so that a label can be read back, to be freed; "" for NULL. */
char *ss_clean_unit(const char *unit);
/* The unit at the end of a name, as in slip_velocity_mm_s; *before, unless it is NULL, becomes the length of the
 * name before it.  Letters that end other words, too, are a unit only behind a word for its quantity, as in
 * displacement_in and accel_g.  "": there is none, and *before stays. */
const char *ss_unit_of_name(const char *name, size_t *before);
/* A unit of force, of dimension 'N', or of length, 'm', in N or m; 0: it is none. */
double ss_unit_in_si(const char *unit, char dimension);
/* The physical quantity of a column, by its unit or its name. */
typedef enum column_quantity {
    QUANTITY_UNKNOWN, QUANTITY_FORCE, QUANTITY_DISPLACEMENT,
    QUANTITY_MOTION             /* velocity or acceleration, or it is not known which of the three */
} column_quantity;

column_quantity ss_column_quantity(const ss_column *column);
/* "unit^2/Hz", the density of a column of this unit, in brackets if it has an operator, or in decibels re that. */
enum { DENSITY_UNIT = 256 };
void ss_density_unit(char text[DENSITY_UNIT], const char *unit, int decibels);
/* Cut the next label of a list, which becomes the rest, into name and unit.  A blank in brackets belongs to a
 * unit.  Returns 0 if there is none. */
int ss_next_label(char **list, char **name, char **unit);
/* Split "name", "name/unit" or "name/(unit)" into its two parts, in place. */
void ss_split_label(char *label, char **name, char **unit);

/* SS_EDATA: the clock is so fast or slow that its times might not be finite, or starts so late that they would be
 * equal. */
ss_status ss_refuse_range(const char *name, double rate, double start, ss_error *err);
/* Copy the columns of these indices, in this order, or the first for NULL; of them the rows first ... end - 1. */
ss_status ss_signal_select(ss_signal **out, const ss_signal *signal, const size_t *column,
                           size_t n_columns, size_t first, size_t end, ss_error *err);

/* The frequencies [Hz] that the filters which a header notes left as they were: *flat becomes at least as narrow.
 * Returns 0 if it notes none. */
int ss_header_flat(const ss_header *head, ss_range *flat);

#endif
