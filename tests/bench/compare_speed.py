#!/usr/bin/env python3
"""Is a build slower than another? python3 tests/bench/compare_speed.py OLD NEW [--rounds 9] [CONFIG...]

OLD and NEW are limn programs. Each round draws every picture with OLD, NEW and OLD again, whole processes one after the
other, so that what the machine does meanwhile meets all three. Prints the median ratio NEW / OLD beside OLD / OLD, with
the spread of both. The pictures: each ambient occlusion technique in the places of ao_table.sh, cages of
LIMN_TEST_DATA at level 4, and the configs given (those of cages.sh, for example).
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


PLACES = {
    "room": ("ao_scenes/room.obj", "[-1.9, 1.2, 3.6]", "[1.5, 0.6, -2.5]"),
    "thin": ("ao_scenes/thin.obj", "[-2.6, 0.9, 3.2]", "[0.3, 0.5, 0]"),
    "bust": ("ao_scenes/bust.obj", "[-1.2, 1.1, 2.3]", "[0, 1.0, 0]"),
    "sponza": ("sponza_architecture/sponza.obj", "[480, 620, -330]", "[-500, 420, 250]"),
}


def own_configs(folder):
    data = os.environ.get("LIMN_TEST_DATA") or sys.exit("LIMN_TEST_DATA names no folder of test data")
    for place, (file, position, look_at) in PLACES.items():
        with open(os.path.join(folder, place + ".toml"), "w") as f:
            f.write('[[mesh]]\nname = "%s"\nfile = "%s/%s"\n' % (place, data, file))
            f.write("[[camera]]\nposition = %s\nlook_at = %s\nfov = 91.5\n" % (position, look_at))
    cages = sorted(name for name in os.listdir(data + "/cages") if name.endswith(".obj"))[:6]
    with open(os.path.join(folder, "cages.toml"), "w") as f:
        for i, name in enumerate(cages):
            f.write('[[mesh]]\nname = "c%d"\nfile = "%s/cages/%s"\nsubdivision = { level = 4 }\n' % (i, data, name))
        # A camera of its own: builds may frame a scene that has none in different ways.
        f.write("[[camera]]\nposition = [3, 2.5, 4]\nlook_at = [0, 0.3, 0]\nfov = 50\n")
    pictures = [("cages_%d" % samples, "cages", samples, "") for samples in (1, 8)]
    for place in PLACES:
        for technique, more in OCCLUSION.items():
            pictures.append((place + "_" + technique, place, 2, "[ao]\ntechnique = '%s'\n%s\n" % (technique, more)))
    configs = []
    for name, scene, samples, more in pictures:
        configs.append(os.path.join(folder, name + "_picture.toml"))
        with open(configs[-1], "w") as f:
            f.write('scene = "%s.toml"\n' % scene + STYLE % samples + more)
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
    parser.add_argument("--only", default="", help="pictures whose name holds this text")
    options = parser.parse_args()
    old, new = os.path.abspath(options.old), os.path.abspath(options.new)
    with tempfile.TemporaryDirectory() as folder:
        configs = [c for c in own_configs(folder) + options.configs if options.only in os.path.basename(c)]
        output = os.path.join(folder, "picture.png")
        print("%-28s %9s %9s   %-24s %-24s" % ("", "old", "new", "new / old", "old / old"))
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
            name = os.path.splitext(os.path.basename(config))[0].replace("_picture", "")
            medians = [statistics.median(column) for column in zip(*times)]
            print("%-28s %7.3f s %7.3f s   %-24s %-24s" % (name, medians[0], medians[1], *text), flush=True)
        print("largest median: %.3f" % worst)


if __name__ == "__main__":
    main()
