#!/usr/bin/env python3
"""Saves files under the eyes of limn watch: python3 tests/jobs/watch.py LIMN

Every kind of file that a picture is read from is changed, whole and broken, and each time the picture must become what
limn render makes of the files, to the byte.
"""

import os
import signal
import subprocess
import sys
import tempfile
import time

CONFIG = """include = ["style.toml"]
scene = "scene.toml"
[image]
size = [96, 64]
samples = 1
[output]
path = "picture.png"
"""
STYLE = '[shading]\ntechnique = "flat"\n[[edges]]\ntechnique = "mesh_lines"\n'
SCENE = '[[mesh]]\nname = "m"\nfile = "m.obj"\n[[camera]]\nposition = [2, 3, 5]\nlook_at = [0, 0, 0]\nfov = 40\n'
MESH = "mtllib m.mtl\nusemtl red\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 1.2 0\n" \
       "f 1 2 3 4\nf 2 1 5\nf 3 2 5\nf 4 3 5\nf 1 4 5\n"
MATERIAL = "newmtl red\nKd %s\n"


def write(path, text):
    """As editors save: whole, by a new name."""
    with open(path + "~", "w") as f:
        f.write(text)
    os.replace(path + "~", path)


def read(path):
    with open(path, "rb") as f:
        return f.read()


def wait(what, is_so):
    end = time.time() + 60
    while not is_so():
        assert time.time() < end, "waited a minute for " + what
        time.sleep(0.02)


def main():
    limn = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        files = {"picture.toml": CONFIG, "style.toml": STYLE, "scene.toml": SCENE, "m.obj": MESH,
                 "m.mtl": MATERIAL % "0.8 0.1 0.1"}
        for path, text in files.items():
            write(path, text)
        with open("log", "w") as log:
            watch = subprocess.Popen([limn, "watch", "picture.toml"], stdout=log, stderr=log)
        try:
            wait("the first picture", lambda: os.path.exists("picture.png"))
            for path, text in [
                ("picture.toml", CONFIG.replace("[96, 64]", "[80, 60]")),
                ("style.toml", STYLE.replace('"flat"', '"lambert"')),
                ("scene.toml", SCENE.replace("fov = 40", "fov = 30")),
                ("m.obj", MESH.replace("v 0 1.2 0", "v 0.2 0.9 0")),
                ("m.mtl", MATERIAL % "0.1 0.2 0.9"),
            ]:
                # What is broken is said, and leaves the picture as it was.
                if path != "m.mtl":
                    before, said = read("picture.png"), open("log").read().count("error: ")
                    write(path, "[nonsense\n" if path.endswith("toml") else "v 1 2 3\n")
                    wait("an error in " + path, lambda: open("log").read().count("error: ") > said)
                    assert read("picture.png") == before, path
                write(path, text)
                subprocess.run([limn, "--quiet", "render", "picture.toml", "--output", "truth.png"], check=True)
                truth = read("truth.png")
                wait("the picture after " + path, lambda: read("picture.png") == truth)
                print("%-14s followed" % path)
        finally:
            watch.send_signal(signal.SIGTERM)
            code = watch.wait()
        assert code == -signal.SIGTERM or code == 128 + signal.SIGTERM, code
        left = [name for name in os.listdir(".") if name.endswith("~") or ".tmp" in name or name.startswith(".")]
        assert not left, left
    print("the picture follows its files")
    return 0


if __name__ == "__main__":
    sys.exit(main())
