#!/usr/bin/env python3
"""Morlet transforms side by side: ours and those of other libraries that are installed.

usage: compare_morlet.py LIBSTICKSLIP.so

The same noise through each, one thread, wall seconds, the best of a few runs, next to one real FFT
(FFTW, double, ESTIMATE) of the same length in the same run.  Error: against the definition at some
coefficients away from the ends, relative to the largest |W| of the scale, best complex factor
removed (conventions differ); the worst over the scales.
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
REPEAT = 5


class Opts(ctypes.Structure):
    """ss_morlet_opts"""
    _fields_ = [("center", ctypes.c_double), ("voices", ctypes.c_int), ("step", ctypes.c_double),
                ("dense", ctypes.c_int), ("fmin", ctypes.c_double), ("fmax", ctypes.c_double),
                ("octaves", ctypes.c_int), ("m0", ctypes.c_double), ("m1", ctypes.c_double),
                ("engine", ctypes.c_int), ("accuracy", ctypes.c_double), ("norm", ctypes.c_int),
                ("admissible", ctypes.c_int), ("detrend", ctypes.c_int), ("force", ctypes.c_int),
                ("threads", ctypes.c_int), ("planner", ctypes.c_int)]


def best(call):
    seconds = math.inf
    for _ in range(REPEAT):
        begin = time.perf_counter()
        result = call()
        seconds = min(seconds, time.perf_counter() - begin)
    return seconds, result


def one_fft(x):
    fftw = ctypes.CDLL("libfftw3.so.3")
    fftw.fftw_plan_dft_r2c_1d.restype = ctypes.c_void_p
    out = np.zeros(len(x) // 2 + 1, complex)
    copy = x.copy()
    plan = ctypes.c_void_p(fftw.fftw_plan_dft_r2c_1d(
        len(x), copy.ctypes.data_as(ctypes.c_void_p), out.ctypes.data_as(ctypes.c_void_p), 64))
    seconds = min(best(lambda: fftw.fftw_execute(plan))[0] for _ in range(5))
    fftw.fftw_destroy_plan(plan)
    return seconds


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


def ours(library, accuracy, planner=0, threads=1):
    def run(x, scales, voices, dense):
        lib = ctypes.CDLL(library)
        opts = Opts.in_dll(lib, "ss_morlet_defaults")
        mine = Opts.from_buffer_copy(opts)
        mine.voices, mine.step, mine.dense, mine.accuracy = voices, 1, dense, accuracy
        mine.octaves, mine.m0, mine.m1 = 1, math.log2(scales[0]), math.log2(scales[-1])
        mine.force, mine.engine = 1, 2
        mine.planner, mine.threads = planner, threads
        plan = ctypes.c_void_p()
        lib.ss_morlet_total.restype = ctypes.c_size_t
        if lib.ss_morlet_new(ctypes.byref(plan), ctypes.c_size_t(len(x)), ctypes.c_double(1),
                             ctypes.byref(mine), None) != 0:
            raise RuntimeError("ss_morlet_new")
        total = lib.ss_morlet_total(plan)
        w = np.ones(total, complex)
        call = lambda: lib.ss_morlet_execute(plan, x.ctypes.data_as(ctypes.c_void_p),
                                             w.ctypes.data_as(ctypes.c_void_p), None)
        seconds, _ = best(call)
        lib.ss_morlet_free(plan)
        counts = [len(x) if dense else int((len(x) - 1) // a) + 1 for a in scales[::-1]]
        ends = np.cumsum(counts)
        n = len(scales)

        def rows(i):
            end = ends[n - 1 - i]
            return w[end - counts[n - 1 - i]:end], 1 if dense else int(scales[i])
        return seconds, rows
    return run


def fcwt_run(x, scales, voices, dense):
    """Its wavelet of bandwidth s is exp(2 pi i t) exp(-t^2/(2 s^2)); scale index i is 1/f."""
    import fcwt
    single = x.astype(np.float32)
    morlet = fcwt.Morlet(OMEGA_C / (2 * math.pi))
    per_f = OMEGA_C / (2 * math.pi)
    made = fcwt.Scales(morlet, fcwt.FCWT_LOGSCALES, 1, per_f / scales[-1], per_f / scales[0],
                       len(scales))
    out = np.ones((len(scales), len(x)), np.complex64)
    engine = fcwt.FCWT(morlet, 1, False, False)
    seconds, _ = best(lambda: engine.cwt(single, made, out))
    return seconds, None            # its scales are its own: its error is not taken


def ssqueezepy_run(x, scales, voices, dense):
    import ssqueezepy
    single = x.astype(np.float32)
    wavelet = ssqueezepy.Wavelet(("morlet", {"mu": OMEGA_C}))
    seconds, w = best(lambda: ssqueezepy.cwt(single, wavelet, scales=scales.astype(np.float32),
                                             padtype="zero")[0])
    return seconds, lambda i: (w[i], 1)


def pywavelets_run(x, scales, voices, dense):
    import pywt
    name = "cmor2-%.17g" % (OMEGA_C / (2 * math.pi))
    begin = time.perf_counter()
    pywt.cwt(x, scales, name, method="fft")
    # it tabulates its wavelet at a fixed number of points, whatever the scale: no measure for noise
    return time.perf_counter() - begin, None


def main():
    library = os.path.abspath(sys.argv[1])
    others = (("fCWT, single", fcwt_run), ("ssqueezepy, single", ssqueezepy_run),
              ("PyWavelets, double", pywavelets_run))
    print("work  library                 s    ratio to one FFT    error")
    for name, n, octaves, voices, dense in WORKS:
        x = np.random.default_rng(1).standard_normal(n)
        scales = scales_of(octaves, voices)
        fft = one_fft(x)
        runs = [("ours, accuracy %.0e" % tol, ours(library, tol)) for tol in (1e-3, 1e-6, 1e-12)]
        if n <= 1 << 17:        # measuring FFTs for longer records takes minutes
            runs.append(("the same, measured", ours(library, 1e-12, planner=1)))
        if os.cpu_count() > 1:
            runs.append(("1e-12, 2 threads", ours(library, 1e-12, threads=2)))
        for what, run in runs + list(others):
            try:
                seconds, rows = run(x, scales, voices, dense)
            except ImportError:
                print("%-5s %-20s not installed" % (name, what))
                continue
            except Exception as problem:    # theirs, of any kind
                print("%-5s %-20s failed: %s" % (name, what, problem))
                continue
            error = "%.1e" % error_of(x, scales, rows) if rows else "-"
            print("%-5s %-20s %8.4f  %8.4g  %17s" % (name, what, seconds, seconds / fft, error),
                  flush=True)


main()
