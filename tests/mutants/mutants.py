#!/usr/bin/env python3
"""Do the tests test? Changes one thing at a time in shaders and numeric code, and sees whether some test fails.

    python3 tests/mutants/mutants.py FOLDER [--count 50] [--seed 1] [--only NUMBER] [--log FILE]

FOLDER keeps a copy of the sources with a build of its own. A mutant is a place in a shader or a source file, drawn with
a fixed seed, where an operator, a comparison, a function or a number is another one. Those that do not compile are
drawn again. Suites run from the quickest on, each until its first failure. Prints each mutant, what killed it, and how
many survive; those that the table below explains change nothing that a test could see.
"""

import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))

# Where numbers are worked out. Text, files and commands have tests of their own kind.
NUMERIC = re.compile(
    r"src/(picture|stage/edge_rates|mesh/(tri_mesh|section|clusters|polygon|tessellate)|lines|rays|gpu/(culling|lights)"
    r"|effects/.*|settings/color|image/(image|texture))[^ ]*\.(cpp|h)$"
)
SHADER = re.compile(r"shaders/.*\.(comp|glsl|frag|vert)$")

# What is replaced by what. Spaces around operators keep off pointers, templates and signs.
CHANGES = [
    (r" \+ ", " - "),
    (r" - ", " + "),
    (r" \* ", " / "),
    (r" / ", " * "),
    (r" < ", " <= "),
    (r" > ", " < "),
    (r" <= ", " > "),
    (r" && ", " || "),
    (r"\bmin\(", "max("),
    (r"\bmax\(", "min("),
    (r"\b0\.5\b", "0.55"),
    (r"\b1\.0\b", "1.1"),
    (r"\bsqrt\(", "abs("),
]

INVALID = "does not compile"

# Mutants that no test can see, by file and the changed line's text.
EQUIVALENT = {
    (
        "src/gpu/culling.cpp",
        "|| box.low[0] - bounds.room > view.regionHigh.x || box.low[1] + bounds.room > view.regionHigh.y);",
    ): "the room is for the worst that rounding could do, and no rounding that was met needs it",
    (
        "shaders/effects/ao/horizon.glsl",
        "float reach = max(1.1, farthest * stepReach((i + jitter) / count, params.stepGrowth));",
    ): "steps of 1 and of 1.1 pixels fall on the same pixel but in few directions",
    (
        "shaders/effects/ao/hemisphere.comp",
        "cell += ivec2(lessThan(cell, ivec2(0))) / params.noiseSize;",
    ): "other noise in the guard band, as good as this one",
    (
        "shaders/lib/slices.glsl",
        "float stepReach(float share, float growth) { return share * mix(1.1, share, growth); }",
    ): "the last steps fall beyond the radius, where nothing counts: a tenth of them is lost",
    (
        "shaders/effects/ao/hbao.comp",
        "float visible = clamp(1.0 - hidden / float(DIRECTIONS), 0.0, 1.1);",
    ): "what is hidden is never below 0, so that the bound is never met",
}

SUITES = (
    ("unit", "-Style.*:Arrows.*:Shapes.*"),
    ("golden", "*"),
    ("stability", "*"),
    ("gl", "-*Cycles*:*OneSide*"),
    ("cost", "*"),
)


def sources():
    listed = subprocess.run(["git", "ls-files"], cwd=TOP, capture_output=True, text=True, check=True).stdout
    return [name for name in listed.split("\n") if SHADER.match(name) or NUMERIC.match(name)]


def sites(name):
    """Every place of a file that can be changed: line, column, old and new text."""
    found = []
    for number, line in enumerate(open(os.path.join(TOP, name)).read().split("\n")):
        code = re.sub(r'"[^"]*"', lambda m: " " * len(m[0]), line.split("//")[0])
        if code.lstrip().startswith(("#include", "field<", "static_assert", "template", "throw", "fmt::")):
            continue
        for old, new in CHANGES:
            found += [(number, m.start(), m[0], new) for m in re.finditer(old, code)]
    return found


