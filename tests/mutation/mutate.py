#!/usr/bin/env python3
"""mutate.py -- how many small errors in src the tests see.

Draws COUNT mutants of src by SEED: an operator that becomes another, a constant that is changed, a statement that is
left out.  First each test runs once with gcov, which says what lines it runs.  Then each mutant is compiled, and the
tests that run its line follow, those first that are cheap and killed others of the folder, until one fails: then it is
dead.  (A line that is no code of its own, such as a #define, is run by all that run its file, or of a header its folder.)
A mutant that the compiler makes the same object of is no mutant.  Tests of a mutant that lives end after PATIENCE s.

Writes a row a mutant (what, by which test, file, line, the line before and after), and their sums.  Mutants that change
no result are in equivalent.tsv beside this file: file, line before, line after, the reason.

    python3 tests/mutation/mutate.py --seed 1 --count 300 --scratch /tmp/mutants > mutants.tsv

What lies in SCRATCH is made once: covered, mutants (trees) and map.json.
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
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]

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
                        CMOCKA_TEST_ABORT="1", CC="gcc", CCLD=f"gcc {cflags} {ldflags}", MAKE="make", SAN=san, INCLUDES="", TOOL_PARTS="",
                        PATH=f"{self.where}/build/bin:{os.environ['PATH']}")
        if san:                 # more addresses than ulimit -v may bound
            self.env["ASAN_OPTIONS"] = "detect_stack_use_after_return=1:detect_leaks=1:hard_rss_limit_mb=8000"
            self.env["UBSAN_OPTIONS"] = "halt_on_error=1"
        self.memory = ":" if san else "ulimit -v 16000000"
        self.link = ["gcc", *ldflags.split(), *(("-fsanitize=address,undefined",) if san else ()), "-o"]
        self.make = ["make", "-s", "BUILD=build", "SAN=" + san, "INSTALL_DEPS=0", "CFLAGS=" + cflags, "LDFLAGS=" + ldflags]
        self.env["LIBS"], self.flags = self.words("$(LIBS)"), self.words("$(ALL_CFLAGS)").split()
        self.programs = self.words("$(TESTS)").split()
        self.tests = self.programs + sorted(str(p.relative_to(self.where / "tests").with_suffix(""))
                                            for p in self.where.glob("tests/cli/*/*.sh"))

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


def cover(scratch, jobs):
    """Write a row a test: its time, what lines of src it runs, and what lines are code there."""
    tree, stored = Tree(scratch / "covered", "-O1 -g --coverage", "--coverage"), scratch / "map.json"
    known = {json.loads(row)[0] for row in stored.read_text().splitlines()} if stored.exists() else set()
    if tree.new:
        subprocess.run([*tree.make, f"-j{jobs}", "all", *("build/tests/" + p for p in tree.programs)], cwd=tree.where, check=True)
    for test in tree.tests:
        if test in known:
            continue
        for old in (tree.where / "build").rglob("*.gcda"):
            old.unlink()
        passed, seconds = tree.run(test)
        ran, code = collections.defaultdict(set), collections.defaultdict(set)
        text = subprocess.run(["gcov", "--stdout", "--json-format", *map(str, (tree.where / "build/src").rglob("*.gcda"))], cwd=tree.where,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout.decode()
        for file in (file for part in text.splitlines() for file in json.loads(part)["files"]):
            code[file["file"]].update(line["line_number"] for line in file["lines"])
            ran[file["file"]].update(line["line_number"] for line in file["lines"] if line["count"] > 0)
        rows = [{f: sorted(n) for f, n in lines.items() if f.startswith("src/")} for lines in (ran, code)]
        with stored.open("a") as out:
            print(json.dumps([test, passed, seconds, *rows]), file=out)


class Judge:
    """Runs the tests of a mutant's line until one fails that passes without the mutant."""

    def __init__(self, tree, coverage, jobs, patience):
        self.tree, self.patience, self.kills, self.fine = tree, patience, collections.Counter(), set()
        self.lines, self.code, self.took = {}, collections.defaultdict(set), {}
        for test, passed, self.took[test], ran, code in map(json.loads, coverage.read_text().splitlines()):
            if passed:
                self.lines[test] = {file: set(n) for file, n in ran.items()}
                for file, n in code.items():
                    self.code[file].update(n)
            else:
                print("mutate.py: without a mutant fails, and is not used:", test, file=sys.stderr)
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
            runs = [t for t in self.lines if number in self.lines[t].get(file, ())]
        elif file in self.code:
            runs = [t for t in self.lines if self.lines[t].get(file)]
        else:
            runs = [t for t in self.lines if any(f.startswith(f"src/{folder}/") and n for f, n in self.lines[t].items())]
        of_folder = {t: sum(len(n) for f, n in self.lines[t].items() if f.startswith(f"src/{folder}/")) + 1
                     for t in runs}
        return sorted(runs, key=lambda t: (self.took[t] + .1) / (1 + 4 * self.kills[folder, t]) / of_folder[t])

    def judge(self, mutant):
        """dead, alive, the same or no program; the test; the line before."""
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
        tests = self.order(file, number + 1)
        for i, test in enumerate(tests):
            if spent > self.patience:
                by = f"{i} of {len(tests)} tests"
                break
            if i == 0 or test == "test_memory":
                self.link_for(test)
            passed, seconds = self.tree.run(test, int(10 + 5 * self.took[test]))
            spent += seconds
            if passed:
                continue
            mutated = {o: (self.tree.where / o).read_bytes() for o in changed}
            self.put_back(changed)
            if test in self.fine or self.passes_without(test):
                self.kills[file.split("/")[1], test] += 1
                what, by = "dead", test
                break
            self.put_back(mutated)
            self.link_for(test)
        else:
            by = f"all of {len(tests)} tests"
        self.put_back(changed)
        return what, by, old


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--jobs", type=int, default=1, help="processes that compile the trees")
    parser.add_argument("--patience", type=float, default=40, help="seconds of tests for a mutant that lives")
    parser.add_argument("--minutes", type=float, default=90, help="no mutant is begun later")
    parser.add_argument("--scratch", type=pathlib.Path, required=True, help="a folder for the trees")
    parser.add_argument("--san", default="", choices=["1"], help="1: with sanitizers, too, what lives without")
    parser.add_argument("--mapped", action="store_true", help="map.json is used as it is")
    parser.add_argument("--folder", action="append", help="of src; all if none is given")
    args = parser.parse_args()
    end = time.monotonic() + 60 * args.minutes
    folders = args.folder or sorted(p.name for p in (ROOT / "src").iterdir())
    known = {}
    for row in (ROOT / "tests/mutation/equivalent.tsv").read_text().splitlines()[1:]:
        file, old, new, reason = row.split("\t")
        known[file, old, new] = reason
    if not args.mapped:
        cover(args.scratch.resolve(), args.jobs)
    judges = [Judge(Tree(args.scratch / ("mutants" + san), "-O1 -fvisibility=default", san=san), args.scratch / "map.json", args.jobs,
                    args.patience) for san in ("", "1") if san <= args.san]
    sums = collections.Counter()
    for mutant in draw(args.seed, args.count, folders):
        if sums["dead"] + sums["alive"] + sums["the same"] >= args.count or time.monotonic() > end:
            break
        for judge in judges:
            what, by, old = judge.judge(mutant)
            if what != "alive":
                break
        old, new = old.strip(), mutant[2].strip()
        if what == "alive" and (mutant[0], old, new) in known:
            what, by = "the same", known[mutant[0], old, new]
        sums[what] += 1
        if not what.startswith("no "):
            print(what, by, mutant[0], mutant[1] + 1, old, new, sep="\t", flush=True)
    print(f"{sums['no program']} did not compile, of {sums['no change']} the compiler makes the same", file=sys.stderr)
    n = sums["dead"] + sums["alive"] + sums["the same"]
    print(f"{n} mutants of seed {args.seed}: {sums['dead']} dead ({100 * sums['dead'] / max(n, 1):.1f} %),"
          f" {sums['the same']} change no result, {sums['alive']} alive", file=sys.stderr)


main()
