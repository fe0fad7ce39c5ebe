#!/usr/bin/env python3
"""What further frames cost: python3 tests/bench/sequences.py LIMN SCENE.py [--rounds 5]

SCENE.py is a Blender script of 25 subdivided heads on a plane, as for peers.sh. One run prints, as medians of rounds in
which all programs take turns:
- a further frame of a camera's move over the heads beside Workbench's render of them, at 8 samples and at 1;
- the same with a deforming figure of 200 000 limit triangles among the heads (one file per frame), beside without it;
- how busy the cores are meanwhile;
- which part of a wait of 100 ms in reading each mesh file, and in renaming each picture, is hidden by other work.
"""

import argparse
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
FRAMES = 13

# Waits where meshes are opened and where finished pictures are renamed, as a slow file server would.
SLOW = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void waitFor(const char* path, const char* part, const char* variable) {
    const char* milliseconds = getenv(variable);
    if (milliseconds && strstr(path, part)) usleep(1000 * atoi(milliseconds));
}
#define OPENS_STREAM(name) \
    FILE* name(const char* path, const char* mode) { \
        waitFor(path, "wave_", "WAIT_READ"); \
        return ((FILE * (*)(const char*, const char*)) dlsym(RTLD_NEXT, #name))(path, mode); \
    }
#define OPENS_FILE(name) \
    int name(const char* path, int flags, ...) { \
        va_list rest; \
        va_start(rest, flags); \
        int mode = va_arg(rest, int); \
        va_end(rest); \
        waitFor(path, "wave_", "WAIT_READ"); \
        return ((int (*)(const char*, int, int))dlsym(RTLD_NEXT, #name))(path, flags, mode); \
    }
OPENS_STREAM(fopen)
OPENS_STREAM(fopen64)
OPENS_FILE(open)
OPENS_FILE(open64)
int rename(const char* from, const char* to) {
    waitFor(to, "picture_", "WAIT_WRITE");
    return ((int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename"))(from, to);
}
int renameat2(int fromAt, const char* from, int toAt, const char* to, unsigned flags) {
    waitFor(to, "picture_", "WAIT_WRITE");
    return ((int (*)(int, const char*, int, const char*, unsigned))dlsym(RTLD_NEXT, "renameat2"))(
        fromAt, from, toAt, to, flags);
}
"""


def run(command, **more):
    done = subprocess.run(command, capture_output=True, text=True, **more)
    if done.returncode:
        sys.exit("%s: %s" % (command, done.stderr))
    return done.stdout


def read_cage(path):
    vertices, faces = [], []
    for line in open(path):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(w) for w in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(w.split("/")[0]) for w in words[1:]])
    return vertices, faces


def write_wave(cage, path, moment):
    """Three heads in a row that swell along a wave: about 190 000 triangles at level 3."""
    vertices, faces = cage
    with open(path, "w") as file:
        for copy in range(3):
            for x, y, z in vertices:
                swell = 1 + 0.15 * math.sin(3 * z + 2 * math.pi * moment + copy)
                file.write("v %.6f %.6f %.6f\n" % (x * swell + 2.6 * copy - 2.6, y * swell, z + 3.2))
        for copy in range(3):
            for face in faces:
                file.write("f %s\n" % " ".join(str(v + copy * len(vertices)) for v in face))


def make_scenes(folder, script):
    run(["blender", "-b", "-P", script, "--", "save", folder + "/heads.blend"])
    exporter = os.path.join(HERE, "..", "..", "src", "blender", "export.py")
    run(["blender", "-b", folder + "/heads.blend", "--python-exit-code", "1", "-P", exporter, "--", folder + "/scene"])
    path = folder + "/scene/scene.toml"
    text = open(path).read()
    with open(path, "w") as file:  # Workbench draws no shadows
        file.write(re.sub(r"^shadow = .*\n", "", text, flags=re.M))
    meshes = [folder + "/scene/meshes/" + name for name in os.listdir(folder + "/scene/meshes")]
    cage = read_cage(max(meshes, key=os.path.getsize))  # the head, beside the plane
    for frame in range(1, FRAMES + 1):
        write_wave(cage, folder + "/scene/wave_%02d.obj" % frame, frame / FRAMES)
    move = ("[animation]\nframes = '1-%d'\n[[camera]]\nname = 'move'\nfocal_length = 50\nposition = { keys = [[1, "
            "[-1, -14, 8]], [%d, [1, -14, 8]]] }\nlook_at = [0, 0, 0.6]\n" % (FRAMES, FRAMES))
    wave = ("[[mesh]]\nname = 'wave'\nfile = '../scene/wave_##.obj'\nsubdivision = { level = 3, limit = true }\n"
            "[[instance]]\nname = 'wave'\nmesh = 'wave'\n")
    for name, more in (("still", ""), ("waving", wave)):
        os.mkdir(folder + "/" + name)
        with open(folder + "/" + name + "/scene.toml", "w") as file:
            file.write("include = ['../scene/scene.toml']\n" + move + more)
        with open(folder + "/" + name + "/config.toml", "w") as file:
            file.write("scene = 'scene.toml'\ncamera = 'move'\n[image]\nsize = [1280, 720]\n[shading]\ntechnique = "
                       "'toon'\n[ao]\ntechnique = 'toon_ssao'\nfilter = { technique = 'gaussian' }\n[[edges]]\n"
                       "technique = 'depth_normal'\n[output]\npath = 'picture_####.png'\n")
    source = folder + "/slow.c"
    with open(source, "w") as file:
        file.write(SLOW)
    run(["cc", "-shared", "-fPIC", "-O1", "-o", folder + "/slow.so", source, "-ldl"])


def further_frame(limn, folder, scene, samples, waits=None):
    """Milliseconds of a further frame, and the part of the cores that was busy meanwhile."""
    environment = dict(os.environ)
    if waits:
        environment.update(waits, LD_PRELOAD=folder + "/slow.so")
    command = [limn, "render", folder + "/" + scene + "/config.toml", "--set", "image.samples=%d" % samples]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment)
    saved, busy = [], []
    for line in process.stderr:
        if re.match(r"Saved: '", line):
            saved.append(time.monotonic())
            with open("/proc/%d/stat" % process.pid) as file:
                fields = file.read().rsplit(")", 1)[1].split()
            busy.append((int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"))
    if process.wait() or len(saved) != FRAMES:
        sys.exit("%s: %d frames of %d" % (command, len(saved), FRAMES))
    took = saved[-1] - saved[0]
    return 1000 * took / (FRAMES - 1), (busy[-1] - busy[0]) / took / len(os.sched_getaffinity(0))


def workbench(folder, script):
    text = run(["blender", "-b", "-P", script, "--", "workbench", folder + "/workbench.png"])
    return 1000 * float(re.search(r"^RENDER2_S workbench (.*)$", text, re.M).group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("limn")
    parser.add_argument("script")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    limn, script = os.path.abspath(options.limn), os.path.abspath(options.script)
    cases = {
        "still, 8 samples": ("still", 8, None),
        "still, 1 sample": ("still", 1, None),
        "waving, 8 samples": ("waving", 8, None),
        "waving, 1 sample": ("waving", 1, None),
        "waving, 1 sample, slow reading": ("waving", 1, {"WAIT_READ": "100"}),
        "waving, 1 sample, slow writing": ("waving", 1, {"WAIT_WRITE": "100"}),
        "waving, 8 samples, slow reading": ("waving", 8, {"WAIT_READ": "100"}),
        "waving, 8 samples, slow writing": ("waving", 8, {"WAIT_WRITE": "100"}),
    }
    with tempfile.TemporaryDirectory() as folder:
        make_scenes(folder, script)
        for scene, samples, waits in cases.values():
            further_frame(limn, folder, scene, samples, waits)  # programs, files and shaders come into caches
        rounds = []
        for _ in range(options.rounds):
            times = {name: further_frame(limn, folder, *case) for name, case in cases.items()}
            times["Workbench"] = (workbench(folder, script), 0)
            rounds.append(times)
        median = lambda value: statistics.median(value(times) for times in rounds)
        for name in rounds[0]:
            print("%-34s %8.1f ms a further frame, cores %3.0f %% busy"
                  % (name, median(lambda t: t[name][0]), 100 * median(lambda t: t[name][1])))
        for samples in ("8 samples", "1 sample"):
            still, waving = "still, " + samples, "waving, " + samples
            ratio = median(lambda t: t["Workbench"][0] / t[still][0])
            print("%s: %.1f times as fast as Workbench" % (samples, ratio))
            print("%s: %.2f times as long with the deforming figure" % (
                samples, median(lambda t: t[waving][0] / t[still][0])))
            for wait in ("reading", "writing"):
                slow = waving + ", slow " + wait
                hidden = median(lambda t: 1 - (t[slow][0] - t[waving][0]) / 100)
                print("%s: %.0f %% of 100 ms in %s hidden" % (samples, 100 * hidden, wait))


if __name__ == "__main__":
    main()
