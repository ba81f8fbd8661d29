#!/usr/bin/env python3
"""Morlet transforms side by side: ours and those of other libraries that are installed.

usage: compare_morlet.py LIBSTICKSLIP.so [WORK ...]

The same noise through each, on one thread.  The libraries take turns, call by call, with a real FFT
(FFTW, double, ESTIMATE) of the same length among them, so that what else the machine does concerns
all; s is the processor time of each one's fastest call, ratio that to the FFT's.  Error: against
the definition at some coefficients away from the ends, relative to the largest |W| of the scale,
best complex factor removed (conventions differ); the worst over the scales.
"""
import ctypes
import math
import os
import sys
import time

for name in ("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "SSQ_PARALLEL", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "0" if name == "SSQ_PARALLEL" else "1"
try:
    import numpy as np
except ImportError:
    print("no numpy: other libraries are not compared")
    sys.exit(0)

# name, samples, octaves, voices, one coefficient a sample
WORKS = (("W1", 10000, 10, 16, True), ("W2", 1 << 17, 10, 32, True),
         ("W3", 1 << 20, 10, 8, True), ("W4", 1 << 20, 16, 1, False))
OMEGA_C = 6.0
SECONDS, ROUNDS = 6, 40         # of a library in a work; turns


class Opts(ctypes.Structure):
    """ss_morlet_opts"""
    _fields_ = [("center", ctypes.c_double), ("voices", ctypes.c_int), ("step", ctypes.c_double),
                ("exact", ctypes.c_int), ("dense", ctypes.c_int), ("fmin", ctypes.c_double),
                ("fmax", ctypes.c_double), ("octaves", ctypes.c_int), ("m0", ctypes.c_double),
                ("m1", ctypes.c_double), ("engine", ctypes.c_int), ("accuracy", ctypes.c_double),
                ("rounded", ctypes.c_int), ("norm", ctypes.c_int), ("admissible", ctypes.c_int),
                ("detrend", ctypes.c_int), ("force", ctypes.c_int), ("threads", ctypes.c_int),
                ("progress", ctypes.c_void_p), ("user", ctypes.c_void_p)]


def one_fft(x):
    fftw = ctypes.CDLL("libfftw3.so.3")
    fftw.fftw_plan_dft_r2c_1d.restype = ctypes.c_void_p
    out = np.zeros(len(x) // 2 + 1, complex)
    copy = x.copy()
    plan = ctypes.c_void_p(fftw.fftw_plan_dft_r2c_1d(
        len(x), copy.ctypes.data_as(ctypes.c_void_p), out.ctypes.data_as(ctypes.c_void_p), 64))
    keep = (copy, out)
    return lambda: (fftw.fftw_execute(plan), keep)


def scales_of(octaves, voices):
    first = math.ceil(voices * math.log2(13.8 / math.pi))
    return 2 ** (np.arange(first, first + octaves * voices) / voices)


def definition(x, a, places):
    """Sum over samples at whole places, with numpy."""
    reach = int(9 * a)
    w = np.empty(len(places), complex)
    for i, b in enumerate(places):
        lo, hi = max(0, b - reach), min(len(x), b + reach + 1)
        u = (np.arange(lo, hi) - b) / a
        w[i] = np.sum(x[lo:hi] * np.exp(-u * u / 2 - 1j * OMEGA_C * u))
    return w


def error_of(x, scales, rows):
    """rows(i): all coefficients of scale i, and the step between them in samples."""
    worst = 0
    for i in range(0, len(scales), max(1, len(scales) // 8)):
        row, step = rows(i)
        if len(row) < 9:
            continue
        pick = np.linspace(len(row) // 8, len(row) - 1 - len(row) // 8, 9).astype(int)
        want = definition(x, scales[i], pick * step)
        got = np.asarray(row)[pick].astype(complex)
        factor = np.vdot(got, want) / np.vdot(got, got)
        most = np.abs(factor) * np.max(np.abs(row))
        worst = max(worst, np.max(np.abs(factor * got - want)) / most)
    return worst


# Each of the following makes a call, and what gives all coefficients of scale i and the step
# between them in samples once the call has been made, or None.

def ours(library, accuracy, w):
    def prepare(x, scales, voices, dense):
        lib = ctypes.CDLL(library)
        opts = Opts.in_dll(lib, "ss_morlet_defaults")
        if (opts.center, opts.voices, opts.step, opts.accuracy, opts.threads) != (6, 16, .25, 1e-6, 1):
            sys.exit("ss_morlet_opts has other fields than this file says")
        mine = Opts.from_buffer_copy(opts)
        mine.voices, mine.step, mine.dense, mine.accuracy = voices, 1, dense, accuracy
        mine.octaves, mine.m0, mine.m1 = 1, math.log2(scales[0]), math.log2(scales[-1])
        mine.force, mine.engine = 1, 2
        plan = ctypes.c_void_p()
        lib.ss_morlet_total.restype = ctypes.c_size_t
        if lib.ss_morlet_new(ctypes.byref(plan), ctypes.c_size_t(len(x)), ctypes.c_double(1),
                             ctypes.byref(mine), None) != 0:
            raise RuntimeError("ss_morlet_new")
        total = lib.ss_morlet_total(plan)
        if len(w) == 0:
            w.append(np.ones(total, complex))
        out = w[0]

        def call():
            if lib.ss_morlet_execute(plan, x.ctypes.data_as(ctypes.c_void_p),
                                     out.ctypes.data_as(ctypes.c_void_p), None) != 0:
                raise RuntimeError("ss_morlet_execute")
        counts = [len(x) if dense else int((len(x) - 1) // a) + 1 for a in scales[::-1]]
        ends = np.cumsum(counts)
        n = len(scales)

        def rows(i):
            end = ends[n - 1 - i]
            return out[end - counts[n - 1 - i]:end], 1 if dense else int(scales[i])
        return call, lambda _: rows
    return prepare


def of_fcwt(x, scales, voices, dense):
    """Its wavelet of bandwidth s is exp(2 pi i t) exp(-t^2/(2 s^2)); scale index i is 1/f.  Its
    scales are its own, so its error is not taken."""
    import fcwt
    single = x.astype(np.float32)
    morlet = fcwt.Morlet(OMEGA_C / (2 * math.pi))
    per_f = OMEGA_C / (2 * math.pi)
    made = fcwt.Scales(morlet, fcwt.FCWT_LOGSCALES, 1, per_f / scales[-1], per_f / scales[0],
                       len(scales))
    out = np.ones((len(scales), len(x)), np.complex64)
    engine = fcwt.FCWT(morlet, 1, False, False)
    return lambda: (engine.cwt(single, made, out), morlet), None    # it does not keep morlet itself


def of_ssqueezepy(x, scales, voices, dense):
    import ssqueezepy
    single = x.astype(np.float32)
    wavelet = ssqueezepy.Wavelet(("morlet", {"mu": OMEGA_C}))
    return (lambda: ssqueezepy.cwt(single, wavelet, scales=scales.astype(np.float32),
                                   padtype="zero")[0]), lambda w: lambda i: (w[i], 1)


def of_pycwt(x, scales, voices, dense):
    import pycwt
    morlet = pycwt.Morlet(OMEGA_C)
    return (lambda: pycwt.cwt(x, 1, 1 / voices, scales[0], len(scales) - 1, morlet)[0]), \
        lambda w: lambda i: (w[i], 1)


def of_pywavelets(x, scales, voices, dense):
    """It tabulates its wavelet at a fixed number of points, whatever the scale: no measure for
    noise, so its error is not taken."""
    import pywt
    name = "cmor2-%.17g" % (OMEGA_C / (2 * math.pi))
    return lambda: pywt.cwt(x, scales, name, method="fft"), None


def take_turns(calls):
    """calls: by name.  The least seconds of each, and what failed.  Short ones are called a few
    times a turn, so that caches are theirs."""
    least = {name: math.inf for name in calls}
    spent = dict.fromkeys(calls, 0)
    failed = {}
    for turn in range(ROUNDS):
        for name, call in calls.items():
            for _ in range(3 if least[name] < 0.05 else 1):
                if name in failed or turn > 0 and spent[name] > SECONDS:
                    break
                try:
                    begin = time.process_time()
                    call()
                    seconds = time.process_time() - begin
                except Exception as problem:        # theirs, of any kind
                    failed[name] = problem
                    break
                least[name] = min(least[name], seconds)
                spent[name] += seconds
    return least, failed


def main():
    library = os.path.abspath(sys.argv[1])
    others = (("fCWT, single", of_fcwt), ("ssqueezepy, single", of_ssqueezepy),
              ("pycwt, double", of_pycwt), ("PyWavelets, double", of_pywavelets))
    print("work  library                 s    ratio to one FFT    error")
    for name, n, octaves, voices, dense in WORKS:
        if len(sys.argv) > 2 and name not in sys.argv[2:]:
            continue
        x = np.random.default_rng(1).standard_normal(n)
        scales = scales_of(octaves, voices)
        w = []                  # ours, of all of our plans
        runs = [("ours, %.0e" % tol, ours(library, tol, w)) for tol in (1e-3, 1e-4, 1e-6, 1e-8,
                                                                       1e-12)]
        calls, rows = {"FFT": one_fft(x)}, {}
        for what, prepare in runs + list(others):
            try:
                calls[what], rows[what] = prepare(x, scales, voices, dense)
            except ImportError:
                print("%-5s %-20s not installed" % (name, what))
        least, failed = take_turns(calls)
        print("%-5s %-20s %8.5f" % (name, "one FFT", least["FFT"]))
        for what in rows:
            if what in failed:
                print("%-5s %-20s failed: %s" % (name, what, failed[what]))
                continue
            error = "-"
            if rows[what]:
                error = "%.1e" % error_of(x, scales, rows[what](calls[what]()))
            print("%-5s %-20s %8.4f  %8.4g  %17s" % (name, what, least[what],
                                                     least[what] / least["FFT"], error),
                  flush=True)


main()
