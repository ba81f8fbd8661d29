#!/usr/bin/env python3
"""cost_heyoka.py LIBRARY DURATION: the state-variable scene, and the Coulomb scene with a friction that falls
with speed (stribeck), with heyoka's Taylor series and, in turns, with the method taylor of LIBRARY, which is
cost_sim.c; and the ratio of their times at equal error, between rows by the logarithms of both.

ss-sim must be in PATH: it makes the references.  Samples by propagate_grid; the series is compiled
before the clock starts.  True stick is a mode of the same integrator: events end stick and slip, and the
time within their callbacks, which are Python, is taken off.  Rows as in bench.h."""
import ctypes
import subprocess
import sys
import time

import heyoka as hy
import numpy as np

TOLERANCES = [1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14]
ERRORS = [1e-6, 1e-9, 1e-13]
M, K, F, Z, W, RATE, REPEATS = 2.42, 2310.0, 1.28, 0.0006, 2 * np.pi * 2.5, 2000, 15
F_KINETIC, V_S = 0.9, 1e-3      # of stribeck, where F is the static friction


class StateVariable:
    name = "state-variable"
    scene = ["state-variable"]
    start = [0.0, 0.0, 0.0]
    events = 0
    outside = 0.0

    def integrator(self, tol):
        x, v, f = hy.make_vars("x", "v", "f")
        return hy.taylor_adaptive([
            (x, v), (v, (K * Z * hy.cos(W * hy.time) - K * x - f) / M),
            (f, -100.0 * (f - F * hy.tanh(3000.0 * v)))], self.start, tol=tol)

    def begin(self, integrator):
        pass


class Stribeck:
    """Parameter 0 is the direction of slip, 0 in stick.  An integrator copies the callbacks with their object: what
    they count belongs to the class."""
    name = "stribeck"
    scene = ["--set=model=stribeck", f"--set=friction={F_KINETIC}", f"--set=static_friction={F}",
             f"--set=stribeck_velocity={V_S}", "coulomb"]
    start = [0.0, 0.0]
    events = 0
    outside = 0.0
    RESTS = 1e-15               # v / (m/s) at which slip ends: it starts at 0

    def integrator(self, tol):
        x, v = hy.make_vars("x", "v")
        direction = hy.par[0]
        slips = direction * direction
        load = K * (Z * hy.cos(W * hy.time) - x)
        friction = direction * (F_KINETIC + (F - F_KINETIC) / (1.0 + direction * v / V_S))
        falls = hy.event_direction.negative
        ends = [hy.t_event(direction * v + (1.0 - slips) + self.RESTS, callback=self.stop, direction=falls),
                hy.t_event(F * F - (1.0 - slips) * load * load, callback=self.go, direction=falls)]
        return hy.taylor_adaptive([(x, v), (v, slips * (load - friction) / M)], self.start, tol=tol,
                                  t_events=ends, pars=[0.0])

    def begin(self, integrator):
        integrator.reset_cooldowns()
        integrator.pars[0] = float(K * Z > F)
        Stribeck.events = int(K * Z > F)
        Stribeck.outside = 0.0

    def enter(self, integrator, may_stick):
        began = time.process_time()
        load = K * (Z * np.cos(W * integrator.time) - integrator.state[0])
        integrator.state[1] = 0.0
        integrator.pars[0] = 0.0 if may_stick and abs(load) <= F else np.sign(load)
        Stribeck.events += 1
        Stribeck.outside += time.process_time() - began
        return True

    def stop(self, integrator, _):
        return self.enter(integrator, True)

    def go(self, integrator, _):
        return self.enter(integrator, False)


def reference(scene, duration):
    text = subprocess.run(["ss-sim", "--columns=x", "--set=settle=0", f"--set=duration={duration}",
                           f"--set=rate={RATE}", "--method=rk8pd", "--tol=1e-14", *scene],
                          check=True, capture_output=True).stdout
    return np.loadtxt(text.decode().splitlines())


def heyoka(model, grid):
    integrators = {tol: model.integrator(tol) for tol in TOLERANCES}

    def run(tol):
        integrator = integrators[tol]
        integrator.time = 0.0
        integrator.state[:] = model.start
        model.begin(integrator)
        began = time.process_time()
        x = integrator.propagate_grid(grid)[-1][:, 0]
        return time.process_time() - began - model.outside, x
    return run


def taylor(library, model, duration, n):
    cost = ctypes.CDLL(library).cost_taylor
    cost.restype = ctypes.c_double
    cost.argtypes = [ctypes.c_int, ctypes.c_double, ctypes.c_double, ctypes.c_void_p]

    def run(tol):
        x = np.empty(n)
        return cost(model.name == "stribeck", duration, tol, x.ctypes.data), x
    return run


def time_at(error, rows):
    """The least time of an error between those of two neighbouring tolerances."""
    times = [np.nan]
    for (e, t), (f, u) in zip(rows, rows[1:]):
        if f <= error <= e and f < e:
            times.append(t * (u / t) ** (np.log(e / error) / np.log(e / f)))
    return np.nanmin(times) if len(times) > 1 else np.nan


def measure(model, library, duration):
    grid = np.arange(round(duration * RATE)) / RATE
    truth = reference(model.scene, duration)
    methods = {"taylor": taylor(library, model, duration, len(grid)), "heyoka Taylor": heyoka(model, grid)}
    rows = {name: [] for name in methods}
    for tol in TOLERANCES:
        seconds = {name: [] for name in methods}
        for _ in range(REPEATS):
            for name, run in methods.items():
                spent, x = run(tol)
                seconds[name].append(spent)
                error = max(abs(x - truth)) / max(abs(truth))
                if len(seconds[name]) == 1:
                    rows[name].append([error])
        for name in methods:
            rows[name][-1].append(np.median(seconds[name]))
        error, spent = rows["heyoka Taylor"][-1]
        print(model.name, f"{duration:g}", "heyoka Taylor", f"{tol:.0e}", f"{error:.1e}", model.events,
              f"{spent:.3g}", sep="\t", flush=True)
    for error in ERRORS:
        ours, theirs = (time_at(error, rows[name]) for name in methods)
        print(f"# {model.name}, error {error:.0e}: taylor {1e3 * ours:.2f} ms, heyoka {1e3 * theirs:.2f} ms, "
              f"ratio {ours / theirs:.2f}", flush=True)


def main():
    for model in StateVariable(), Stribeck():
        measure(model, sys.argv[1], float(sys.argv[2]))


if __name__ == "__main__":
    main()
