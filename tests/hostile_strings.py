#!/usr/bin/env python3
"""hostile_strings.py COUNT SEED: draw so many made-up strings from every place where text comes from.

Each string is written as the name or unit of a column, a note, a title, a scene's or a file's name,
as text, delimited text, AU, HDF5 and sweep; each becomes a script.  One gnuplot draws all scripts as
SVG.  A string that is run as a command makes a file, and that is looked for; gnuplot must not complain;
each picture must be XML; a title must be in it as it was given."""
import math
import os
import random
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

VARIABLES = ("title label1 label2 x_label y_label signal_label line_label colour colours fine font width "
             "height from to drawn span step levels fmin fmax left bottom panel cone_colour noise ridge_colour row").split()
CANARY = "touch pwned"
PIECES = [f"system('{CANARY}')", f'system "{CANARY}"', f"`{CANARY}`", f"$({CANARY})", f"; !{CANARY}\n",
          f"| {CANARY}", f"'.system('{CANARY}').'", f'".system("{CANARY}")."', "'", '"', "''", '""', "\\",
          "\\\\", "\\n", "\\047", "\\042", "\n", "\r", "\t", "@", "@@", "%", "%s%n%d", "#", "EOD", "\nEOD\n",
          "$panel1", "$region0 << EOD", "{/*9 x}", "x_{y}", "^{2}", "~a{.8-}", "&{space}", "\\U+FFFF",
          "{\\265}", "]]>", "<!--", "&#0;", "</svg>", "&amp;", ";", ",", ":", "=", "ä", "µ", "Ω²", "漢字",
          "\uffff", "\ufffe", "\x01", "\x7f", "\u0085", "\U0001f600", "\u202e", "a", "t", "x", "m/s^2", " "]
PIECES = [p.encode() for p in PIECES] + [b"@" + v.encode() for v in VARIABLES] + [
    b"\xff", b"\xc3", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"\xc0\xa7", b"\x80", b"\xe4"]
ROWS = 24
failures = []


def hostile(rng):
    """A string of bytes without a NUL, which no argument and no line has."""
    if rng.random() < 0.2:
        return bytes(rng.randrange(1, 256) for _ in range(rng.randrange(1, 40)))
    return b"".join(rng.choice(PIECES) for _ in range(rng.randrange(1, 9)))


def line(text):
    return text.replace(b"\n", b" ").replace(b"\r", b" ")


def name(text):
    """As one field of a line of columns."""
    return b"_".join(line(text).replace(b"/", b"|").split()) or b"_"


