/* stickslip.h -- everything that libstickslip declares.
 *
 * Simulation of oscillators with dry-friction contact, Morlet wavelet coefficients of acceleration
 * signals, their storage and their pictures, after J.-W. Liang and B. F. Feeny, "Wavelet Analysis
 * of Stick-Slip Signals in Oscillators with Dry-Friction Contact", J. Vib. Acoust. 127 (2005)
 * 139-143, called "the paper" in all comments.
 *
 * SI units throughout.  No function prints, exits or keeps global state; all may be called from
 * several threads at once on objects of their own, but for those of store.h: HDF5 in its serial
 * build is not safe for threads.  SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STICKSLIP_H
#define STICKSLIP_H

#include <stickslip/backbone.h>
#include <stickslip/status.h>
#include <stickslip/number.h>
#include <stickslip/scene.h>
#include <stickslip/sim.h>
#include <stickslip/trade.h>
#include <stickslip/sweep.h>
#include <stickslip/signal.h>
#include <stickslip/spectrum.h>
#include <stickslip/morlet.h>
#include <stickslip/features.h>
#include <stickslip/spikes.h>
#include <stickslip/rank.h>
#include <stickslip/steps.h>
#include <stickslip/store.h>
#include <stickslip/overlay.h>
#include <stickslip/table.h>
#include <stickslip/overview.h>
#include <stickslip/plot.h>

#endif
