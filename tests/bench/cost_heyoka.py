#!/usr/bin/env python3
"""cost_heyoka.py DURATION TOLERANCE ...: the state-variable scene with heyoka's Taylor series.

ss-sim must be in PATH: it makes the reference.  Samples by propagate_grid; the series is compiled
before the clock starts.  Rows as in bench.h."""
import subprocess
import sys
import time

import heyoka as hy
import numpy as np

M, K, F, Z, W, RATE, REPEATS = 2.42, 2310.0, 1.28, 0.0006, 2 * np.pi * 2.5, 2000, 15


def state_variable():
    x, v, f = hy.make_vars("x", "v", "f")
    return [(x, v), (v, (K * Z * hy.cos(W * hy.time) - K * x - f) / M),
            (f, -100.0 * (f - F * hy.tanh(3000.0 * v)))]


def reference(duration):
    text = subprocess.run(["ss-sim", "--columns=x", "--set=settle=0", f"--set=duration={duration}",
                           f"--set=rate={RATE}", "--method=rk8pd", "--tol=1e-13", "state-variable"],
                          check=True, capture_output=True).stdout
    return np.loadtxt(text.decode().splitlines())


def main():
    duration = float(sys.argv[1])
    grid = np.arange(round(duration * RATE)) / RATE
    truth = reference(duration)
    for tol in map(float, sys.argv[2:]):
        seconds = []
        integrator = hy.taylor_adaptive(state_variable(), [0.0, 0.0, 0.0], tol=tol)
        for _ in range(REPEATS):
            integrator.time = 0.0
            integrator.state[:] = 0.0
            began = time.process_time()
            x = integrator.propagate_grid(grid)[-1][:, 0]
            seconds.append(time.process_time() - began)
        error = max(abs(x - truth)) / max(abs(truth))
        print("state-variable", f"{duration:g}", "heyoka Taylor", f"{tol:.0e}", f"{error:.1e}", 0,
              f"{np.median(seconds):.3g}", sep="\t", flush=True)


if __name__ == "__main__":
    main()