def run(*command, stdin=None):
    done = subprocess.run(command, input=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode < 0:
        failures.append(f"{command}: signal {-done.returncode}")
    return done.stdout if done.returncode == 0 else None


def rows(columns, clock=False, comma=b"\t"):
    return b"".join((b"%.2f" % (i / 100) + comma if clock else b"") + comma.join(b"%.4f" % math.sin(i * (c + 1)) for c in range(columns))
                    + b"\n" for i in range(ROWS))


def stream(strings):
    names = [name(s) + b"/(" + name(u).strip(b"()") + b")" for s, u in zip(strings[2::2], strings[3::2])]
    return (b"# stickslip signal 1\n# scene: " + line(strings[0]) + b"\n# " + name(strings[1]) + b": "
            + line(strings[1]) + b"\n# rate: 100\n# columns: " + b" ".join(names) + b"\n" + rows(len(names)))


def from_stream(strings):
    return run("ss-plot", stdin=stream(strings))


def from_xy(strings):
    return run("ss-plot", "--xy", "1,2", stdin=stream(strings))


def from_spectrum(strings):
    return run("ss-plot", "--spectrum", "--db", stdin=stream(strings))


def from_recording(strings):
    with open("signal.tsv", "wb") as out:
        out.write(stream(strings))
    return run("ss-contour", "--column", "1", "--fmin", "20", "signal.tsv")


def from_au(strings):
    return run("ss-plot", stdin=run("ss-cat", "--format", "au", stdin=stream(strings)) or b"")


def from_hdf5(strings):
    run("ss-cat", "-o", "in.h5", stdin=stream(strings))
    script = run("ss-plot", "in.h5")
    if os.path.exists("in.h5"):
        os.remove("in.h5")
    return script


def quoted(text):
    return b'"' + line(text).replace(b'"', b'""') + b'"'


def from_csv(strings):
    head = b"time (s)," + b",".join(quoted(s) for s in strings) + b"\n"
    return run("ss-plot", stdin=head + rows(len(strings), True, b","))


def from_contour(strings):
    with open("signal.tsv", "wb") as out:
        out.write(stream(strings))
    grid = run("ss-morlet", "--column", "1", "--voices", "1", "--force", "--center", "2", "signal.tsv")
    with open("events.tsv", "wb") as out:
        out.write(b"# stickslip events 1\n# " + line(strings[2]) + b"\n0.05\t" + line(strings[3]) + b"\n")
    with open("features.tsv", "wb") as out:
        out.write(b"# stickslip features 1\n# " + line(strings[4]) + b"\n# spike: 0.1 jump "
                  + line(strings[5]) + b"\n0.05\t0.1\t1\t0.06\t9\t" + line(strings[0]) + b"\n")
    return run("ss-contour", "--signal", "signal.tsv", "--column", "1", "--events", "events.tsv",
               "--features", "features.tsv", "--fill", "--ridge", "--fmax", "20", stdin=grid or b"")


def from_map(strings):
    names = [b"|".join(name(s).split(b",")) + b"%d" % i for i, s in enumerate(strings[1:5])]
    units = [b"/(" + name(strings[5]).strip(b"()") + b")", b"", b"", b"/m"]
    grid = b"".join(b"%d\t%d\t%d\t%.3f\tok\n" % (x, y, x > y, math.hypot(x, 2.3 * y))
                    for x in range(4) for y in range(4))
    head = (b"# stickslip sweep 1\n# scene: " + line(strings[0]) + b"\n# columns: "
            + b" ".join(n + u for n, u in zip(names, units)) + b" status\n")
    return run("ss-plot", "--map", b",".join(names), stdin=head + grid)


def from_scene(strings):
    file = line(strings[0]).replace(b"/", b"|").decode("latin-1").encode()[:200] + b".scene"
    with open(b"./" + file, "wb") as out:
        out.write(b"# " + line(strings[1]) + b"\nmodel=coulomb\nmass=1\nstiffness=1e3\nfriction=0\n"
                  b"base_amplitude=1e-3\nbase_frequency=2.5\nx0=-1\nduration=0.1\n")
    script = run("ss-plot", stdin=run("ss-sim", b"./" + file) or b"")
    os.remove(b"./" + file)
    return script


def from_file(strings):
    """The picture's own name, which gnuplot does not learn, and the input's."""
    files = [b"./" + s.replace(b"/", b"|")[:200] for s in strings[:2]]
    files = [files[0] + b".in", files[1] + b".svg"]
    with open(files[0], "wb") as out:
        out.write(stream(strings))
    if run("ss-plot", "-c", "1", files[0], "-o", files[1]) is not None:
        check_picture(files[1], None)
    script = run("ss-plot", files[0])
    for file in files:
        if os.path.exists(file):
            os.remove(file)
    return script


def drawn_as(text):
    """Text as the manual says that it is drawn."""
    text = text.replace(b"]]>", b"]] ")
    shown = ""
    while text:
        for n in (1, 2, 3, 4):
            try:
                character = text[:n].decode()
                break
            except UnicodeDecodeError:
                character, n = "\ufffd", 1 if n == 4 else n
        shown += " " if character in "\ufffe\uffff" or ord(character) < 32 or 127 <= ord(character) < 160 \
            else character
        text = text[n:] if character != "\ufffd" or text.startswith("\ufffd".encode()) else text[1:]
    return shown


def check_picture(file, title):
    try:
        root = ElementTree.parse(os.fsdecode(file)).getroot()
    except (ElementTree.ParseError, OSError) as error:
        failures.append(f"{file}: {error}")
        return
    if title is not None:
        texts = "".join("".join(e.itertext()) for e in root.iter("{http://www.w3.org/2000/svg}text"))
        if "".join(drawn_as(title).split()) not in "".join(texts.split()):      # a long one has two lines
            failures.append(f"{file}: no {drawn_as(title)!r}")


def main():
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    rng, used, scripts = random.Random(seed), 0, []
    places = [from_stream, from_xy, from_spectrum, from_recording, from_au, from_hdf5, from_csv, from_contour, from_map, from_scene,
              from_file]
    drawn = dict.fromkeys(places, 0)
    os.environ["GNUTERM"] = f"dumb; system '{CANARY}'"
    while used < count:
        place = places[len(scripts) % len(places)]
        strings = [hostile(rng) for _ in range(6)]
        script, title = place(strings), None
        if place is from_stream:
            title = strings[0]
            script = run("ss-plot", b"--title=" + title, stdin=stream(strings))
        drawn[place] += script is not None
        scripts.append((script, title))
        used += len(strings)
    del os.environ["GNUTERM"]
    with open("all.gp", "wb") as out:
        for i, (script, _) in enumerate(scripts):
            if script is not None:
                out.write(b"reset session\nset terminal svg\nset output 'all%d.svg'\n" % i + script)
    done = subprocess.run(["gnuplot", "-d", "all.gp"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    harmless = re.compile(rb"Warning: empty|iconv failed to convert degree sign|^$")    # flat; LC_ALL=C
    words = [w for w in done.stdout.splitlines() if not harmless.search(w)]
    if done.returncode != 0 or words:
        failures.append("gnuplot: " + b"\n".join(words).decode("utf-8", "backslashreplace")[:2000])
    for i, (script, title) in enumerate(scripts):
        if script is not None:
            check_picture(f"all{i}.svg", title)
            os.path.exists(f"all{i}.svg") and os.remove(f"all{i}.svg")
    for place, n in drawn.items():
        if 2 * n < len(scripts) // len(places):
            failures.append(f"{place.__name__}: only {n} of {len(scripts) // len(places)} were drawn")
    left = set(os.listdir(b".")) - {b"all.gp", b"signal.tsv", b"events.tsv", b"features.tsv"}
    if left:
        failures.append(f"files that nothing should have made: {sorted(left)}")
    print("\n".join(failures) if failures else f"{used} strings")


main()
