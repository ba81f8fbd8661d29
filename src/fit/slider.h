/* slider.h -- friction of a slider with rate and state whose spring is pulled along a recorded path. */
#ifndef SLIDER_H
#define SLIDER_H

#include <stddef.h>
#include <stickslip/status.h>

typedef struct slider {
    int is_slip;                /* the law: 1 slip (Ruina), 0 aging (Dieterich) */
    double ratio;               /* b / a */
    double distance;            /* Dc [m] > 0 */
    double stiffness;           /* of the machine, over a [1/m] > 0 */
    double speed;               /* it slides steadily at this speed before the first time [m/s] > 0 */
} slider;

/* Write the friction at n >= 1 times t [s], less that of before, over a: g[i].
 *
 * needs:  t that do not descend; load, the place of the load point at these times [m], straight between them;
 *         tol, the error of a step relative to the speed, 1e-15 ... 1e-3
 * gives:  mu[i] = mu[0] + a g[i], without inertia
 * fails:  SS_EDATA: the slider runs away, as a spring below the critical stiffness lets it
 * cost:   .1 us a time where these lie close, 1 us a step else */
ss_status ss_slider_run(double *g, const slider *s, const double *t, const double *load, size_t n, double tol);

#endif
