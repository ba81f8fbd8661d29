/* stickslip/status.h -- the result of a call, and the reason of a failure. */
#ifndef STICKSLIP_STATUS_H
#define STICKSLIP_STATUS_H

#define SS_VERSION "1.0.0"

/* What stands between SS_BEGIN_DECLARATIONS and SS_END_DECLARATIONS has C linkage and is visible
 * outside the shared library.  The library's own headers do not use them, so it hides the rest. */
#ifdef __cplusplus
#define SS_EXTERN_C extern "C" {
#define SS_EXTERN_C_END }
#else
#define SS_EXTERN_C
#define SS_EXTERN_C_END
#endif
#ifdef __GNUC__
#define SS_BEGIN_DECLARATIONS SS_EXTERN_C _Pragma("GCC visibility push(default)")
#define SS_END_DECLARATIONS _Pragma("GCC visibility pop") SS_EXTERN_C_END
#else
#define SS_BEGIN_DECLARATIONS SS_EXTERN_C
#define SS_END_DECLARATIONS SS_EXTERN_C_END
#endif

SS_BEGIN_DECLARATIONS

typedef enum ss_status {
    SS_OK = 0,
    SS_STOP,        /* a sink asked to stop; not an error */
    SS_EINVAL,      /* an argument outside its documented range */
    SS_ENOMEM,      /* an allocation failed */
    SS_EIO,         /* reading or writing failed; errno says why */
    SS_EDATA,       /* malformed input; the text names file and line */
    SS_EKIND,       /* the call does not read files of this kind; see ss_error.found */
    SS_ECLOCK,      /* the signal has no clock: ss_read_opts.rate or .time gives it one */
    SS_EGAPS,       /* samples are missing, or not numbers: ss_read_opts.gaps says what to do */
    SS_EUNEVEN,     /* time stamps are not uniform: ss_read_opts.resample or .rate makes them so */
    SS_EUNIT,       /* the unit of a column of time is in doubt: ss_read_opts.time_unit gives it */
    SS_ETABLES,     /* the file has several tables, or not the one asked for: ss_read_opts.table
                       says which one is meant */
    SS_ESCALE,      /* the record cannot resolve these scales; the text names the usable range;
                       ss_morlet_opts.force computes them all the same */
    SS_ETOL,        /* the step size underflowed before the tolerance was met */
    SS_ECHATTER,    /* events follow each other faster than double precision can separate */
    SS_EBUDGET,     /* the scene needs more work than max_steps, or its default, allows */
    SS_ERANGE       /* a value is not finite: it is larger than a double can hold */
} ss_status;

/* The kinds of files that the library knows.  SS_KIND_SIGNAL to SS_KIND_SUMMARIES are texts that it
 * writes. */
typedef enum ss_kind {
    SS_KIND_UNKNOWN, SS_KIND_SIGNAL, SS_KIND_COEFFICIENTS, SS_KIND_FEATURES, SS_KIND_EVENTS,
    SS_KIND_SWEEP, SS_KIND_RANKING, SS_KIND_TRADE, SS_KIND_SPECTRUM, SS_KIND_BACKBONE,
    SS_KIND_RIDGE, SS_KIND_SUMMARIES, SS_KIND_SCENE,
    SS_KIND_TABLE, SS_KIND_AU, SS_KIND_HDF5
} ss_kind;

/* The reason of a failure, one line without a newline: "run.tsv:17: expected 4 columns, found 3".
 * A call writes it only if it fails.  Every parameter of type ss_error * may be NULL. */
typedef struct ss_error {
    char text[512];
    ss_kind found;              /* with SS_EKIND: the kind of the file, if it is known */
    ss_kind wanted;             /* with SS_EKIND: the kind that the call reads, if found is unknown */
} ss_error;

enum { SS_THREADS_MAX = 256 };  /* the largest number of threads that one call may be given */

/* The values that an option may have, both ends included. */
typedef struct ss_range {
    double from, to;
} ss_range;

/* Long work calls function with the fraction that is done, 0 to 1.  A non-zero return ends the work
 * with SS_STOP.  A NULL function is not called. */
typedef struct ss_progress {
    int (*function)(double done, void *user);
    void *user;                 /* passed to function */
} ss_progress;

/* The meaning of a status in general words; a constant text, never NULL. */
const char *ss_strerror(ss_status status);
/* Replace each control character of text by a question mark, in place, and return text.  It is then
 * one line and sends no command to a terminal.  The control characters of ISO 8859 (0x80 to 0x9f,
 * in UTF-8 U+0080 to U+009F) are replaced too.  ss_error.text has no control characters. */
char *ss_printable(char *text);
/* The version of the library in use; SS_VERSION is that of the header. */
const char *ss_version(void);

SS_END_DECLARATIONS
#endif
