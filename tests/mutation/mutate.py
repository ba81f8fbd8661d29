#!/usr/bin/env python3
"""mutate.py -- how many small errors in src the tests see.

Draws COUNT mutants of src by SEED: an operator that becomes another, a constant that is changed, a statement that is
left out.  Each is compiled, and the tests of its folder (below) run until one fails: then it is dead.  Writes
a row a mutant (what, by which test, file, line, the line before and after), and their sums.  Mutants that change no
result are in equivalent.tsv beside this file: file, line before, line after, the reason.

    python3 tests/mutation/mutate.py --seed 1 --count 300 > mutants.tsv
"""
import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import threading

ROOT = pathlib.Path(__file__).resolve().parents[2]

# The tests of a folder: programs, and all scripts of a directory of tests/cli.
TESTS = {
    "base": "test_number test_least test_threads test_signal test_sim cli/cat cli/sim",
    "signal": "test_signal test_signal_forms test_signal_tables test_spectrum test_filter test_arguments cli/cat cli/signal cli/noise"
              " cli/filter cli/morlet",
    "scene": "test_scene test_models test_sim test_laws test_sim_truth test_rigs test_taylor test_random test_catalogue cli/sim",
    "motion": "test_bernstein test_sim test_sim_truth test_taylor test_laws test_random test_rigs test_extremes test_arguments cli/sim",
    "map": "test_morlet test_morlet_integral test_morlet_properties test_waves test_stream test_inverse"
           " test_wavelet_extremes test_contour test_arguments cli/morlet cli/contour",
    "io": "test_signal test_signal_forms test_signal_tables test_store test_store_failures test_store_foreign"
          " test_store_hostile test_coefficients test_overview test_long_names test_arguments cli/cat cli/morlet cli/all",
    "find": "test_repetition test_transitions test_spikes test_pulls test_features cli/features",
    "fit": "test_rank test_pulls test_steps test_motion test_backbone cli/rank cli/backbone",
    "study": "test_sweep test_trade test_chaos cli/sweep cli/trade",
    "plot": "test_contour test_plot cli/contour cli/plot",
}

