#!/usr/bin/env python3
"""stiff.py > stiff.tsv: the state-variable scene far from the paper's alpha and gamma, by SciPy's Radau.

Shares nothing with the library but the scene's parameters, as doubles.  x is in units of Z_e, v of
Z_e Omega, theta of f_k, so that one tolerance serves all.  A step from one side of the front of tanh
to the other would miss it: the integration ends wherever v = 0 and begins anew with a tiny step."""
import numpy as np
from scipy import __version__
from scipy.integrate import solve_ivp

M, K, F, Z, HZ = 2.42, 2310.0, 1.28, 0.0006, 2.5
W = 2 * np.pi * HZ
V = Z * W
PAST = 1e-7
END, SAMPLES = 1.0, (0.25, 0.5, 0.75, 1.0)
GRID = ((1e0, 1e-3), (1e0, 1e9), (1e3, 1e5), (1e3, 1e9), (1e6, 1e-3), (1e6, 1e3), (1e6, 1e6), (1e6, 1e9),
        (1e9, 1e-3), (1e9, 1e1), (1e9, 1e7), (1e9, 1e9))


def solve(alpha, gamma, rtol):
    def rhs(t, q):
        return (W * q[1], (K * Z * (np.cos(W * t) - q[0]) - F * q[2]) / (M * V),
                -gamma * (q[2] - np.tanh(alpha * V * q[1])))

    def jac(t, q):
        sech2 = 1 / np.cosh(min(abs(alpha * V * q[1]), 300.)) ** 2
        return np.array([[0, W, 0], [-K * Z / (M * V), 0, -F / (M * V)],
                         [0, gamma * alpha * V * sech2, -gamma]])

    def front(t, q):
        return q[1]
    front.terminal = True
    t, q, out = 0.0, np.zeros(3), {}
    while t < END:
        r = solve_ivp(rhs, (t, END), q, "Radau", jac=jac, rtol=rtol, atol=rtol * 1e-2, events=front,
                      max_step=2e-3, first_step=min(1e-12, (END - t) / 2),
                      t_eval=sorted({s for s in SAMPLES if s > t}))
        if len(r.t) > 0:
            out.update(zip(r.t, r.y[0]))
        if r.status != 1:
            break
        t, q = r.t_events[0][0], r.y_events[0][0]
        r = solve_ivp(rhs, (t, t + PAST), q, "Radau", jac=jac, rtol=rtol, atol=rtol * 1e-2,
                      first_step=1e-13)     # past the zero that ended it
        t, q = t + PAST, r.y[:, -1]
    return out


print("# x of the state-variable scene, law scaled, from rest at t = 0, for other alpha and gamma.")
print("# Made by tests/reference/stiff.py with SciPy", __version__, "Radau at rtol 1e-10; error: the")
print("# change from rtol 1e-9.")
print("# alpha/(s/m)", "gamma/(1/s)", "t/s", "x/m", "error/m", sep="\t")
for a, g in GRID:
    fine, coarse = solve(a, g, 1e-10), solve(a, g, 1e-9)
    for s in SAMPLES:
        print("%g\t%g\t%g\t%.17g\t%.1e" % (a, g, s, Z * fine[s], Z * abs(fine[s] - coarse[s])), flush=True)
