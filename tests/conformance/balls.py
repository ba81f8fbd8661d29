#!/usr/bin/env python3
"""balls.py [SCENE ...]: prove the rows of events.tsv and values.tsv of the scenes that are piecewise linear.

Between two events a motion is known in closed form.  It is evaluated in balls (python-flint, 2000 bits), which
hold the true number.  For each piece it is shown that no condition for its end is met before a time, and that one
is met within a ball about it, in which the next piece begins.  So no event is missed and none is false, and each
row is within the bounds of check.sh of the true motion, or the program says which is not.

It has no code of the library.  The times that it guesses are proved afterwards.
"""
import math
import os
import sys
from flint import arb, ctx

ctx.prec = 2000
NEAR = arb("1e-500")                # half the width of a ball about an event, at least [s]
HERE = os.path.dirname(os.path.abspath(__file__))
ZERO = arb(0)


def span(a, b):
    """The ball that holds all from a to b."""
    return a.union(b)


def tiny(x):
    """Is this the 0 of a condition that is met exactly where the piece begins?"""
    return x.contains(0) and abs(x) < arb("1e-20")


class Scene:
    def __init__(self, name):
        text = dict(line.split(" = ") for line in open(os.path.join(HERE, name + ".scene")).read().splitlines()
                    if " = " in line and not line.startswith("#"))
        self.compliant = text["model"] == "compliant"
        self.total = text.get("release") == "total"

        def number(key, otherwise=0.0):
            return arb(float(text.get(key, otherwise)))
        self.m, self.k, self.d = number("mass"), number("stiffness"), number("damping")
        f = number("friction")
        self.f = {1: f, -1: number("friction_negative", text["friction"])}
        self.most = {1: number("static_friction", text["friction"])}
        self.most[-1] = max(number("static_friction_negative", text.get("static_friction", 0)), self.f[-1],
                            key=lambda ball: float(ball.mid()))
        self.swing = self.k * number("base_amplitude")
        self.w, self.pull = 2 * arb.pi() * number("base_frequency"), self.k * number("base_velocity")
        self.K = {1: number("contact_stiffness"),
                  -1: number("contact_stiffness_negative", text.get("contact_stiffness", 0))}
        self.c, self.gap = number("contact_damping"), number("gap")
        self.alike = "gap" not in text and "contact_stiffness_negative" not in text
        self.x0, self.duration = number("x0"), float(text["duration"])

    def push(self, t, order=0):
        """The base's swing times k, or a derivative of it."""
        return self.swing * self.w ** order * (self.w * t + order * arb.pi() / 2).cos()


