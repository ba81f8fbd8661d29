/* plans.c -- FFTW's plans of the levels and of the scales of blocks.c, and of their adjoint.
 *
 * Levels with windows of one length share their plans, and so do scales with as many points. */
#include <fftw3.h>
#include <pthread.h>
#include "map/fft/plan.h"
#include "map/fft/stage.h"

static ss_status
plan_stage(struct blocks *b, size_t l, double *v, unsigned how)
{
    stage *st = &b->stage[l];
    int n = (int)st->length;
    double *to = v + st->stride;
    const stage *same = l > 0 && st[-1].length == st->length ? st - 1 : NULL;
    st->forward = same != NULL ? same->forward
        : fftw_plan_dft_r2c_1d(n, v, (fftw_complex *)to, how);
    st->back = same != NULL ? same->back
        : fftw_plan_dft_c2r_1d(n / 2, (fftw_complex *)to, v, how);
    return st->forward != NULL && st->back != NULL ? SS_OK : SS_ENOMEM;
}

static fftw_plan
inverse_of(const struct blocks *b, size_t i, double *v, unsigned how)
{
    const block_scale *r = &b->scale[i];
    for (size_t j = i + 1; j < b->n_scales; j++)
        if (b->scale[j].level >= 0 && b->scale[j].points == r->points)
            return b->scale[j].inverse;
    return fftw_plan_dft_1d((int)r->points, (fftw_complex *)v,
                            (fftw_complex *)(v + 2 * (b->longest + DENSE_MARGIN)), FFTW_BACKWARD,
                            how);
}

/* Make all plans.  The caller holds ss_fftw_planner. */
static ss_status
plan_all(struct blocks *b, double *v, unsigned how)
{
    ss_status st = SS_OK;
    for (size_t l = 0; st == SS_OK && l < b->levels; l++)
        st = plan_stage(b, l, v, how);
    for (size_t i = b->n_scales; st == SS_OK && i-- > 0;) {
        block_scale *r = &b->scale[i];
        if (r->level < 0)
            continue;
        r->inverse = inverse_of(b, i, v, how);
        st = r->inverse != NULL ? SS_OK : SS_ENOMEM;
    }
    return st;
}

ss_status
ss_blocks_plans_make(struct blocks *b, ss_planner planner, size_t room)
{
    for (size_t l = 0; l < b->levels; l++)
        room = 2 * b->stage[l].stride > room ? 2 * b->stage[l].stride : room;
    double *v = fftw_malloc(room * sizeof *v);
    if (v == NULL)
        return SS_ENOMEM;
    pthread_mutex_lock(&ss_fftw_planner);
    ss_status st = plan_all(b, v, flag_of(planner));
    pthread_mutex_unlock(&ss_fftw_planner);
    fftw_free(v);
    return st;
}

void
ss_blocks_plans_free(struct blocks *b)
{
    pthread_mutex_lock(&ss_fftw_planner);
    for (size_t i = 0; i < b->n_scales; i++) {
        fftw_plan p = b->scale[i].inverse;
        for (size_t j = i + 1; p != NULL && j < b->n_scales; j++)
            if (b->scale[j].inverse == p)
                b->scale[j].inverse = NULL;
        if (p != NULL)
            fftw_destroy_plan(p);
    }
    for (size_t l = 0; l < b->levels; l++) {
        if (l > 0 && b->stage[l].forward == b->stage[l - 1].forward)
            continue;
        if (b->stage[l].forward != NULL)
            fftw_destroy_plan(b->stage[l].forward);
        if (b->stage[l].back != NULL)
            fftw_destroy_plan(b->stage[l].back);
    }
    pthread_mutex_unlock(&ss_fftw_planner);
}

ss_status
ss_sums_plans_make(struct block_sums *s)
{
    ss_status status = SS_OK;
    pthread_mutex_lock(&ss_fftw_planner);
    for (size_t l = 0; status == SS_OK && l < s->b->levels; l++) {
        const stage *st = &s->b->stage[l];
        int n = (int)st->length;
        fftw_complex *terms = (fftw_complex *)(s->v + st->stride), *half = terms + st->stride / 2;
        s->half[l] = fftw_plan_dft_r2c_1d(n / 2, s->v, half, FFTW_ESTIMATE);
        s->back[l] = fftw_plan_dft_c2r_1d(n, terms, s->v, FFTW_ESTIMATE);
        status = s->half[l] != NULL && s->back[l] != NULL ? SS_OK : SS_ENOMEM;
    }
    pthread_mutex_unlock(&ss_fftw_planner);
    return status;
}

void
ss_sums_plans_free(struct block_sums *s)
{
    pthread_mutex_lock(&ss_fftw_planner);
    for (size_t l = 0; l < s->b->levels; l++) {
        if (s->half[l] != NULL)
            fftw_destroy_plan(s->half[l]);
        if (s->back[l] != NULL)
            fftw_destroy_plan(s->back[l]);
    }
    pthread_mutex_unlock(&ss_fftw_planner);
}
