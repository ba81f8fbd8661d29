/* wave.h -- the options of benchmark signals by default. */
#ifndef WAVE_H
#define WAVE_H

#include <stickslip/signal.h>

extern const ss_wave_opts ss_wave_defaults;

#endif
