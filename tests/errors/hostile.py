#!/usr/bin/env python3
"""Configs and scenes that nobody would write:

    python3 tests/errors/hostile.py LIMN [--count 2000] [--seed 1] [--log FILE]

Changes the project's own and some small ones at random: numbers to extremes, texts to nonsense, lines gone, doubled,
swapped or torn. Honest sizes stay small: what takes long or much is limn's fault. Each must end within 20 s and 12 GB
with a documented exit code other than that of a bug, and say so in lines of at most 300 bytes beside their prefix.
"""

import argparse
import glob
import os
import random
import re
import resource
import subprocess
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DOCUMENTED = {0, 1, 33, 64, 65, 66, 73, 74, 75, 77}
LONGEST = 300 + len("warning: ")

NUMBERS = (
    "0 -1 1 2 0.5 -0.0 1e-308 1e308 -1e308 1e-5 1e9 2147483648 -2147483649 9223372036854775807 nan inf -inf 1e400"
).split()
TEXTS = [
    '""', '"\\u0007"', '"../../../etc/passwd"', '"/dev/zero"', '"' + "x" * 5000 + '"', '"%s%n"', '"#zzzzzz"',
    '"1e999px"', '"-5%"', '"0.000mm"', '"####"', "true", "[]", "[[]]", "{}", "[1, [2, [3]]]", "{ keys = [] }",
    "{ keys = [[1, 2], [1, 3]] }", "1979-05-27", '"toon"', '"hbao"', '"\\U0001F600"',
]
# Keys whose honest values cost time or memory: never more than these.
CAPS = {"samples": 8, "size": 300, "level": 5, "points": 64, "rays": 16, "slices": 16, "steps": 64, "resolution": 1024,
        "directions": 16, "iterations": 8, "supersampling": 2}

SCENE = """
[[mesh]]
name = "m"
file = "m.obj"
subdivision = { level = 2 }
[[instance]]
mesh = "m"
translate = [0, 0, 0]
rotate = [0, 30, 0]
[[camera]]
name = "main"
position = [3, 2, 4]
look_at = [0, 0, 0]
fov = 50
shift = [0.1, 0]
[[light]]
kind = "sun"
direction = [-1, -2, -1]
shadow = { resolution = 256 }
[[material]]
name = "a"
color = "#804020"
[[section]]
name = "A"
point = [0, 0, 0]
normal = [0, 0, 1]
hatch = "4px"
[animation]
frames = "1-3"
"""
CONFIG = """
scene = "scene.toml"
sections = ["A"]
[image]
size = [96, 64]
samples = 2
tile = 0
background = "#f7f3e8"
[shading]
technique = "toon"
bands = 3
[ao]
technique = "%s"
radius = "5%%"
filter = { technique = "gaussian", iterations = 2 }
[[edges]]
technique = "depth_normal"
width = "1.5px"
color = "#1a1a1a"
[output]
path = "out/picture_##.png"
aovs = ["beauty", "depth", "edges"]
"""
OBJ = "".join("v %d %d %d\n" % (i & 1, i >> 1 & 1, i >> 2) for i in range(8)) + "".join(
    "f %d %d %d %d\n" % f for f in [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)])


def mutate(text, rng):
    for _ in range(rng.choice((1, 1, 1, 1, 2, 3))):
        lines = text.split("\n")
        kind = rng.randrange(20)
        at = rng.randrange(len(lines))
        if kind <= 14:  # a value
            places = [m for m in re.finditer(r"-?\d+(?:\.\d+)?|\"[^\"]*\"|true|false", text)]
            if places:
                m = rng.choice(places)
                is_number = m[0][0] in "-0123456789"
                if is_number and rng.random() < 0.8:  # a number may be odd and still be taken
                    value = float(m[0]) * rng.choice((-1, 0, 0.5, 2, 10, 1e-3, 1e3, 1e-9, 1e9))
                    new = "%d" % value if value == int(value) else "%.9g" % value
                else:
                    new = rng.choice(NUMBERS if is_number and rng.random() < 0.8 else TEXTS)
                text = text[: m.start()] + new + text[m.end() :]
            continue
        if kind == 15:
            del lines[at]
        elif kind == 16:
            lines.insert(at, lines[rng.randrange(len(lines))])
        elif kind == 17:
            first = rng.randrange(len(lines))
            lines[at:at] = lines[first : first + 6] * rng.choice((2, 20, 200))
        elif kind == 18:
            other = rng.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        else:
            line = lines[at]
            cut = rng.randrange(len(line) + 1)
            lines[at] = line[:cut] + rng.choice(["", "\x00", "\x1b[2J", "=", "[", '"', "é", ".", "a.b.c"]) + line[cut:]
        text = "\n".join(lines)
    return text


