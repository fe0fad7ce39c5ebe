#!/usr/bin/env python3
"""Runs that are killed, starved of disk and crowded: python3 tests/jobs/safety.py LIMN [--kills N] [--log FILE]

Whatever happens, each file is whole or as it was, no temporary stays, and --resume ends with the bits of a run that
nothing happened to.
"""

import argparse
import hashlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path.insert(0, HERE)
from scene import make  # noqa: E402

SEED = 16


def hashes(folder):
    """Of every file, by name."""
    return {
        name: hashlib.sha256(open(os.path.join(folder, name), "rb").read()).hexdigest()
        for name in sorted(os.listdir(folder))
    }


class Runs:
    def __init__(self, limn, place):
        self.limn, self.place, self.count = limn, place, 0

    def start(self, config, *arguments, **more):
        return subprocess.Popen(
            [self.limn, "render", config, *arguments],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            **more,
        )

    def run(self, config, *arguments, expect=0, **more):
        process = self.start(config, *arguments, **more)
        said = process.communicate(timeout=300)[1]
        assert process.returncode == expect, "%s ends with %s: %s" % (arguments, process.returncode, said)
        return said

    def fresh(self, **scene):
        self.count += 1
        return make(os.path.join(self.place, str(self.count)), **scene)


def out(config):
    return os.path.join(os.path.dirname(config), "out")


def reference(runs, **scene):
    """A whole run's files, and how long it took."""
    config = runs.fresh(**scene)
    began = time.monotonic()
    runs.run(config)
    return config, hashes(out(config)), time.monotonic() - began


def kills(runs, count, log):
    """kill -9, and SIGTERM now and then, at random moments."""
    chance = random.Random(SEED)
    scene = {"frames": 24, "aovs": '["beauty", "depth", "object_id"]', "width": 240, "height": 160}
    _, whole, took = reference(runs, **scene)
    config = runs.fresh(**scene)
    killed = files = 0
    while killed < count:
        shutil.rmtree(out(config), ignore_errors=True)
        # Several kills on the way to one whole set.
        for _ in range(chance.randint(1, 4)):
            number = signal.SIGTERM if chance.random() < 0.2 else signal.SIGKILL
            process = runs.start(config, "--resume")
            time.sleep(chance.uniform(0.02, 0.9) * took)
            process.send_signal(number)
            began = time.monotonic()
            process.communicate()
            if process.returncode != -number:
                assert process.returncode == 0, process.returncode
                continue
            killed += 1
            assert time.monotonic() - began < 10, "it took long to end"
            present = hashes(out(config)) if os.path.isdir(out(config)) else {}
            left = [name for name in present if name.startswith(".limn-")]
            own = [name for name in left if "-%d-" % process.pid in name]
            assert number == signal.SIGKILL or not own, "SIGTERM leaves %s" % own
            for name, found in present.items():
                assert name in left or whole[name] == found, "%s after kill %d is corrupt" % (name, killed)
            files += len(present)
            log("kill %d: signal %d, %d files whole, %d temporaries" % (killed, number, len(present), len(left)))
        runs.run(config, "--resume")
        assert hashes(out(config)) == whole, "resumed set differs after kill %d" % killed
    log("%d kills: 0 of %d files corrupt, every resumed set equal to the bit" % (killed, files))


def full_disk(runs, log):
    """A file size limit at every offset of a frame's files: 74, and what stood there before is unharmed."""
    for kind, aovs in [("png", '["beauty"]'), ("exr", '["beauty", "depth"]'), ("png", '["beauty", "depth", "normal"]')]:
        config = runs.fresh(frames=2, kind=kind, aovs=aovs, width=24, height=16)
        runs.run(config)
        before = hashes(out(config))
        largest = max(os.path.getsize(os.path.join(out(config), name)) for name in before)
        smallest = min(os.path.getsize(os.path.join(out(config), name)) for name in before)
        changed = ["--set", "shading.floor=0.9", "--frames", "1"]
        step = max(1, largest // 60)
        tried = 0
        for size in [0, 1, *range(2, largest, step), smallest - 1, largest - 1]:

            def limit(bytes_=size):
                resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_, bytes_))

            said = runs.start(config, *changed, preexec_fn=limit)
            text = said.communicate()[1]
            if said.returncode == 0:  # the other picture is smaller
                assert size > smallest // 2, size
                runs.run(config, "--frames", "1")
                continue
            assert said.returncode == 74, "limit %d: %s %s" % (size, said.returncode, text)
            assert hashes(out(config)) == before, "limit %d: files changed" % size
            tried += 1
        log("%s with %s: %d limits up to %d bytes: 74, the old set intact" % (kind, aovs, tried, largest))