def draw_sites(count, seed):
    """Half of them in shaders, half in C++; a file counts by how much can be changed in it."""
    generator = random.Random(seed)
    pools = {True: [], False: []}
    for name in sources():
        pools[bool(SHADER.match(name))] += [(name, *site) for site in sites(name)]
    for pool in pools.values():
        generator.shuffle(pool)
    while True:
        for shader in (True, False):
            yield pools[shader].pop()


class Copy:
    def __init__(self, folder):
        self.folder = os.path.abspath(folder)
        self.build = os.path.join(self.folder, "build", "ci")
        listed = subprocess.run(["git", "ls-files"], cwd=TOP, capture_output=True, text=True, check=True).stdout
        for name in filter(None, listed.split("\n")):
            source, target = os.path.join(TOP, name), os.path.join(self.folder, name)
            if os.path.exists(target) and open(source, "rb").read() == open(target, "rb").read():
                continue
            os.makedirs(os.path.dirname(target), exist_ok=True)
            shutil.copyfile(source, target)
        subprocess.run(["cmake", "--preset", "ci"], cwd=self.folder, check=True, capture_output=True)
        if not self.make():
            sys.exit("the sources do not build")
        # A test that fails anyway would kill every mutant.
        for shaders in (False, True):
            if killer := self.kill(shaders):
                sys.exit("without a mutant: " + killer)

    def make(self):
        targets = ["limn", "limn_oiio"] + [name for name, _ in SUITES]
        return subprocess.run(["ninja", "-C", self.build] + targets, capture_output=True).returncode == 0

    def kill(self, shaders):
        """The suite and test that notice, or nothing."""
        environment = dict(os.environ, LIMN_SHADER_DIR=os.path.join(self.folder, "shaders") if shaders else "")
        for suite, tests in SUITES[1:] if shaders else SUITES:
            command = [os.path.join(self.build, suite), "--gtest_fail_fast", "--gtest_filter=" + tests]
            try:
                done = subprocess.run(
                    command, cwd=self.build, env=environment, capture_output=True, text=True, timeout=900
                )
            except subprocess.TimeoutExpired:
                return suite + ": did not end"
            if done.returncode and "does not compile" in done.stdout:
                return INVALID
            if done.returncode:
                failed = re.search(r"\[  FAILED  \] (\S+)", done.stdout)
                return "%s: %s" % (suite, failed[1].rstrip(",") if failed else "crashed")
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder")
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="number of the one mutant to try")
    parser.add_argument("--log", help="the lines go here too")
    options = parser.parse_args()
    copy = Copy(options.folder)
    log = open(options.log, "a") if options.log else None

    def say(text):
        print(text, flush=True)
        if log:
            print(text, file=log, flush=True)

    tried = killed = explained = 0
    is_stale = False  # is a mutant compiled into the programs that is no more in the sources?
    for name, line, column, old, new in draw_sites(options.count, options.seed):
        if tried == options.count:
            break
        if options.only and tried + 1 < options.only:
            tried += 1
            continue
        path = os.path.join(copy.folder, name)
        before = open(path).read()
        lines = before.split("\n")
        text = lines[line]
        lines[line] = text[:column] + new + text[column + len(old) :]
        with open(path, "w") as f:
            f.write("\n".join(lines))
        begin = time.time()
        shader = bool(SHADER.match(name))
        try:
            if is_stale or not shader:
                is_stale = True
                if not copy.make():
                    continue  # does not compile: no mutant
                is_stale = not shader
            killer = copy.kill(shader)
        finally:
            with open(path, "w") as f:
                f.write(before)
        if killer == INVALID:
            continue
        tried += 1
        reason = EQUIVALENT.get((name, lines[line].strip()))
        killed += killer is not None
        explained += killer is None and reason is not None
        say("%3d %s:%d  %s" % (tried, name, line + 1, lines[line].strip()[:90]))
        say("    %s  (%.0f s)" % (killer or ("SURVIVES" + (": " + reason if reason else "")), time.time() - begin))
        if options.only:
            break
    say("%d mutants, %d killed, %d survive (%d explained)" % (tried, killed, tried - killed, explained))
    return 0 if killed + explained >= 0.9 * tried else 1


if __name__ == "__main__":
    sys.exit(main())
