/* plans.c -- FFTW's plans of the levels and of the scales of blocks.c, and of their adjoint.
 *
 * Levels with windows of one length share their plans, and so do scales with as many points. */
#include <fftw3.h>
#include <pthread.h>
#include <stdlib.h>
#include "base/fft.h"
#include "map/fft/stage.h"

typedef enum plan_kind { FROM_REAL, TO_REAL, INVERSE } plan_kind;

struct shared_plan {
    plan_kind kind;
    size_t n;
    fftw_plan plan;
    shared_plan *next;
};

/* The plan of a kind and length, from the list, or made for these arrays.  The caller holds ss_fftw_planner.
 * NULL: no memory. */
static fftw_plan
plan_of(shared_plan **plans, plan_kind kind, size_t n, double *from, double *to)
{
    for (const shared_plan *p = *plans; p != NULL; p = p->next)
        if (p->kind == kind && p->n == n)
            return p->plan;
    shared_plan *p = malloc(sizeof *p);
    if (p == NULL)
        return NULL;
    *p = (shared_plan){ .kind = kind, .n = n, .next = *plans };
    *plans = p;
    p->plan = kind == FROM_REAL ? fftw_plan_dft_r2c_1d((int)n, from, (fftw_complex *)to, FFTW_ESTIMATE)
        : kind == TO_REAL ? fftw_plan_dft_c2r_1d((int)n, (fftw_complex *)from, to, FFTW_ESTIMATE)
        : fftw_plan_dft_1d((int)n, (fftw_complex *)from, (fftw_complex *)to, FFTW_BACKWARD, FFTW_ESTIMATE);
    return p->plan;
}

void
ss_plans_free(shared_plan *plans)
{
    pthread_mutex_lock(&ss_fftw_planner);
    for (shared_plan *next; plans != NULL; plans = next) {
        next = plans->next;
        if (plans->plan != NULL)
            fftw_destroy_plan(plans->plan);
        free(plans);
    }
    pthread_mutex_unlock(&ss_fftw_planner);
}

ss_status
ss_blocks_plans_make(struct blocks *b, size_t room)
{
    for (size_t l = 0; l < b->levels; l++)
        room = 2 * b->stage[l].stride > room ? 2 * b->stage[l].stride : room;
    double *v = fftw_malloc(room * sizeof *v);
    if (v == NULL)
        return SS_ENOMEM;
    int made = 1;
    double *points = v + 2 * (b->longest + DENSE_MARGIN);
    pthread_mutex_lock(&ss_fftw_planner);
    for (size_t l = 0; made && l < b->levels; l++) {
        stage *st = &b->stage[l];
        st->forward = plan_of(&b->plans, FROM_REAL, st->length, v, v + st->stride);
        st->back = plan_of(&b->plans, TO_REAL, st->length / 2, v + st->stride, v);
        made = st->forward != NULL && st->back != NULL;
    }
    for (size_t i = b->n_scales; made && i-- > 0;)
        if (b->scale[i].level >= 0) {
            b->scale[i].inverse = plan_of(&b->plans, INVERSE, b->scale[i].points, v, points);
            made = b->scale[i].inverse != NULL;
        }
    pthread_mutex_unlock(&ss_fftw_planner);
    fftw_free(v);
    return made ? SS_OK : SS_ENOMEM;
}

ss_status
ss_sums_plans_make(struct block_sums *s)
{
    int made = 1;
    pthread_mutex_lock(&ss_fftw_planner);
    for (size_t l = 0; made && l < s->b->levels; l++) {
        size_t n = s->b->stage[l].length, stride = s->b->stage[l].stride;
        double *terms = s->v + stride, *half = terms + stride;
        s->half[l] = plan_of(&s->plans, FROM_REAL, n / 2, s->v, half);
        s->back[l] = plan_of(&s->plans, TO_REAL, n, terms, s->v);
        made = s->half[l] != NULL && s->back[l] != NULL;
    }
    pthread_mutex_unlock(&ss_fftw_planner);
    return made ? SS_OK : SS_ENOMEM;
}
