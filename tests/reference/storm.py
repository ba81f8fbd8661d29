#!/usr/bin/env python3
"""storm.py [DIGITS]: the events in the first 0.2 s of a contact of 1e10 N/m without damping.

By exact.py in other parameters and at DIGITS (40) digits: 331 events, at 25 digits too.  A mode in slip
may end within the first of the steps by which it is scanned; those of microstick are 1/16 period."""
import sys
from pathlib import Path

text = (Path(__file__).parent / "exact.py").read_text().split("    for n in range(1, END * RATE")[0]
for was, now in (("mp.dps = 40", "mp.dps = %s" % (sys.argv[1:] or [40])[0]), ("END = 10", "END = mpf('0.2')"),
                 ("/ 200", "/ (16 if contact else 200)"),
                 ("and left > self.t0", "and (left > self.t0 or was[0] > 0)")):
    assert was in text
    text = text.replace(was, now)
exec(text)
run("storm", (mpf(10)**10, mpf(0)))
