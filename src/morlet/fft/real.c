/* real.c -- FFTs of a whole record. */
#include <limits.h>
#include "morlet/fft/plan.h"
#include "morlet/fft/real.h"

/* Execute a plan that was made while ss_fftw_planner was held, and free it. */
static ss_status
run(fftw_plan plan)
{
    pthread_mutex_unlock(&ss_fftw_planner);
    if (plan == NULL)
        return SS_ENOMEM;
    fftw_execute(plan);
    pthread_mutex_lock(&ss_fftw_planner);
    fftw_destroy_plan(plan);
    pthread_mutex_unlock(&ss_fftw_planner);
    return SS_OK;
}

ss_status
ss_real_fft(double *x, size_t n, int back)
{
    if (n > INT_MAX)
        return SS_ENOMEM;
    pthread_mutex_lock(&ss_fftw_planner);
    return run(back ? fftw_plan_dft_c2r_1d((int)n, (fftw_complex *)x, x, FFTW_ESTIMATE)
                    : fftw_plan_dft_r2c_1d((int)n, x, (fftw_complex *)x, FFTW_ESTIMATE));
}

ss_status
ss_complex_fft(double complex *z, size_t n, size_t records, size_t stride, int back)
{
    fftw_complex *at = (fftw_complex *)z;
    const int length = (int)n, apart = (int)stride, next = stride == 1 ? length : 1;
    if (n > INT_MAX || records > INT_MAX || stride > INT_MAX)
        return SS_ENOMEM;
    pthread_mutex_lock(&ss_fftw_planner);
    return run(fftw_plan_many_dft(1, &length, (int)records, at, NULL, apart, next, at, NULL, apart, next,
                                  back ? FFTW_BACKWARD : FFTW_FORWARD, FFTW_ESTIMATE));
}
