/* pool.c -- threads that are made for one task and joined at its end.
 *
 * Making a thread takes some 10 us, and no task here takes less than some 100 us.  Threads that
 * live between calls would be state that the caller must free. */
#include "base/pool.h"

#include <pthread.h>

typedef struct hand {
    pthread_t thread;
    int started;
    void (*work)(void *argument);
    void *argument;
} hand;

static void *
start(void *user)
{
    hand *h = user;
    h->work(h->argument);
    return NULL;
}

void
ss_pool_run(void (*work)(void *argument), void *arguments, size_t size, size_t n)
{
    hand h[SS_THREADS_MAX];
    for (size_t i = 0; i < n; i++) {
        h[i] = (hand){ .work = work, .argument = (char *)arguments + i * size };
        h[i].started = i > 0 && pthread_create(&h[i].thread, NULL, start, &h[i]) == 0;
    }
    for (size_t i = 0; i < n; i++)
        if (!h[i].started)
            work(h[i].argument);
    for (size_t i = 1; i < n; i++)
        if (h[i].started)
            pthread_join(h[i].thread, NULL);
}
