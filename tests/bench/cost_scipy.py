#!/usr/bin/env python3
"""cost_scipy.py DURATION TOLERANCE ...: the paper's scenes with SciPy's solve_ivp and its events.

ss-sim must be in PATH: it makes the reference.  Written as SciPy's manual advises: one terminal event
function a mode, with its direction; samples by t_eval; absolute tolerances by the scale of each
state; a step cap in a Coulomb stick only, in which nothing moves.  Rows as in bench.h."""
import subprocess
import sys
import time

import numpy as np
from scipy.integrate import solve_ivp

M, K, F, Z, W, RATE = 2.42, 2310.0, 1.28, 0.0006, 2 * np.pi * 2.5, 2000
CONTACT = {"compliant-heavy": (209900.0, 80.0), "compliant-light": (209900.0, 25.0)}


def drive(t):
    return K * Z * np.cos(W * t)


def slip(sign):
    def rhs(t, q):
        return q[1], (drive(t) - K * q[0] - sign * F) / M

    def stops(t, q):
        return sign * q[1]
    return rhs, stops


def stick(x):
    def rhs(t, q):
        return 0.0, 0.0

    def releases(t, q):
        return F - abs(drive(t) - K * x)
    return rhs, releases


def microstick(contact, x, y):
    ky, c = contact

    def rhs(t, q):
        return q[1], (drive(t) - K * q[0] - ky * (y + q[0] - x) - c * q[1]) / M

    def releases(t, q):
        return F - ky * abs(y + q[0] - x)
    return rhs, releases


def state_variable(t, q):
    return (q[1], (drive(t) - K * q[0] - q[2]) / M,
            -100.0 * (q[2] - F * np.tanh(3000.0 * q[1])))


def with_events(scene, method, tol, t_eval):
    contact, mode, events, end = CONTACT.get(scene), 0, 0, t_eval[-1]
    x, v, t, out = 0.0, 0.0, 0.0, []
    if contact is None:
        mode, events = 1, 1             # k Z > f_k: it slips at once
        functions = slip(1)
    else:
        functions = microstick(contact, 0.0, 0.0)
    atol = (tol * Z, tol * Z * W)
    while True:
        rhs, event = functions
        event.terminal, event.direction = True, -1
        stuck = contact is None and mode == 0
        r = solve_ivp(rhs, (t, end), (x, v), method, t_eval=t_eval[(t_eval >= t)], events=event,
                      rtol=max(tol, 2.3e-14), atol=atol,
                      max_step=2 * np.pi / W / 40 if stuck else np.inf)
        if r.status < 0:
            raise RuntimeError(r.message)
        if len(r.t):
            out.append((r.t, r.y[0]))
        if r.status == 0:
            break
        events += 1
        t, (x, v) = r.t_events[0][-1], r.y_events[0][-1]
        if mode != 0 and contact is not None:
            functions, mode, v = microstick(contact, x, mode * F / contact[0]), 0, 0.0
        elif mode == 0:
            mode = 1 if (v if contact is not None else drive(t) - K * x) > 0 else -1
            functions = slip(mode)
        else:
            force, v = drive(t) - K * x, 0.0
            mode = 0 if abs(force) <= F else 1 if force > 0 else -1
            functions = slip(mode) if mode else stick(x)
    ts, xs = (np.concatenate(part) for part in zip(*out))
    _, last = np.unique(ts[::-1], return_index=True)    # a sample at an event is after it
    return xs[::-1][last], events


def smooth(method, tol, t_eval):
    r = solve_ivp(state_variable, (0, t_eval[-1]), (0.0, 0.0, 0.0), method, t_eval=t_eval,
                  rtol=max(tol, 2.3e-14), atol=(tol * Z, tol * Z * W, tol * F))
    return r.y[0], 0


def reference(scene, duration):
    how = ["--tol=1e-13"] if scene == "state-variable" else ["--method=exact"]
    text = subprocess.run(["ss-sim", "--columns=x", "--set=settle=0", f"--set=duration={duration}",
                           f"--set=rate={RATE}", *how, scene], check=True, capture_output=True).stdout
    return np.loadtxt(text.decode().splitlines())


def main():
    duration = float(sys.argv[1])
    t_eval = np.arange(round(duration * RATE)) / RATE
    for scene in (*CONTACT, "coulomb", "state-variable"):
        truth = reference(scene, duration)
        for method in ("RK45", "DOP853", "LSODA"):
            for tol in map(float, sys.argv[2:]):
                began = time.process_time()
                x, events = (smooth(method, tol, t_eval) if scene == "state-variable"
                             else with_events(scene, method, tol, t_eval))
                seconds = time.process_time() - began
                error = max(abs(x - truth)) / max(abs(truth)) if len(x) == len(truth) else np.nan
                print(scene, f"{duration:g}", f"SciPy {method}", f"{tol:.0e}", f"{error:.1e}", events,
                      f"{seconds:.3g}", sep="\t", flush=True)


if __name__ == "__main__":
    main()
