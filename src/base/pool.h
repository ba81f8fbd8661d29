/* pool.h -- work on several threads. */
#ifndef POOL_H
#define POOL_H

#include <stddef.h>
#include <stickslip/status.h>

/* Call work with each of n <= SS_THREADS_MAX arguments, an array of elements of size bytes (size 0: all
 * calls get the same argument), each on its own thread; the caller's thread is one of them.  Returns
 * when all calls have returned.  Calls for which the system has no thread run one after the other. */
void ss_pool_run(void (*work)(void *argument), void *arguments, size_t size, size_t n);

/* Work whose results are handed on in order, whichever thread is done first. */
typedef struct ss_line {
    size_t n, size;                     /* results, and the bytes of each */
    void (*work)(size_t i, void *result, void *user);           /* on any thread; *result is all zeros at first */
    ss_status (*send)(size_t i, void *result, void *user);      /* one at a time; another than SS_OK ends all */
    void *user;
} ss_line;
/* The status of the last send; SS_ENOMEM. */
ss_status ss_pool_line(const ss_line *line, size_t threads);

#endif