class Piece:
    """x = ref + q with m q'' + c q' + k q = swing - f + pull u, u = t - t0; or rest."""

    def __init__(self, s, t, mode, q, v, ref=ZERO, side=None, rest=False):
        self.s, self.t0, self.mode, self.q, self.v, self.ref, self.side, self.rest = s, t, mode, q, v, ref, side, rest
        on = side is not None and side != 0
        self.k = s.k + (s.K[side if side in (1, -1) else 1] if on else ZERO)
        self.c = s.d + (s.c if on else ZERO)
        self.f = (s.f[mode] * mode if mode else ZERO) + s.k * ref - s.pull * t
        k, c, m, w = self.k, self.c, s.m, s.w
        re, im = k - m * w * w, c * w
        size = re * re + im * im
        self.re, self.im = s.swing * re / size, -s.swing * im / size
        self.slope = s.pull / k
        self.level = -(self.f + c * self.slope) / k
        self.decay = c / (2 * m)
        self.turn = (k / m - self.decay * self.decay).sqrt()
        if not rest:
            steady, speed = self.steady(t, ZERO)
            self.A = q - steady
            self.B = v - speed + self.decay * self.A

    def steady(self, t, u):
        co, si = (self.s.w * t).cos(), (self.s.w * t).sin()
        return (self.re * co - self.im * si + self.level + self.slope * u,
                self.s.w * (-self.re * si - self.im * co) + self.slope)

    def at(self, t):
        """q and its derivatives to the third."""
        if self.rest:
            return [self.q, ZERO, ZERO, ZERO]
        u, s = t - self.t0, self.s
        fade, square = (-self.decay * u).exp(), self.turn * self.turn
        C, S = fade * (self.turn * u).cos(), fade * (self.turn * u).sin() / self.turn
        q, v = self.steady(t, u)
        q += self.A * C + self.B * S
        v += self.A * (-self.decay * C - square * S) + self.B * (C - self.decay * S)
        a = (s.push(t) - self.f + s.pull * u - self.k * q - self.c * v) / s.m
        j = (s.push(t, 1) + s.pull - self.k * v - self.c * a) / s.m
        return [q, v, a, j]

    def contact(self):
        return self.s.K[self.side if self.side in (1, -1) else 1]

    def conditions(self, t):
        """What is positive while the piece lasts: a list of [value, slope, curvature]."""
        s, q = self.s, self.at(t)
        if self.mode:
            return [[self.mode * q[i] for i in (1, 2, 3)]]
        if self.rest:
            load = [s.push(t) + s.pull * t - s.k * self.q, s.push(t, 1) + s.pull, s.push(t, 2)]
        elif self.side == 0:
            return [[s.gap - q[0], -q[1], -q[2]], [s.gap + q[0], q[1], q[2]]]
        else:
            damper = s.c if s.total else ZERO
            load = [self.contact() * q[i] + damper * q[i + 1] for i in range(3)]
        both = [[s.most[1] - load[0], -load[1], -load[2]], [s.most[-1] + load[0], load[1], load[2]]]
        if self.side in (1, -1):
            both.append([self.side * q[i] for i in range(3)])
        return both

    def force(self, t):
        if self.mode:
            return self.s.f[self.mode] * self.mode
        q = self.at(t)
        if self.rest:
            return self.s.push(t) + self.s.pull * t - self.s.k * self.q
        return self.contact() * q[0] + self.s.c * q[1] if self.side != 0 else ZERO


def holds(piece, i, a, b, depth=0):
    """Prove that condition i is met from a (the piece's begin, or where it is met) to b."""
    g = piece.conditions(span(a, b))[i]
    if g[0] > 0:
        return
    at_a, at_b = piece.conditions(a)[i], piece.conditions(b)[i]
    rises = at_a[0] > 0 or tiny(at_a[0])
    if (rises and g[1] > 0) or (at_b[0] > 0 and g[1] < 0):
        return
    if tiny(at_a[0]) and tiny(at_a[1]) and g[2] > 0:
        return
    if depth > 60:
        raise SystemExit(f"not proved: condition {i} at {float(a.mid())}, {float(b.mid())}")
    middle = arb(((a + b) / 2).mid())
    holds(piece, i, a, middle, depth + 1)
    holds(piece, i, middle, b, depth + 1)


def guess_end(piece, end):
    """The first time at which a condition fails, and which, by steps and bisection; proved afterwards."""
    fastest = float(piece.turn.mid()) if not piece.rest else 0
    step = 2 * math.pi / max(fastest, float(piece.s.w.mid()), 1e-3 / max(end, 1)) / 200
    t0 = float(piece.t0.mid())
    t, n = arb(piece.t0.mid()), 0
    while True:
        n += 1
        later = arb(t0 + n * step)
        failed = [i for i, g in enumerate(piece.conditions(later)) if g[0] < 0]
        if failed:
            lo, hi = t, later
            while float((hi - lo).mid()) > 0 and (hi - lo) > arb("1e-520"):
                middle = arb(((lo + hi) / 2).mid())
                if any(g[0] < 0 for g in piece.conditions(middle)):
                    hi = middle
                else:
                    lo = middle
            return hi, [i for i, g in enumerate(piece.conditions(hi)) if g[0] < 0][0]
        if later > end:
            return None, None
        t = later