def small_disk(runs, log):
    """A file system that runs full."""
    config = runs.fresh(frames=4, aovs='["beauty", "depth", "normal"]', width=320, height=200)
    runs.run(config)
    whole = hashes(out(config))
    largest = sum(os.path.getsize(os.path.join(out(config), name)) for name in whole)
    mount = os.path.join(runs.place, "tmpfs")
    os.makedirs(mount)
    size = max(65536, largest * 5 // 8)
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=%d" % size, "tmpfs", mount], capture_output=True).returncode:
        log("no small file system: mounting is not allowed here")
        return
    try:
        runs.run(config, "--output", mount + "/box_####.png", expect=74)
        found = hashes(mount)
        assert found and len(found) < len(whole) and len(found) % 3 == 0, "%d files on a full disk" % len(found)
        assert all(whole[name] == found[name] for name in found), "a file on a full disk differs"
        log("tmpfs of %d bytes: 74, %d of %d files, whole frames, no temporaries" % (size, len(found), len(whole)))
    finally:
        subprocess.run(["umount", mount], check=True)


def crowd(runs, log):
    """Eight processes on the same frames."""
    config, whole, _ = reference(runs)
    shutil.rmtree(out(config))
    crowd_ = [runs.start(config, "--threads", "1") for _ in range(8)]
    for process in crowd_:
        process.communicate()
        assert process.returncode == 0
    assert hashes(out(config)) == whole, "eight processes"
    log("eight processes on the same frames: all %d files right" % len(whole))


def partitions(runs, log):
    """Chunks, order, threads, one process per frame: 0 bits of difference."""
    config, whole, _ = reference(runs, frames=7)
    ways = {
        "chunks": [["--chunk", "%d/3" % i] for i in (1, 2, 3)],
        "reverse": [["--frames", "7-1"]],
        "one thread": [["--threads", "1"]],
        "one process per frame": [["--frames", str(i)] for i in range(1, 8)],
        "more chunks than frames": [["--chunk", "%d/9" % i] for i in range(1, 10)],
    }
    for name, commands in ways.items():
        shutil.rmtree(out(config))
        for command in commands:
            runs.run(config, *command)
        assert hashes(out(config)) == whole, name
    log("%s: 0 bits of difference" % ", ".join(ways))


def mixed(runs, log):
    """A set with files of another run, cut ones and missing ones is drawn again where it must be, and only there."""
    for kind in ("png", "exr", "tif", "jpg"):
        config = runs.fresh(kind=kind, aovs='["beauty", "depth"]')
        runs.run(config)
        whole = hashes(out(config))
        names = sorted(whole)
        said = runs.run(config, "--resume")
        assert said.count("Kept:") == 6 and "Saved:" not in said, said
        first, second, third = (os.path.join(out(config), "box_000%d.%s" % (i, kind)) for i in (1, 2, 3))
        with open(first, "r+b") as file:
            file.truncate(os.path.getsize(first) - 3)
        os.remove(second)
        other = os.path.join(os.path.dirname(config), "other")
        runs.run(config, "--set", "shading.floor=0.9", "--frames", "3", "--output", other + "/box_####." + kind)
        shutil.copy(os.path.join(other, "box_0003." + kind), third)
        said = runs.run(config, "--resume")
        assert said.count("Kept:") == 3, said
        assert "error" not in said.lower(), said
        assert hashes(out(config)) == whole, kind + ": " + str(names)
    log("mixed, cut and missing files: found and drawn again in PNG, EXR, TIFF and JPEG")


def failures(runs, log):
    """Codes, and frames that take too long."""
    config = runs.fresh()
    box = os.path.join(os.path.dirname(config), "box.obj")
    for arguments, code in [
        (["--chunk", "0/3"], 64),
        (["--chunk", "4/3"], 64),
        (["--chunk", "a"], 64),
        (["--progress", "loud"], 64),
        (["--frame-timeout", "0.0001", "--set", "image.size=[1600,1200]", "--set", "image.samples=64"], 75),
    ]:
        runs.run(config, *arguments, expect=code)
    stats = os.path.join(os.path.dirname(config), "stats.json")
    said = runs.run(config, "--frame-timeout", "0.0001", "--keep-going", "--set", "image.size=[1600,1200]", "--set",
                    "image.samples=64", "--frames", "1-2", "--stats", stats, expect=75)  # fmt: skip
    assert said.count("took longer than") == 2, said
    report = json.load(open(stats))
    assert report["failed"] == 2 and report["exit_code"] == 75, report
    assert [frame["outcome"] for frame in report["frames"]] == ["failed", "failed"], report
    for form, line in [("alf", "ALF_PROGRESS 100%"), ("openjd", "openjd_progress: 100")]:
        done = subprocess.run([runs.limn, "render", config, "--progress", form], capture_output=True, text=True)
        lines = done.stdout.splitlines()
        assert lines[-1] == line and len(lines) >= 6, done.stdout
        assert done.stderr.count("Saved: '") == 6, done.stderr
    os.remove(box)
    runs.run(config, "--resume", expect=66)
    log("exit codes, timeouts, --keep-going and progress as documented")


def edit(config, name, *pairs):
    """Changes a file beside the config."""
    path = os.path.join(os.path.dirname(config), name)
    text = open(path).read()
    for old, new in pairs:
        assert old in text, (name, old)
        text = text.replace(old, new)
    with open(path, "w") as file:
        file.write(text)


def alike(runs, log):
    """A frame does not depend on the frames drawn before it, and none is kept that would now be another."""
    # The motion AOV depends on the frame before: frames that rest are not all the same.
    config = runs.fresh(kind="exr", aovs='["beauty", "motion", "object_id"]')
    runs.run(config)
    whole = hashes(out(config))
    for frame in (5, 6):
        runs.run(config, "--frames", str(frame))
    assert hashes(out(config)) == whole, "motion"
    # An open shutter: what is hidden at the frame's own time may be there at others, and files of other frames too.
    config = runs.fresh(frames=5)
    edit(config, "config.toml", ("samples = 2", "samples = 8\nshutter = 3"))
    edit(config, "scene.toml", ('file = "box.obj"', 'file = "box_##.obj"'))
    here = os.path.dirname(config)
    for frame in range(1, 6):
        shutil.copy(os.path.join(here, "box.obj"), os.path.join(here, "box_%02d.obj" % frame))
    runs.run(config)
    whole = hashes(out(config))
    for frame in (3, 1, 5):
        runs.run(config, "--frames", str(frame))
    assert hashes(out(config)) == whole, "shutter"
    edit(config, "box_04.obj", ("v 1 1 1", "v 1 2 1"))
    said = runs.run(config, "--resume")
    kept = [line for line in said.splitlines() if line.startswith("Kept:")]
    assert [line for line in kept if "0001" in line] and not [line for line in kept if "0003" in line], said
    # The first frame's mesh frames every other one where no camera does.
    config = runs.fresh(frames=3)
    edit(config, "scene.toml", ('file = "box.obj"', 'file = "box_##.obj"'), ("[[camera]]", "[[light]]"),
         ("position = [3, 2, 4]\nlook_at = [0, 0, 0]\nfov = 45", "direction = [-1, -2, -1]"))  # fmt: skip
    here = os.path.dirname(config)
    for frame in range(1, 4):
        shutil.copy(os.path.join(here, "box.obj"), os.path.join(here, "box_%02d.obj" % frame))
    runs.run(config)
    edit(config, "box_01.obj", ("v 1 1 1", "v 1 3 1"))
    said = runs.run(config, "--resume")
    assert "Kept:" not in said, said
    log("frames with motion, an open shutter and a framing camera are what they are alone")


def accounts(runs, log):
    """What a run says of itself where some of it fails."""
    config = runs.fresh(frames=3)
    edit(config, "scene.toml", ('file = "box.obj"', 'file = "box_##.obj"'))
    here = os.path.dirname(config)
    for frame in (1, 2, 3):
        shutil.copy(os.path.join(here, "box.obj"), os.path.join(here, "box_%02d.obj" % frame))
    runs.run(config)
    with open(os.path.join(here, "box_03.obj"), "w") as file:
        file.write("v 0 0 0\nf 1 2 3\n")
    stats = os.path.join(here, "stats.json")
    runs.run(config, "--resume", "--keep-going", "--stats", stats, expect=1)
    report = json.load(open(stats))
    assert (report["kept"], report["failed"], report["exit_code"]) == (2, 1, 1), report
    shutil.rmtree(out(config))
    runs.run(config, "--stats", stats, expect=65)
    report = json.load(open(stats))
    assert (report["drawn"], report["failed"], report["exit_code"]) == (2, 1, 65), report
    assert sorted(os.listdir(out(config))) == ["box_0001.png", "box_0002.png"]

    def no_space():
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))

    process = runs.start(config, "--keep-going", "--frames", "1-2", "--set", "shading.floor=0.9", preexec_fn=no_space)
    process.communicate()
    assert process.returncode == 74, process.returncode
    log("reports and exit codes count what was kept, drawn and failed")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("limn")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--log")
    options = parser.parse_args()
    lines = []

    def log(line):
        lines.append(line)
        if not line.startswith("kill "):
            print(line, flush=True)

    with tempfile.TemporaryDirectory() as place:
        runs = Runs(os.path.abspath(options.limn), place)
        for part in (partitions, mixed, alike, crowd, failures, accounts, full_disk, small_disk):
            part(runs, log)
        kills(runs, options.kills, log)
    if options.log:
        with open(options.log, "w") as file:
            file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
