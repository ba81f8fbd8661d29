#!/usr/bin/env python3
"""mutate.py -- how many small errors in src the tests see.

Draws COUNT mutants of src by SEED: an operator that becomes another, a constant that is changed, a statement that is
left out.  First each test runs once with gcov, which says what lines it runs.  Then each mutant is compiled, and the
tests that run its line follow, those first that are cheap, run little else and killed others of its file, until one fails:
then it is dead.  (A line that is no code of its own, such as a #define, is run by all that run its file, or of a header
its folder.)  A mutant that the compiler makes the same object of is no mutant.  This is done in rounds: quick tests and a
little patience with all mutants, then longer tests with what is left.

Writes a row a mutant (what, by which test, file, line, the line before and after), and their sums.  Mutants that change
no result are in equivalent.tsv beside this file: file, line before, line after, the reason.

    python3 tests/mutation/mutate.py --seed 1 --count 300 --scratch /tmp/mutants > mutants.tsv

What lies in SCRATCH is made once: covered, mutants (trees), and, of one seed, map.json and judged.json; a run that was stopped goes on.
"""
import argparse
import collections
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]

ROUNDS = (4, 5), (30, 12), (150, 60)     # s of a processor that a test may take, and that a mutant may
OPERATORS = {
    "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&",
    "+": "-", "-": "+", "*": "/", "/": "*", "+=": "-=", "-=": "+=", "++": "--", "--": "++",
}
TOKEN = re.compile(
    r"""(?P<text>"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*')|(?P<number>\b(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\b(?![xX\w]))"""
    r"""|(?P<word>\w+)|(?P<operator><<=?|>>=?|->|[-+*/%&|^]=|\+\+|--|[<>=!]=|&&|\|\||[-+*/<>])""")
STATEMENT = re.compile(r"^ +(?! |return|break|continue|goto|case|default|else|if|for|while|do\b|switch|static|const\b|struct|enum"
                       r"|typedef|extern|double |int |size_t |char |void |ss_\w+ \**\w+[ ,;=]|h\w+_t \**\w+ =)"
                       r"[^{}]*[-+)\w\]]\s*;\s*$")


def blank_comments(text):
    """Comments become blanks, so that places stay."""
    return re.sub(r"/\*.*?\*/|//[^\n]*", lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S)


def mutants_of(line):
    """All changed forms of a line of code."""
    if STATEMENT.match(line) and line.count("(") == line.count(")"):
        yield re.match(r" *", line).group() + ";"
    before = None
    for m in TOKEN.finditer(line):
        new, old = None, m.group()
        if m.lastgroup == "number":
            new = str(int(old) + 1) if old.isdigit() else repr(float(old) * 1.5)
        elif m.lastgroup == "operator" and old in OPERATORS:
            spaced = line[m.start() - 1:m.start()] == " " and line[m.end():m.end() + 1] == " "
            if old in ("++", "--") or (spaced and before is not None):   # not of a type, nor of one operand
                new = OPERATORS[old]
        if new is not None:
            yield line[:m.start()] + new + line[m.end():]
        before = m
    if m := re.match(r"^( *(?:if|while) \()(.*)(\)(?: \{)?)$", line):
        if line.count("(") == line.count(")"):
            yield f"{m[1]}!({m[2]}){m[3]}"


def draw(seed, count, folders):
    """Mutants in a drawn order, more than are asked for, as some do not compile: (file, line number, new line)."""
    all_of = []
    for file in sorted(p for folder in folders for p in (ROOT / "src" / folder).rglob("*.[ch]")):
        code = blank_comments(file.read_text()).split("\n")
        for number, line in enumerate(code):
            if line.strip() and (not line.startswith("#") or re.match(r"#define \w+ +[-(]?[\d.]", line)):
                name = str(file.relative_to(ROOT))
                all_of += [(name, number, new) for new in mutants_of(line)]
    random.Random(seed).shuffle(all_of)
    return all_of