def capped(text):
    """Honest values of what costs: larger ones are made small, hostile ones stay."""

    def cap(m):
        key, rest = m[1], m[2]
        return key + re.sub(r"(?<![\w.+-])\d{1,9}(?![\w.])", lambda n: str(min(int(n[0]), CAPS[key.split()[0]])), rest)

    return re.sub(r"((?:%s)\b\s*=)([^\n}]*)" % "|".join(CAPS), cap, text)


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (40 << 30, 40 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("limn")
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="number of the one to try; its files are left in ./hostile")
    parser.add_argument("--log", help="the counts go here too")
    options = parser.parse_args()
    limn, rng = os.path.abspath(options.limn), random.Random(options.seed)
    techniques = ["toon_ssao", "hbao", "gtao", "visibility_bitmask", "ray_traced", "hemisphere", "occlusion_function"]
    # Files of the project's scenes are found from anywhere.
    scenes = [
        re.sub(r'(= ")(?=[^"]*\.(?:obj|toml|png|jpg))', r"\g<1>%s/" % os.path.dirname(p), open(p).read())
        for p in sorted(glob.glob(TOP + "/scenes/*/scene.toml"))
    ]
    codes, failed, longest, largest = {}, [], 0.0, 0
    with tempfile.TemporaryDirectory() as folder:
        if options.only:
            folder = os.path.join(os.getcwd(), "hostile")
            os.makedirs(folder, exist_ok=True)
        os.chdir(folder)
        for number in range(1, options.count + 1):
            scene, config = SCENE, CONFIG % rng.choice(techniques)
            if rng.random() < 0.2:
                scene = rng.choice(scenes)
            which = rng.random()
            if which < 0.55:
                scene = mutate(scene, rng)
            if which > 0.45:
                config = mutate(config, rng)
            if options.only and number != options.only:
                continue
            open("m.obj", "w").write(OBJ)
            open("scene.toml", "w", errors="surrogateescape").write(capped(scene))
            open("config.toml", "w", errors="surrogateescape").write(capped(config))
            begin = time.time()
            process = subprocess.Popen([limn, "render", "config.toml", "--frames", "1", "--memory-limit", "8G"],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=limits)
            wrong = []
            try:
                out, err = process.communicate(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()
                out, err = process.communicate()
                wrong.append("takes more than 20 s")
            took, code = time.time() - begin, process.returncode
            memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss >> 10
            longest, largest = max(longest, took), max(largest, memory)
            codes[code] = codes.get(code, 0) + 1
            if code not in DOCUMENTED and not wrong:
                wrong.append("ends with %d" % code)
            wrong += ["a message of %d bytes" % len(line) for line in err.split(b"\n")
                      if len(line) > LONGEST and not line.startswith(b"Saved: ")]
            if any(byte < 32 and byte != 10 for byte in err):
                wrong.append("a control character in a message")
            if memory > 12 << 10:
                wrong.append("takes %d MiB" % memory)
            if code and not err:
                wrong.append("ends with %d without a word" % code)
            if wrong:
                failed.append(number)
                said = err[-300:].decode(errors="replace").strip()
                print("%d: %s: %s" % (number, ", ".join(wrong), said), flush=True)
    counts = ", ".join("%d × code %d" % (n, c) for c, n in sorted(codes.items()))
    text = "%d configs and scenes, seed %d: %s; longest %.1f s, largest %d MiB; %d wrong" % (
        options.count, options.seed, counts, longest, largest, len(failed))
    print(text)
    if options.log:
        open(os.path.join(TOP, options.log), "a").write(text + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
