/* fft.c -- FFTs of records, of segments and of cycles. */
#include "base/fft.h"

#include <fftw3.h>
#include <limits.h>

pthread_mutex_t ss_fftw_planner = PTHREAD_MUTEX_INITIALIZER;

static void
free_plan(fftw_plan plan)
{
    pthread_mutex_lock(&ss_fftw_planner);
    fftw_destroy_plan(plan);
    pthread_mutex_unlock(&ss_fftw_planner);
}

/* Plan an FFT of f->x, which stays as it is. */
static ss_status
plan_real(real_fft *f, size_t n, int back)
{
    fftw_complex *terms = (fftw_complex *)f->x;
    pthread_mutex_lock(&ss_fftw_planner);
    f->plan = back ? fftw_plan_dft_c2r_1d((int)n, terms, f->x, FFTW_ESTIMATE)
        : fftw_plan_dft_r2c_1d((int)n, f->x, terms, FFTW_ESTIMATE);
    pthread_mutex_unlock(&ss_fftw_planner);
    if (f->plan != NULL)
        return SS_OK;
    ss_real_fft_free(f);
    return SS_ENOMEM;
}

ss_status
ss_real_fft_new(real_fft *f, size_t n, int back)
{
    *f = (real_fft){ n < INT_MAX - 2 ? fftw_malloc((n + 2) * sizeof *f->x) : NULL, NULL };
    return f->x != NULL ? plan_real(f, n, back) : SS_ENOMEM;
}

ss_status
ss_real_fft_turn(real_fft *f, size_t n)
{
    free_plan(f->plan);
    return plan_real(f, n, 1);
}

void
ss_real_fft_run(const real_fft *f)
{
    fftw_execute(f->plan);
}

void
ss_real_fft_free(real_fft *f)
{
    if (f->plan != NULL)
        free_plan(f->plan);
    fftw_free(f->x);
    *f = (real_fft){ 0 };
}

ss_status
ss_complex_fft(double complex *z, size_t n, size_t records, int back)
{
    fftw_complex *at = (fftw_complex *)z;
    const int length = (int)n;
    if (n > INT_MAX || records > INT_MAX)
        return SS_ENOMEM;
    pthread_mutex_lock(&ss_fftw_planner);
    fftw_plan plan = fftw_plan_many_dft(1, &length, (int)records, at, NULL, 1, length, at, NULL, 1, length,
                                        back ? FFTW_BACKWARD : FFTW_FORWARD, FFTW_ESTIMATE);
    pthread_mutex_unlock(&ss_fftw_planner);
    if (plan == NULL)
        return SS_ENOMEM;
    fftw_execute(plan);
    free_plan(plan);
    return SS_OK;
}