class Tree:
    """A copy of what is committed, with its programs, and the tests there."""

    def __init__(self, where, cflags, ldflags="", san=""):
        self.where, self.new = pathlib.Path(where).resolve(), not os.path.exists(where)
        if self.new:
            self.where.mkdir(parents=True)
            archive = subprocess.run(["git", "-C", ROOT, "archive", "HEAD"], check=True, stdout=subprocess.PIPE).stdout
            subprocess.run(["tar", "x", "-C", self.where], check=True, input=archive)
        work = self.where / "work"
        work.mkdir(exist_ok=True)
        self.env = dict(os.environ, SRC=str(self.where), BUILD=str(self.where / "build"), WORK=str(work), HOME=str(work), LC_ALL="C",
                        CMOCKA_TEST_ABORT="1", LIMIT="300", CC="gcc", CCLD=f"gcc {cflags} {ldflags}", MAKE="make", SAN=san, INCLUDES="", TOOL_PARTS="",
                        PATH=f"{self.where}/build/bin:{os.environ['PATH']}")
        if san:                 # more addresses than ulimit -v may bound
            self.env["ASAN_OPTIONS"] = "detect_stack_use_after_return=1:detect_leaks=1:hard_rss_limit_mb=8000"
            self.env["UBSAN_OPTIONS"] = "halt_on_error=1"
        self.memory = ":" if san else "ulimit -v 16000000"
        self.link = ["gcc", "-fuse-ld=gold", *ldflags.split(), *(("-fsanitize=address,undefined",) if san else ()), "-o"]
        self.make = ["make", "-s", "BUILD=build", "SAN=" + san, "INSTALL_DEPS=0", "CFLAGS=" + cflags, "LDFLAGS=" + ldflags]
        self.env["LIBS"], self.flags = self.words("$(LIBS)"), self.words("$(ALL_CFLAGS)").split()
        self.programs = self.words("$(TESTS)").split()
        self.tests = self.programs + sorted(str(p.relative_to(self.where / "tests").with_suffix(""))
                                            for p in self.where.glob("tests/cli/*/*.sh") if p.parent.name not in ("manual", "hostile", "report", "trade", "plot"))

    def words(self, what):
        return subprocess.run([*self.make, "--eval", f"print:; @echo '{what}'", "print"], cwd=self.where, check=True,
                              stdout=subprocess.PIPE, text=True).stdout.strip()

    def run(self, test, limit=120):
        """Does it pass?  And the seconds that it took of a processor."""
        began = resource.getrusage(resource.RUSAGE_CHILDREN)
        shutil.rmtree(self.where / "work" / test.replace("/", "-"), ignore_errors=True)
        limits = f"ulimit -f 2000000; {self.memory}; ulimit -t {limit}; exec sh tests/run.sh --one "
        done = subprocess.run(["sh", "-c", limits + test], cwd=self.where, env=self.env, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, errors="replace")
        ended = resource.getrusage(resource.RUSAGE_CHILDREN)
        return (done.returncode == 0 and not done.stdout.startswith("FAIL"),
                ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime)


def cover(scratch, jobs, limit, wanted):
    """Write a row a test of at most so many seconds: its time, the number of lines of src that it runs, those of wanted (0:
    any of the file), and those of wanted that are code."""
    tree, stored = Tree(scratch / "covered", "-O1 -g --coverage", "--coverage"), scratch / "map.json"
    known = {row[0]: row[1] or row[2] == 0 or row[2] >= limit - 1 for row in
             map(json.loads, stored.read_text().splitlines() if stored.exists() else ())}
    if tree.new:
        subprocess.run([*tree.make, f"-j{jobs}", "all", *("build/tests/" + p for p in tree.programs)], cwd=tree.where, check=True)
    sources = {f for f in wanted if f.endswith(".c")}
    for header in wanted.keys() - sources:      # and what has the headers among them, five of each
        sources.update([f for f in map(lambda p: str(p.relative_to(tree.where / "build"))[:-1] + "c",
                                       sorted((tree.where / "build/src").rglob("*.d")))
                        if header in (tree.where / "build" / (f[:-1] + "d")).read_text()][:5])
    for test in tree.tests:
        if known.get(test):
            continue
        for old in (tree.where / "build").rglob("*.gcda"):
            old.unlink()
        passed, seconds = tree.run(test, limit)
        if not passed and seconds < limit - 1:
            seconds = 0         # it fails without a mutant
        text, size, ran, code = "", 0, collections.defaultdict(set), collections.defaultdict(set)
        counts = [f"build/{f[:-1]}gcda" for f in sources if (tree.where / f"build/{f[:-1]}gcda").exists()]
        if passed and counts:
            text = subprocess.run(["gcov", "--stdout", "--json-format", *counts], cwd=tree.where, stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL).stdout.decode()
        for of in (of for part in text.splitlines() for of in json.loads(part)["files"]):
            file, lines = of["file"], {line["line_number"] for line in of["lines"] if line["count"] > 0}
            size += len(lines)
            if file in wanted:
                code[file].update(wanted[file] & {line["line_number"] for line in of["lines"]})
                ran[file].update(wanted[file] & lines, (0,) if lines else ())
        with stored.open("a") as out:
            print(json.dumps([test, passed, seconds, size, *({f: sorted(n) for f, n in of.items()} for of in (ran, code))]), file=out)


