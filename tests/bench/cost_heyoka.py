#!/usr/bin/env python3
"""cost_heyoka.py DURATION TOLERANCE ...: the state-variable scene, and the Coulomb scene with a friction
that falls with speed (stribeck), with heyoka's Taylor series.

ss-sim must be in PATH: it makes the references.  Samples by propagate_grid; the series is compiled
before the clock starts.  True stick is a mode of the same integrator: events end stick and slip, and the
time within their callbacks, which are Python, is taken off.  Rows as in bench.h."""
import subprocess
import sys
import time

import heyoka as hy
import numpy as np

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
                           f"--set=rate={RATE}", "--method=rk8pd", "--tol=1e-13", *scene],
                          check=True, capture_output=True).stdout
    return np.loadtxt(text.decode().splitlines())


def measure(model, duration, tolerances):
    grid = np.arange(round(duration * RATE)) / RATE
    truth = reference(model.scene, duration)
    for tol in tolerances:
        seconds = []
        integrator = model.integrator(tol)
        for _ in range(REPEATS):
            integrator.time = 0.0
            integrator.state[:] = model.start
            model.begin(integrator)
            began = time.process_time()
            x = integrator.propagate_grid(grid)[-1][:, 0]
            seconds.append(time.process_time() - began - model.outside)
        error = max(abs(x - truth)) / max(abs(truth))
        print(model.name, f"{duration:g}", "heyoka Taylor", f"{tol:.0e}", f"{error:.1e}", model.events,
              f"{np.median(seconds):.3g}", sep="\t", flush=True)


def main():
    for model in StateVariable(), Stribeck():
        measure(model, float(sys.argv[1]), [float(tol) for tol in sys.argv[2:]])


if __name__ == "__main__":
    main()