LIMIT = 300     # s; what a mutant hangs in, it dies of

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
    """A copy of the sources whose programs find the library as one shared object, made again for each mutant."""

    def __init__(self, where):
        self.where = pathlib.Path(where)
        archive = subprocess.run(["git", "-C", ROOT, "archive", "HEAD"], check=True, stdout=subprocess.PIPE).stdout
        subprocess.run(["tar", "x", "-C", where], check=True, input=archive)
        link = self.where / "link.sh"
        link.write_text('#!/bin/sh\nshift\nout=$1\nshift\nexec gcc -shared -Wl,-soname,"$PWD/$out" -o "$out" "$@" $LINK_LIBS\n')
        link.chmod(0o755)
        self.library = "build/libmutant.so"
        version = re.search(r'SS_VERSION "(.*)"', (ROOT / "include/stickslip/status.h").read_text())[1]
        self.shared = f"build/libstickslip.so.{version}"
        # the version script leaves out what tests use beyond the headers
        self.make = ["make", "-s", "CC=" + os.environ.get("CC", "gcc"), "AR=./link.sh", "STATIC=" + self.library, "BUILD=build", "INSTALL_DEPS=0",
                     "CFLAGS=-O1 -fvisibility=default"]
        libraries = subprocess.run(["make", "-s", "--eval", "print:; @echo $(LIBS)", "print"], cwd=self.where, check=True,
                                   stdout=subprocess.PIPE, text=True).stdout
        self.env = dict(os.environ, LINK_LIBS=libraries.strip())

    def build(self, *targets):
        return subprocess.run([*self.make, *targets], cwd=self.where, env=self.env, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL).returncode == 0

    def run(self, test):
        """The tests that fail: of a program itself, or of the scripts of a directory."""
        limits = "ulimit -f 4000000; ulimit -v 16000000; "
        if not test.startswith("cli/"):
            command = f"exec timeout {LIMIT} build/tests/{test}"
        else:
            command = "exec sh tests/run.sh none"
        scripts = sorted(str(p.relative_to(ROOT / "tests").with_suffix("")) for p in (ROOT / "tests" / test).glob("*.sh"))
        env = dict(self.env, CC="gcc", CCLD="gcc -O1", BUILD="build", MAKE="make", ONLY=" ".join(scripts), LIMIT=str(LIMIT), JOBS="1",
                   LIBS="", INCLUDES="", TOOL_PARTS="", SAN="", LONG="")
        done = subprocess.run(["sh", "-c", limits + command], cwd=self.where, env=env, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        failed = re.findall(r"^FAIL  ([^:]*):", done.stdout.decode(errors="replace"), re.M) if scripts else [test]
        return [] if done.returncode == 0 else failed


class Judge:
    """Runs the tests of a mutant's folder, in the order of the list, until some fail that pass without the mutant."""

    def __init__(self):
        self.failing, self.lock = {}, threading.Lock()     # what fails without a mutant, of the tests that were asked

    def fails_anyway(self, tree, test):
        if test not in self.failing:
            failing = tree.run(test)
            with self.lock:
                self.failing[test] = failing
                if failing:
                    print("mutate.py: without a mutant fails, and is not used:", *failing, file=sys.stderr)
        return self.failing[test]

    def judge(self, tree, mutant):
        """dead, alive or no program; the test; the line before."""
        file, number, new = mutant
        path = tree.where / file
        text = path.read_text()
        lines = text.split("\n")
        old, lines[number] = lines[number], new
        killers, built = {}, False
        for test in TESTS[file.split("/")[1]].split():
            if not built:
                path.write_text("\n".join(lines))
                built = tree.build(tree.library, tree.shared)
            failed = tree.run(test) if built else []
            if failed or not built:
                path.write_text(text)
                tree.build(tree.library, tree.shared)
                if not built:
                    return "no program", "", old
                built = False
                killers = set(failed) - set(self.fails_anyway(tree, test))
            if killers:
                return "dead", min(killers), old
        path.write_text(text)
        tree.build(tree.library, tree.shared)
        return "alive", "", old


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--folder", action="append", choices=sorted(TESTS), help="of src; all if none is given")
    args = parser.parse_args()
    folders = args.folder or sorted(TESTS)
    known = {}
    for row in (ROOT / "tests/mutation/equivalent.tsv").read_text().splitlines()[1:]:
        file, old, new, reason = row.split("\t")
        known[file, old, new] = reason
    drawn = iter(draw(args.seed, args.count, folders))
    sums, lock = collections.Counter(), threading.Lock()
    with tempfile.TemporaryDirectory(prefix="stickslip-mutants.") as scratch:
        trees = []
        for i in range(args.jobs):
            where = os.path.join(scratch, str(i))
            os.mkdir(where) if i == 0 else shutil.copytree(trees[0].where, where, symlinks=True)
            trees.append(Tree(where))
            programs = sorted({"build/tests/" + t for f in folders for t in TESTS[f].split() if not t.startswith("cli/")})
            if i == 0 and not trees[0].build("all", *programs):
                sys.exit("mutate.py: the tree without a mutant is not built")
            if i > 0:           # the programs name the library by its path
                for program in (trees[i].where / "build").rglob("*"):
                    if program.is_file() and os.access(program, os.X_OK) and program.suffix == "":
                        program.unlink()
                (trees[i].where / trees[i].library).unlink()
                if not trees[i].build("all", *programs):
                    sys.exit("mutate.py: a copy of the tree is not built")
        judge = Judge()

        def work(tree):
            while True:
                with lock:
                    if sums["dead"] + sums["alive"] + sums["the same"] + sums["begun"] >= args.count:
                        return
                    mutant = next(drawn, None)
                    if mutant is None:
                        return
                    sums["begun"] += 1
                what, by, old = judge.judge(tree, mutant)
                old, new = old.strip(), mutant[2].strip()
                if what == "alive" and (mutant[0], old, new) in known:
                    what, by = "the same", known[mutant[0], old, new]
                with lock:
                    sums["begun"] -= 1
                    sums[what] += 1
                    if what != "no program":
                        print(what, by, mutant[0], mutant[1] + 1, old, new, sep="\t", flush=True)

        with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
            list(pool.map(work, trees))
    n = sums["dead"] + sums["alive"] + sums["the same"]
    print(f"{n} mutants of seed {args.seed}: {sums['dead']} dead ({100 * sums['dead'] / max(n, 1):.1f} %),"
          f" {sums['the same']} change no result, {sums['alive']} alive", file=sys.stderr)


main()
