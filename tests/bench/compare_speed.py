#!/usr/bin/env python3
"""Is a build slower than another? python3 tests/bench/compare_speed.py OLD NEW [--rounds 9] [CONFIG...]

OLD and NEW are limn programs. Each round draws every config with OLD, NEW and OLD again, whole processes one after the
other, so that what the machine does meanwhile meets all three. Prints the median ratio NEW / OLD beside OLD / OLD, with
the spread of both. Without configs: each ambient occlusion technique in the room of LIMN_TEST_DATA's ao_scenes, and
cages of its folder at level 4.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time

OCCLUSION = {
    "toon_ssao": "points = 16",
    "occlusion_function": "",
    "hemisphere": "points = 32",
    "depth_tangent": "",
    "hbao": "",
    "gtao": "",
    "visibility_bitmask": "",
    "ray_traced": "rays = 4\nfilter = { technique = 'plane_aware' }",
}
STYLE = """
[image]
size = [1280, 720]
samples = %d
[shading]
technique = "toon"
[[edges]]
technique = "depth_normal"
[output]
path = "picture.png"
"""


def own_configs(folder):
    data = os.environ.get("LIMN_TEST_DATA") or sys.exit("LIMN_TEST_DATA names no folder; or name configs")
    with open(os.path.join(folder, "room.toml"), "w") as f:
        f.write('[[mesh]]\nname = "room"\nfile = "%s/ao_scenes/room.obj"\n' % data)
        f.write('[[camera]]\nposition = [0.3, 1.6, 4.8]\nlook_at = [-0.1, 1.1, -3]\nfov = 91.5\n')
    cages = sorted(name for name in os.listdir(data + "/cages") if name.endswith(".obj"))[:6]
    with open(os.path.join(folder, "cages.toml"), "w") as f:
        for i, name in enumerate(cages):
            f.write('[[mesh]]\nname = "c%d"\nfile = "%s/cages/%s"\nsubdivision = { level = 4 }\n' % (i, data, name))
    configs = []
    for name, scene, samples, more in [
        *((t, "room", 4, "[ao]\ntechnique = '%s'\n%s\n" % (t, more)) for t, more in OCCLUSION.items()),
        ("cages, 1 sample", "cages", 1, ""),
        ("cages, 8 samples", "cages", 8, ""),
    ]:
        path = os.path.join(folder, name.replace(", ", "_").replace(" ", "_") + ".toml")
        with open(path, "w") as f:
            f.write('scene = "%s.toml"\n' % scene + STYLE % samples + more)
        configs.append(path)
    return configs


def seconds(program, config, output):
    begin = time.perf_counter()
    done = subprocess.run([program, "--quiet", "render", config, "--output", output], capture_output=True, text=True)
    if done.returncode:
        sys.exit("%s %s: %s" % (program, config, done.stderr))
    return time.perf_counter() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("configs", nargs="*")
    parser.add_argument("--rounds", type=int, default=9)
    options = parser.parse_args()
    old, new = os.path.abspath(options.old), os.path.abspath(options.new)
    with tempfile.TemporaryDirectory() as folder:
        configs = options.configs or own_configs(folder)
        output = os.path.join(folder, "picture.png")
        print("%-24s %9s %9s   %-24s %-24s" % ("", "old", "new", "new / old", "old / old"))
        worst = 0
        for config in configs:
            for program in (old, new):
                seconds(program, config, output)  # programs, files and shaders come into caches
            times = [[seconds(p, config, output) for p in (old, new, old)] for _ in range(options.rounds)]
            ratios = [[new_ / first, again / first] for first, new_, again in times]
            text = []
            for column in zip(*ratios):
                text.append("%.3f (%.3f to %.3f)" % (statistics.median(column), min(column), max(column)))
            worst = max(worst, statistics.median(r[0] for r in ratios))
            name = os.path.splitext(os.path.basename(config))[0]
            medians = [statistics.median(column) for column in zip(*times)]
            print("%-24s %7.3f s %7.3f s   %-24s %-24s" % (name, medians[0], medians[1], *text), flush=True)
        print("largest median: %.3f" % worst)


if __name__ == "__main__":
    main()
