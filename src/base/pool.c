/* pool.c -- threads that are made for one task and joined at its end.
 *
 * Making a thread takes some 10 us, and no task here takes less than some 100 us.  Threads that
 * live between calls would be state that the caller must free. */
#include "base/pool.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

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

/* --- in order ------------------------------------------------------------------------------ */

enum { AHEAD = 64 };            /* results that a thread may be ahead of one that takes long */

typedef struct order {
    const ss_line *line;
    size_t taken, sent;         /* the next result to work out, and to send */
    size_t room;
    char *result;               /* result i is at i mod room, */
    char *is_done;              /* where this is 1 from its end until it is sent */
    ss_status status;
    pthread_mutex_t lock;       /* of all these; held while a result is sent */
    pthread_cond_t moved;       /* signalled when sent has grown, or the status has changed */
} order;

static void
work_in_order(void *user)
{
    order *o = user;
    const ss_line *line = o->line;
    pthread_mutex_lock(&o->lock);
    while (o->status == SS_OK && o->taken < line->n) {
        if (o->taken >= o->sent + o->room) {
            pthread_cond_wait(&o->moved, &o->lock);
            continue;
        }
        size_t i = o->taken++;
        void *result = o->result + i % o->room * line->size;
        pthread_mutex_unlock(&o->lock);
        memset(result, 0, line->size);
        line->work(i, result, line->user);
        pthread_mutex_lock(&o->lock);
        o->is_done[i % o->room] = 1;
        for (; o->status == SS_OK && o->is_done[o->sent % o->room]; o->sent++) {
            o->status = line->send(o->sent, o->result + o->sent % o->room * line->size, line->user);
            o->is_done[o->sent % o->room] = 0;
        }
        pthread_cond_broadcast(&o->moved);
    }
    pthread_mutex_unlock(&o->lock);
}

ss_status
ss_pool_line(const ss_line *line, size_t threads)
{
    order o = { .line = line, .room = threads * AHEAD };
    o.result = calloc(o.room, line->size);
    o.is_done = calloc(o.room, 1);
    o.status = o.result != NULL && o.is_done != NULL ? SS_OK : SS_ENOMEM;
    pthread_mutex_init(&o.lock, NULL);
    pthread_cond_init(&o.moved, NULL);
    if (o.status == SS_OK)
        ss_pool_run(work_in_order, &o, 0, threads);
    pthread_cond_destroy(&o.moved);
    pthread_mutex_destroy(&o.lock);
    free(o.result);
    free(o.is_done);
    return o.status;
}
