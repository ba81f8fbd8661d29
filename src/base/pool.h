/* pool.h -- one function on several threads. */
#ifndef POOL_H
#define POOL_H

#include <stddef.h>
#include <stickslip/status.h>

/* Call work with each of n <= SS_THREADS_MAX arguments, an array of elements of size bytes (size 0: all
 * calls get the same argument), each on its own thread; the caller's thread is one of them.  Returns
 * when all calls have returned.  Calls for which the system has no thread run one after the other. */
void ss_pool_run(void (*work)(void *argument), void *arguments, size_t size, size_t n);

#endif