def after(piece, i, t):
    """The piece that follows where condition i has failed, and the event, or None."""
    s, q = piece.s, piece.at(t)
    if piece.mode:
        way, x = piece.mode, q[0]
        if s.compliant:
            y = way * s.f[way] / s.K[way]
            return Piece(s, t, 0, y, ZERO, x - y, "alike" if s.alike else way), ("stick", way, x, ZERO)
        load = s.push(t) + s.pull * t - s.k * x
        for other in (1, -1):
            if other * load > s.most[other]:
                return Piece(s, t, other, x, ZERO), ("reverse", other, x, ZERO)
        if not (load < s.most[1] and -load < s.most[-1]):
            raise SystemExit("not proved: whether it sticks")
        return Piece(s, t, 0, x, ZERO, rest=True), ("stick", way, x, ZERO)
    x = piece.ref + q[0]
    if piece.side == 0 or (piece.side in (1, -1) and i == 2):
        to = (1 if i == 0 else -1) if piece.side == 0 else 0
        # y is counted from the edge of a side, and from the middle of the gap
        y = ZERO if to else piece.side * s.gap
        return Piece(s, t, 0, y, q[1], x - y, to), None
    way = 1 if i == 0 else -1
    v = ZERO if piece.rest else q[1]
    return Piece(s, t, way, x, v), ("slip", way, x, v)


def pieces_of(s):
    """Prove the motion from rest; yield each piece, the time of its end, and the event with which it begins."""
    t = ZERO
    load = s.push(t) - s.k * s.x0
    way = 1 if load > 0 else -1
    event = None
    if s.compliant:
        piece = Piece(s, t, 0, ZERO, ZERO, s.x0, "alike" if s.alike else 0 if s.gap > 0 else way)
    elif way * load > s.most[way]:
        piece, event = Piece(s, t, way, s.x0, ZERO), ("slip", way, s.x0, ZERO)
    else:
        piece = Piece(s, t, 0, s.x0, ZERO, rest=True)
    while True:
        end, which = guess_end(piece, s.duration)
        is_last, near = end is None or end > s.duration, NEAR
        while not is_last and not (piece.conditions(arb((end - near).mid()))[which][0] > 0
                                   and piece.conditions(arb((end + near).mid()))[which][0] < 0):
            near *= 2
        last = arb(s.duration) if is_last else end - near
        first = arb(piece.t0.mid())
        for i in range(len(piece.conditions(first))):
            holds(piece, i, piece.t0, arb(last.mid()))
        yield piece, event, last
        if is_last:
            return
        piece, event = after(piece, which, span(end - near, end + near))


def rows_of(name, table):
    for line in open(os.path.join(HERE, table)).read().splitlines()[1:]:
        word = line.split("\t")
        if word[0] == name:
            yield word[1:]


def check(name):
    s = Scene(name)
    events, values = list(rows_of(name, "events.tsv")), list(rows_of(name, "values.tsv"))
    size = [max(abs(float(r[c])) for r in rows) for rows, c in
            ((events, 3), (events, 4), (values, 1), (values, 2), (values, 3))]
    worst, seen, done, pieces = 0.0, 0, 0, 0

    def compare(what, ball, text, unit):
        nonlocal worst
        off = abs(ball - arb(float(text))) / arb(unit)
        if not off < arb("1e-10"):
            raise SystemExit(f"{name}: {what} {text} is not {ball}")
        worst = max(worst, float(off.upper()))
    for piece, event, end in pieces_of(s):
        pieces += 1
        if event is not None:
            row = events[seen]
            seen += 1
            if [event[0], str(event[1])] != row[1:3]:
                raise SystemExit(f"{name}: event {seen} is {event[0]} {event[1]}, not {row[1]} {row[2]}")
            compare("t", piece.t0, row[0], 1)
            compare("x", event[2], row[3], size[0])
            compare("v", event[3], row[4], size[1] or 1)
        while done < len(values) and arb(float(values[done][0])) <= end:
            t = arb(float(values[done][0]))
            q = piece.at(t)
            compare("x", piece.ref + q[0], values[done][1], size[2])
            compare("v", q[1], values[done][2], size[3])
            compare("f", piece.force(t), values[done][3], size[4])
            done += 1
    if seen != len(events) or done != len(values):
        raise SystemExit(f"{name}: {seen} of {len(events)} events, {done} of {len(values)} values")
    print(f"{name}: {pieces} pieces, {seen} events and {done} values proved, within {worst:.1e}", flush=True)


SMOOTH = ("state-variable", "falling", "lugre", "dahl")
for scene in sys.argv[1:] or sorted(f[:-6] for f in os.listdir(HERE) if f.endswith(".scene")):
    if not scene.endswith(SMOOTH):
        check(scene)
