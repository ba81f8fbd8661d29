/* real.c -- FFTs of a whole real record. */
#include <limits.h>
#include "morlet/fft/plan.h"
#include "morlet/fft/real.h"

ss_status
ss_real_fft(double *x, size_t n, int back)
{
    if (n > INT_MAX)
        return SS_ENOMEM;
    pthread_mutex_lock(&ss_fftw_planner);
    fftw_plan plan = back ? fftw_plan_dft_c2r_1d((int)n, (fftw_complex *)x, x, FFTW_ESTIMATE)
        : fftw_plan_dft_r2c_1d((int)n, x, (fftw_complex *)x, FFTW_ESTIMATE);
    pthread_mutex_unlock(&ss_fftw_planner);
    if (plan == NULL)
        return SS_ENOMEM;
    fftw_execute(plan);
    pthread_mutex_lock(&ss_fftw_planner);
    fftw_destroy_plan(plan);
    pthread_mutex_unlock(&ss_fftw_planner);
    return SS_OK;
}
