#!/usr/bin/env python3
"""Milliseconds of each part, and peak memory, over triangle counts: tests/bench/scale.py LIMN CAGE.obj [LEVEL...]

Draws the limit surface of a cage of quads at rising levels, one sample, 1280×720, ambient occlusion and lines.
"""

import json
import os
import sys
import tempfile


def main():
    limn, cage = sys.argv[1], sys.argv[2]
    levels = [int(level) for level in sys.argv[3:]] or [1, 2, 3, 4, 5]
    faces = sum(1 for line in open(cage, errors="replace") if line.startswith("f "))
    names = None
    for level in levels:
        with tempfile.TemporaryDirectory() as folder:
            stats = os.path.join(folder, "stats.json")
            command = [
                limn,
                "--quiet",
                "render",
                cage,
                "--subdivide",
                str(level),
                "--set",
                "image.samples=1",
                "--output",
                os.path.join(folder, "picture.png"),
                "--stats",
                stats,
            ]
            child = os.fork()
            if child == 0:
                os.execvp(command[0], command)
            _, status, usage = os.wait4(child, 0)
            if status:
                sys.exit("limn failed at level %d" % level)
            frame = json.load(open(stats))[0]
        if names is None:
            names = list(frame["parts"])
            print(
                "%12s %10s %10s  %s" % ("triangles", "peak MiB", "total ms", "  ".join("%s" % name for name in names))
            )
        print(
            "%12d %10.0f %10.0f  %s"
            % (
                faces * 2 * 4**level,
                usage.ru_maxrss / 1024,
                frame["total"],
                "  ".join("%*.1f" % (len(name), frame["parts"].get(name, 0)) for name in names),
            ),
            flush=True,
        )


if __name__ == "__main__":
    main()
