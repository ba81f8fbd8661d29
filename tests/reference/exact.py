#!/usr/bin/env python3
"""exact.py > exact.tsv: the paper's scenes with events, event to event in closed form, 40 digits.

Shares nothing with the library but the scenes' parameters, as doubles.  Within a mode the motion is
Re(P e^{i W t}) - f0/k + Re(K e^{r (t - t0)}).  A mode's guard is scanned in steps of 1/200 of the
fastest period; where it falls at one end of a step and rises at the other, its minimum is found by
bisection of its slope; where it has changed sign, the crossing by bisection to 1e-36 s."""
from mpmath import exp, floor, mp, mpc, mpf, nstr, pi, sqrt, __version__

mp.dps = 40
M, K, F, Z, HZ = (mpf(x) for x in (2.42, 2310.0, 1.28, 0.0006, 2.5))
W = 2 * pi * HZ
SCENES = {"coulomb": None, "compliant-heavy": (mpf(209900), mpf(80)),
          "compliant-light": (mpf(209900), mpf(25))}
END = 10
RATE, STRIDE = 2000, 99             # samples of a 2 kHz record: 99 shares no period with the base


def base(t):
    """e^{i W t}"""
    cycles = HZ * t
    return exp(2j * pi * (cycles - floor(cycles)))


class Mode:
    """m q'' + c q' + k q = k_spring Z cos(W t) - f0 from t0 on, x = ref + q; rest: q' = 0."""

    def __init__(self, t0, q, v, sign, k=K, c=mpf(0), f0=mpf(0), ref=mpf(0), rest=False, contact=0):
        self.t0, self.sign, self.k, self.c, self.f0, self.ref = t0, sign, k, c, f0, ref
        self.rest, self.q0, self.contact = rest, q, contact
        s = c / (2 * M)
        w = sqrt(k / M - s * s)
        self.r = mpc(-s, w)
        self.P = K * Z / mpc(k - M * W * W, c * W)
        p = self.P * base(t0)
        a, b = q - p.real + f0 / k, v - (1j * W * p).real
        self.K = mpc(a, -(b + s * a) / w)
        self.step = 2 * pi / max(w, W) / 200

    def at(self, t):
        """q, q', q''"""
        if self.rest:
            return self.q0, mpf(0), mpf(0)
        p, free = self.P * base(t), self.K * exp(self.r * (t - self.t0))
        return ((p + free).real - self.f0 / self.k, (1j * W * p + self.r * free).real,
                (-W * W * p + self.r**2 * free).real)

    def guard(self, t):
        """Not negative within the mode, and its slope."""
        q, v, a = self.at(t)
        if self.sign:
            return self.sign * v, self.sign * a
        if self.rest:
            e = base(t)
            force, rate = K * (Z * e.real - q), -K * Z * W * e.imag
        else:
            force, rate = self.contact * q, self.contact * v
        return F - abs(force), -rate if force > 0 else rate

    def end(self):
        left, was = self.t0, self.guard(self.t0)
        while left < END:
            right = left + self.step
            now = self.guard(right)
            low = right
            if now[0] >= 0 and was[1] < 0 < now[1] and left > self.t0:
                a, low = left, right
                while low - a > mpf(10)**-20:
                    mid = (a + low) / 2
                    a, low = (mid, low) if self.guard(mid)[1] < 0 else (a, mid)
            if self.guard(low)[0] < 0:
                while low - left > mpf(10)**-36:
                    mid = (left + low) / 2
                    left, low = (left, mid) if self.guard(mid)[0] < 0 else (mid, low)
                return low
            left, was = right, now
        return mpf(END)


def slip(t, x, v, sign):
    return Mode(t, x, v, sign, f0=sign * F)


def stop(t, x, sign, contact):
    """What follows when v has reached 0, coming from sign; and the event's kind and direction."""
    if contact is None:
        force = K * (Z * base(t).real - x)
        if abs(force) > F:
            way = 1 if force > 0 else -1
            return slip(t, x, mpf(0), way), "reverse", way
        return Mode(t, x, mpf(0), 0, rest=True), "stick", sign
    y = sign * F / contact[0]
    return (Mode(t, y, mpf(0), 0, k=K + contact[0], c=contact[1], f0=K * (x - y), ref=x - y,
                 contact=contact[0]), "stick", sign)


def release(mode, t, q, v):
    if mode.rest:
        v, way = mpf(0), K * (Z * base(t).real - q)
    else:
        way = v
    sign = 1 if way > 0 else -1
    return slip(t, mode.ref + q, v, sign), "slip", sign


def number(x):
    return nstr(x, 25, strip_zeros=False, min_fixed=-30, max_fixed=30)


def run(name, contact):
    first, kind, sign = stop(mpf(0), mpf(0), 0, contact)
    modes = [first]
    if kind == "reverse":               # a start in slip is an event
        print(name, "slip", sign, number(mpf(0)), number(mpf(0)), number(mpf(0)), "-", sep="\t")
    while True:
        mode = modes[-1]
        t = mode.end()
        if t >= END:
            break
        q, v, _ = mode.at(t)
        new, kind, sign = (stop(t, mode.ref + q, mode.sign, contact) if mode.sign
                           else release(mode, t, q, v))
        if mode.sign:
            v = mpf(0)
        print(name, kind, sign, number(t), number(mode.ref + q), number(v), "-", sep="\t")
        modes.append(new)
    for n in range(1, END * RATE, STRIDE):
        t = mpf(n) / RATE
        mode = next(m for m in reversed(modes) if m.t0 <= t)
        assert all(abs(m.t0 - t) > mpf(10)**-9 for m in modes)
        q, v, a = mode.at(t)
        print(name, "sample", mode.sign, number(t), number(mode.ref + q), number(v), number(a),
              sep="\t")


print("# Events and samples of the paper's scenes, from rest, settle = 0,", END, "s, release spring.")
print("# Made by tests/reference/exact.py with mpmath", __version__, "at 40 digits; 25 are given.")
print("# Samples are at", STRIDE, "n + 1 of the record at", RATE, "Hz; direction is there the mode.")
print("# scene", "kind", "direction", "t/s", "x/m", "v/(m/s)", "a/(m/s^2)", sep="\t")
for scene, parameters in SCENES.items():
    run(scene, parameters)
