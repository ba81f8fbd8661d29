/* pool.h -- one piece of work done on several threads. */
#ifndef POOL_H
#define POOL_H

#include <stddef.h>
#include <stickslip/status.h>

/* Call work with each of n <= SS_THREADS_MAX arguments, which lie one behind the other, size bytes each
 * (size 0: all calls get the same), on threads of their own, of which the caller's is one.  Returns
 * when all have returned.  Calls for which the system has no thread are made one after the other. */
void ss_pool_run(void (*work)(void *argument), void *arguments, size_t size, size_t n);

#endif
