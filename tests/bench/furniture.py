#!/usr/bin/env python3
"""Hundreds of models by strangers, each loaded, subdivided and drawn in a process of its own.

    tests/bench/furniture.py LIMN OUT.log [--sample N] [--jobs N]

The models are the OBJ files of Debian's sweethome3d-furniture. LIMN draws each at Catmull-Clark level 2 with toon
shading, ambient occlusion and outlines, and is strict: a value that is not finite fails. Writes a line per model and a
table of outcomes; exits 1 when a process crashed, hung for two minutes, or met a value that is not finite.
"""

import argparse
import concurrent.futures
import glob
import os
import subprocess
import sys
import tempfile
import time
import zipfile

FOLDER = "/usr/share/sweethome3d/furniture"
SCENE = '[[mesh]]\nname = "m"\nfile = "{file}"\nsubdivision = {{ level = 2 }}\n'
CONFIG = """scene = "{scene}"
[image]
size = [160, 120]
samples = 1
[shading]
technique = "toon"
[ao]
technique = "toon_ssao"
filter = "gaussian"
[[edges]]
technique = "depth_normal"
[output]
path = "{picture}"
aovs = ["beauty", "depth", "normal"]
"""


def draw(limn, model, work):
    stem = os.path.join(work, str(abs(hash(model))))
    with open(stem + ".scene.toml", "w") as file:
        file.write(SCENE.format(file=model.replace("\\", "\\\\").replace('"', '\\"')))
    with open(stem + ".toml", "w") as file:
        file.write(CONFIG.format(scene=stem + ".scene.toml", picture=stem + ".exr"))
    start = time.monotonic()
    try:
        run = subprocess.run(
            [limn, "render", "--strict", "--quiet", stem + ".toml"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            timeout=120,
        )
        code, errors = run.returncode, run.stderr.decode("utf-8", "replace")
    except subprocess.TimeoutExpired:
        code, errors = None, ""
    seconds = time.monotonic() - start
    for path in glob.glob(glob.escape(stem) + "*"):
        os.remove(path)
    complaint = next((line for line in errors.splitlines() if "error" in line), "")
    if code == 0:
        outcome = "drawn"
    elif code is None:
        outcome = "hung"
    elif code < 0:
        outcome = "crashed"
    elif "not finite" in errors:
        outcome = "not finite"
    else:
        outcome = "refused"
    return outcome, code, seconds, complaint


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("limn")
    parser.add_argument("log")
    parser.add_argument("--sample", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    archives = sorted(glob.glob(FOLDER + "/*.sh3f"))
    if not archives:
        print("the package sweethome3d-furniture is not installed")
        sys.exit(77)  # ctest: skipped
    with tempfile.TemporaryDirectory() as work:
        models = []
        for archive in archives:
            target = os.path.join(work, os.path.basename(archive))
            with zipfile.ZipFile(archive) as bundle:
                bundle.extractall(target)
            models += glob.glob(glob.escape(target) + "/**/*.obj", recursive=True)
        models.sort()
        if arguments.sample:
            models = models[:: max(1, len(models) // arguments.sample)][: arguments.sample]
        lines, counts = [], {}
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            for model, (outcome, code, seconds, complaint) in zip(
                models, pool.map(lambda m: draw(arguments.limn, m, work), models)
            ):
                counts[outcome] = counts.get(outcome, 0) + 1
                lines.append(
                    "%-10s %4s  %s%s"
                    % (
                        outcome,
                        code,
                        os.path.relpath(model, work),
                        "  " + complaint.replace(work, "") if complaint else "",
                    )
                )
    with open(arguments.log, "w") as log:
        log.write(
            "# tests/bench/furniture.py LIMN %s%s\n"
            % (os.path.basename(arguments.log), " --sample %d" % arguments.sample if arguments.sample else "")
        )
        log.write("# limn render --strict, Catmull-Clark level 2, each model in its own process\n#\n")
        for outcome in ("drawn", "refused", "crashed", "hung", "not finite"):
            log.write("# %-10s %d\n" % (outcome, counts.get(outcome, 0)))
        log.write("# %-10s %d\n\n" % ("models", len(models)))
        log.write("\n".join(lines) + "\n")
    print(", ".join("%s %d" % item for item in sorted(counts.items())))
    sys.exit(1 if set(counts) & {"crashed", "hung", "not finite"} else 0)


if __name__ == "__main__":
    main()
