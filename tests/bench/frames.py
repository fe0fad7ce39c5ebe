#!/usr/bin/env python3
"""Long sequences: python3 tests/bench/frames.py LIMN CONFIG FRAMES [--set KEY=VALUE ...]

Draws them in one process, and prints how memory and time per frame change from frame 20 on, and how busy the cores
were. CONFIG's scene should repeat itself beyond its frames.
"""

import os
import re
import statistics
import subprocess
import sys
import tempfile
import time


def memory(process):
    """Resident bytes."""
    with open("/proc/%d/statm" % process) as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def main():
    limn, config, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
    with tempfile.TemporaryDirectory() as place:
        command = [limn, "render", config, "--frames", "1-%d" % count, "--output", place + "/f_#####.png"]
        process = subprocess.Popen(command + sys.argv[4:], stderr=subprocess.PIPE, text=True)
        saved, memories = [], []
        for line in process.stderr:
            if re.match(r"Saved: '.*f_\d+\.png'", line):
                saved.append(time.monotonic())
                memories.append(memory(process.pid))
        _, status, usage = os.wait4(process.pid, 0)
        assert status == 0 and len(saved) == count, (status, len(saved))
        steps = [b - a for a, b in zip(saved, saved[1:])]
        early, late = statistics.median(steps[20:120]), statistics.median(steps[-100:])
        first, last = statistics.median(memories[19:39]), statistics.median(memories[-20:])
        busy = (usage.ru_utime + usage.ru_stime) / (saved[-1] - saved[0]) / len(os.sched_getaffinity(0))
        print("%d frames" % count)
        held = (first / 2**20, last / 2**20, 100 * (last / first - 1))
        print("memory  %.1f MiB at frame 20, %.1f MiB at the end: %+.2f %%" % held)
        took = (1000 * early, 1000 * late, 100 * (late / early - 1))
        print("time    %.1f ms a frame early, %.1f ms late: %+.2f %%" % took)
        print("cores   %.0f %% busy" % (100 * busy))


if __name__ == "__main__":
    main()
