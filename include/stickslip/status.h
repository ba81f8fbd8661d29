/* stickslip/status.h -- the result of a call, and the reason of a failure. */
#ifndef STICKSLIP_STATUS_H
#define STICKSLIP_STATUS_H

#define SS_VERSION "0.1.0"

/* Declarations of public headers have C linkage and are visible outside the shared library; those of
 * the library's own headers are not. */
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
    SS_EKIND,       /* a file of another kind than the call reads; see ss_error.found */
    SS_ECLOCK,      /* a signal without a clock: ss_read_opts.rate or .time gives one */
    SS_EGAPS,       /* samples are missing, or not numbers: ss_read_opts.gaps says what to do */
    SS_EUNEVEN,     /* time stamps are not uniform: ss_read_opts.resample or .rate makes them so */
    SS_EUNIT,       /* the unit of a column of time is in doubt: ss_read_opts.time_unit says it */
    SS_ETABLES,     /* a file of several tables, or fewer than asked for: ss_read_opts.table says which */
    SS_ESCALE,      /* scales that the record cannot resolve; the text names the usable range;
                       ss_morlet_opts.force computes them all the same */
    SS_ETOL,        /* the step size underflowed before the tolerance was met */
    SS_ECHATTER,    /* events follow each other faster than double precision can separate */
    SS_EBUDGET,     /* the scene needs more work than max_steps, or its default, allows */
    SS_ERANGE       /* a value is not finite: the numbers lie beyond double precision */
} ss_status;

/* Kinds of files that the library knows, the first eight being texts that it writes. */
typedef enum ss_kind {
    SS_KIND_UNKNOWN, SS_KIND_SIGNAL, SS_KIND_COEFFICIENTS, SS_KIND_FEATURES, SS_KIND_EVENTS,
    SS_KIND_SWEEP, SS_KIND_RANKING, SS_KIND_TRADE, SS_KIND_SUMMARIES, SS_KIND_SCENE, SS_KIND_TABLE,
    SS_KIND_AU, SS_KIND_HDF5
} ss_kind;

/* The reason of a failure, one line without a newline: "run.tsv:17: expected 4 columns, found 3".
 * Filled in on failure only.  Wherever a function takes an ss_error *, NULL is allowed. */
typedef struct ss_error {
    char text[512];
    ss_kind found, wanted;      /* of SS_EKIND: the kind of the file; if unknown, the kind expected */
} ss_error;

enum { SS_THREADS_MAX = 256 };  /* that one call may be given */

/* The values that an option may have, both ends included. */
typedef struct ss_range {
    double from, to;
} ss_range;

/* A function that long work calls with the fraction done, 0 to 1; a non-zero return ends the work with
 * SS_STOP.  { NULL, NULL }: none. */
typedef struct ss_progress {
    int (*function)(double done, void *user);
    void *user;                 /* passed to it */
} ss_progress;

const char *ss_strerror(ss_status status);      /* the status in general words, never NULL */
/* Replace control characters by question marks, so that the text is one line and commands no terminal;
 * those of ISO 8859 (0x80 to 0x9f, in UTF-8 U+0080 to U+009F) are among them.  The texts of ss_error
 * have none. */
char *ss_printable(char *text);
const char *ss_version(void);                   /* of the library in use: SS_VERSION when it was built */

SS_END_DECLARATIONS
#endif