class Judge:
    """Runs the tests of a mutant's line until one fails that passes without the mutant."""

    def __init__(self, tree, jobs):
        self.tree, self.kills, self.fine = tree, {}, set()
        self.library = "build/libmutant.so"
        self.wrapped = ["-Wl,--wrap=" + w for w in tree.words("$(WRAPPED)").split()]
        if tree.new:            # an archiver that links: programs then find the library by its path
            link = tree.where / "link.sh"
            link.write_text('#!/bin/sh\nshift\nout=$1\nshift\nexec %s "$PWD/$out" -shared -Wl,-soname,"$PWD/$out" "$@" $LIBS\n'
                            % " ".join(tree.link))
            link.chmod(0o755)
            subprocess.run([*tree.make, f"-j{jobs}", "AR=./link.sh", "STATIC=" + self.library, "all",
                            *("build/tests/" + p for p in tree.programs)], cwd=tree.where, env=tree.env, check=True)
            for shared in (tree.where / "build").glob("libstickslip.so.*.*"):
                shared.unlink()
                shared.symlink_to("libmutant.so")
        self.objects = sorted(str(p.relative_to(tree.where)) for p in (tree.where / "build/src").rglob("*.o")) + ["build/scenes.o"]

    def read(self, coverage):
        self.lines, self.code, self.took, self.size, self.linked = {}, collections.defaultdict(set), {}, {}, {}
        for test, passed, self.took[test], self.size[test], ran, code in map(json.loads, coverage.read_text().splitlines()):
            if passed:
                self.lines[test] = ran
                for file, n in code.items():
                    self.code[file].update(n)
            elif self.took[test] > 0 and "/" not in test:       # too long to be mapped: it may run all that it is linked of
                self.lines[test], self.took[test], self.size[test] = {}, 2 * self.took[test], 5000
                self.linked[test] = self.objects_in(coverage.parent / "covered", test)

    def remember(self, killed):
        """By what test mutants of what files died."""
        self.kills = collections.Counter(key for file, test in killed for key in ((file.split("/")[1], test), (file, test)))

    @staticmethod
    def objects_in(tree, test):
        """The files of src in a program that is linked with the archive."""
        def names(what):
            rows = subprocess.run(["nm", "-A", "--defined-only", *what], cwd=tree, check=True, stdout=subprocess.PIPE, text=True).stdout
            return [row.rsplit(" ", 2) for row in rows.splitlines()]
        def is_ours(kind, name):    # names of the library are local in a program
            return kind.upper() in "TDBRIW" and name.startswith("ss_")
        has = {name for _, kind, name in names([f"build/tests/{test}"]) if is_ours(kind, name)}
        objects = [str(p.relative_to(tree)) for p in (tree / "build/src").rglob("*.o")]
        return {where.split(":")[0].removeprefix("build/")[:-1] + "c" for where, kind, name in names(objects)
                if is_ours(kind, name) and name in has}

    def link_for(self, test):
        """The library; test_memory replaces its allocations, and so has it within."""
        outputs = [[self.library, "-shared", f"-Wl,-soname,{self.tree.where}/{self.library}"]]
        if test == "test_memory":
            outputs.append([f"build/tests/{test}", f"build/tests/{test}.o", "-lcmocka", *self.wrapped])
        for what in outputs:
            subprocess.run([*self.tree.link, *what, *self.objects, *self.tree.env["LIBS"].split()], cwd=self.tree.where, check=True)

    def put_back(self, objects):
        for o, text in objects.items():
            (self.tree.where / o).write_bytes(text)

    def compile(self, file):
        """Make again what has the file: whether that worked, and the objects that differ, as they were."""
        objects = ["build/" + file[:-1] + "o"]
        if not file.endswith(".c"):
            objects = [o for o in self.objects if file in (self.tree.where / (o[:-1] + "d")).read_text().split()]
        was = {o: (self.tree.where / o).read_bytes() for o in objects}
        built = all(subprocess.run(["gcc", *self.tree.flags, "-w", "-Ibuild", "-c", "-o", o, o.removeprefix("build/")[:-1] + "c"],
                                   cwd=self.tree.where, stderr=subprocess.DEVNULL).returncode == 0 for o in objects)
        changed = {o: old for o, old in was.items() if not built or (self.tree.where / o).read_bytes() != old}
        return built, changed

    def passes_without(self, test):
        """Does the test pass with the objects of now, as it did when it was mapped?"""
        self.link_for(test)
        if self.tree.run(test, int(20 + 8 * self.took[test]))[0]:
            self.fine.add(test)
        return test in self.fine

    def order(self, file, number):
        """The tests that run the line, the best first."""
        folder = file.split("/")[1]
        if number in self.code.get(file, ()):
            runs = [t for t in self.lines if number in self.lines[t].get(file, ()) or file in self.linked.get(t, ())]
        elif file in self.code:
            runs = [t for t in self.lines if self.lines[t].get(file) or file in self.linked.get(t, ())]
        else:
            runs = [t for t in self.lines if any(f.startswith(f"src/{folder}/") and n for f, n in self.lines[t].items())]
        return sorted(runs, key=lambda t: (self.took[t] + .2) * self.size[t] ** .5
                      / (1 + self.kills[folder, t] + 8 * self.kills[file, t]))

    def judge(self, mutant, met, limit, patience):
        """dead, alive or no program; the test; the line before; the tests that it has met are added.  No test is run of more
        seconds than limit."""
        file, number, new = mutant
        path = self.tree.where / file
        text = path.read_text()
        lines = text.split("\n")
        old, lines[number] = lines[number], new
        path.write_text("\n".join(lines))
        built, changed = self.compile(file)
        path.write_text(text)
        if not changed or not built:
            self.put_back(changed)
            return "no change" if built else "no program", "", old
        what, by, spent = "alive", "", 0
        left = [t for t in self.order(file, number + 1) if t not in met]
        tests = [t for t in left if self.took[t] <= limit]
        mutated = {o: (self.tree.where / o).read_bytes() for o in changed}
        try:                    # whatever ends this, the objects are then those of src
            for i, test in enumerate(tests):
                if spent > patience:
                    break
                if i == 0 or test == "test_memory":
                    self.link_for(test)
                passed, seconds = self.tree.run(test, int(6 + 4 * self.took[test]))
                spent += seconds
                met.append(test)
                if passed:
                    continue
                self.put_back(changed)
                if test in self.fine or self.passes_without(test):
                    what, by = "dead", test
                    break
                self.put_back(mutated)
                self.link_for(test)
        finally:
            self.put_back(changed)
        if what == "alive" and (n := len([t for t in left if t not in met])) > 0:
            by = f"{n} tests are left"
        return what, by, old


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--jobs", type=int, default=1, help="processes that compile the trees")
    parser.add_argument("--minutes", type=float, default=90, help="no mutant is begun later")
    parser.add_argument("--scratch", type=pathlib.Path, required=True, help="a folder for the trees")
    parser.add_argument("--san", default="", choices=["1"], help="1: with sanitizers, too, what lives without")
    parser.add_argument("--folder", action="append", help="of src; all if none is given")
    args = parser.parse_args()
    end = time.monotonic() + 60 * args.minutes
    folders = args.folder or sorted(p.name for p in (ROOT / "src").iterdir())
    known = {}
    for row in (ROOT / "tests/mutation/equivalent.tsv").read_text().splitlines()[1:]:
        file, old, new, reason = row.split("\t")
        known[file, old, new] = reason
    mutants, scratch = draw(args.seed, args.count, folders), args.scratch.resolve()
    scratch.mkdir(parents=True, exist_ok=True)
    wanted = collections.defaultdict(set)
    for file, number, _ in mutants[:2 * args.count]:
        wanted[file].add(number + 1)
    stored = scratch / "judged.json"
    judged = {(row := json.loads(text))[0]: row for text in (stored.read_text().splitlines() if stored.exists() else ())}
    judges = []
    for limit, patience in ROUNDS:
        cover(scratch, args.jobs, limit, wanted)
        judges = judges or [Judge(Tree(scratch / ("mutants" + san), "-O1 -fvisibility=default", san=san), args.jobs)
                            for san in ("", "1") if san <= args.san]
        for judge in judges:
            judge.read(scratch / "map.json")
        sums = collections.Counter()
        for i, mutant in enumerate(mutants):
            if sums["dead"] + sums["alive"] >= args.count or time.monotonic() > end:
                break
            _, what, by, old, met, of = judged.get(i, (i, "alive", "", "", [], 0))
            if what == "alive" and of < limit and (of == 0 or (mutant[0], old.strip(), mutant[2].strip()) not in known):
                for judge in judges:
                    judge.remember((mutants[k][0], by) for k, what, by, *_ in judged.values() if what == "dead")
                    what, by, old = judge.judge(mutant, met, limit, patience)
                    if what != "alive":
                        break
                judged[i] = i, what, by, old, met, limit
                with stored.open("a") as out:
                    print(json.dumps(judged[i]), file=out)
            sums[what] += 1
    sums = collections.Counter()
    for i, what, by, old, met, _ in sorted(judged.values()):
        file, number, new = mutants[i]
        old, new = old.strip(), new.strip()
        if what == "alive" and (file, old, new) in known:
            what, by = "the same", known[file, old, new]
        sums[what] += 1
        if not what.startswith("no "):
            print(what, by, file, number + 1, old, new, sep="\t")
    print(f"{sums['no program']} did not compile, of {sums['no change']} the compiler makes the same", file=sys.stderr)
    n = sums["dead"] + sums["alive"] + sums["the same"]
    print(f"{n} mutants of seed {args.seed}: {sums['dead']} dead ({100 * sums['dead'] / max(n, 1):.1f} %),"
          f" {sums['the same']} change no result, {sums['alive']} alive", file=sys.stderr)


main()
