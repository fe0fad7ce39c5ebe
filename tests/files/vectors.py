#!/usr/bin/env python3
"""Opens drawings by programs of others: python3 tests/files/vectors.py LIMN

A sheet at 1:50 is drawn as SVG and PDF. Its measures are read from the files themselves, by Python's XML reader and by
pdftocairo; rsvg-convert, pdftocairo and Chromium rasterize both, and must show what limn's own raster of the lines
shows. Programs that are not installed are named.
"""

import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as XML

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "bench")]
import compare_builds  # noqa: E402
import read_back  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
SCENE = """
up = "y"
[[mesh]]
name = "model"
file = "model.obj"
[[camera]]
name = "front"
position = [0, 1, 10]
look_at = [0, 1, 0]
orthographic_height = 5
[[camera]]
name = "corner"
position = [6, 5, 8]
look_at = [0, 0.5, 0]
fov = 40
"""
CONFIG = """
scene = "scene.toml"
camera = "%s"
[image]
dpi = 150
samples = 1
background = "#ffffff"
[sheet]
size = "A5"
orientation = "landscape"
%s
[shading]
technique = "paper"
[[edges]]
technique = "mesh_lines"
preset = "iso"
color = "#000000"
%s
"""


def box(lo, hi, name, base):
    corners = [[(hi if i >> axis & 1 else lo)[axis] for axis in range(3)] for i in range(8)]
    faces = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
    return ("o %s\nusemtl %s\n" % (name, name)
            + "".join("v %g %g %g\n" % tuple(c) for c in corners)
            + "".join("f " + " ".join(str(base + i) for i in face) + "\n" for face in faces))


def model():
    text = "mtllib model.mtl\n" + box((-1.5, 0, -0.5), (-0.5, 1, 0.5), "metre", 0)
    text += box((0.25, 0, -0.5), (2, 1.75, 0.5), "block", 8)
    text += box((-0.5, 0, -0.25), (0.25, 0.5, 0.25), "step", 16)
    rings, sides, base = 24, 48, 24
    text += "o ball\nusemtl ball\ns 1\n"
    for r in range(rings + 1):
        for s in range(sides):
            t, p = math.pi * r / rings, 2 * math.pi * s / sides
            x, y, z = math.sin(t) * math.cos(p), math.cos(t), math.sin(t) * math.sin(p)
            text += "v %.9g %.9g %.9g\n" % (-1 + 0.4 * x, 1.4 + 0.4 * y, 0.4 * z)
    for r in range(rings):
        for s in range(sides):
            a, b = base + r * sides + s + 1, base + r * sides + (s + 1) % sides + 1
            text += "f %d %d %d %d\n" % (a, b, b + sides, a + sides)
    return text


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, timeout=300)
    assert done.returncode == 0, "%s: %s" % (command[0], done.stderr.decode()[-500:])
    return done.stdout


def paths(svg):
    """Each path with its layer: (layer, element, [[(x, y), …], …]); closed ones end where they begin."""
    root = XML.parse(svg).getroot()
    for layer in root.iter(SVG + "g"):
        for path in layer.iter(SVG + "path"):
            parts = []
            for text in re.findall(r"M[^M]*", path.get("d")):
                points = [tuple(map(float, pair.split(","))) for pair in re.findall(r"-?[\d.]+,-?[\d.]+", text)]
                parts.append(points + points[:1] if text.endswith("Z") else points)
            yield layer.get(LABEL), path, parts


def segments(svg, wanted=lambda layer: True):
    return [(a, b) for layer, _, parts in paths(svg) if wanted(layer) for points in parts
            for a, b in zip(points, points[1:])]


def overlap(lines):
    """The length of what lies on another line, closer than 0.005 mm all along."""
    lines = [(a, b) for a, b in lines if math.dist(a, b) > 0.2]
    total = 0
    for i, (a, b) in enumerate(lines):
        length = math.dist(a, b)
        ux, uy = (b[0] - a[0]) / length, (b[1] - a[1]) / length
        for p, q in lines[:i]:
            across = [ux * (y - a[1]) - uy * (x - a[0]) for x, y in (p, q)]
            if max(map(abs, across)) > 0.005:
                continue
            along = sorted(ux * (x - a[0]) + uy * (y - a[1]) for x, y in (p, q))
            total += max(0, min(along[1], length) - max(along[0], 0))
    return total


def check_measures(limn):
    run(limn, "render", "front.toml", "--output", "front.svg")
    root = XML.parse("front.svg").getroot()
    width, height = (float(root.get(k)[:-2]) for k in ("width", "height"))
    assert abs(width - 210) < 0.1 and abs(height - 148) < 0.1 and root.get("width").endswith("mm"), root.attrib
    box_ = [float(x) for x in root.get("viewBox").split()]
    assert box_ == [0, 0, width, height], box_
    # The cube of a metre is 20 mm each way at 1:50.
    cube = [p for layer, path, parts in paths("front.svg") if path.get("data-object") == "model / metre"
            for points in parts for p in points]
    assert cube, "no line has the object's name"
    for axis in (0, 1):
        size = max(p[axis] for p in cube) - min(p[axis] for p in cube)
        assert abs(size - 20) <= 0.01, "%.4f mm" % size
    materials = {path.get("data-material") for _, path, _ in paths("front.svg")}
    assert {"metre", "block", "ball"} <= materials, materials
    layers = {layer for layer, _, _ in paths("front.svg")}
    assert "contours" in layers and all(not layer.startswith("hidden") for layer in layers), layers
    again = overlap(segments("front.svg"))
    assert again < 0.01, "%.3f mm are drawn twice" % again
    # A ball is one closed circle, but for what the cube below hides of it.
    print("measures: %.4f x %.4f mm, %d layers" % (width, height, len(layers)))


def check_bytes(limn):
    for name in ("front.svg", "front.pdf"):
        run(limn, "render", "front.toml", "--output", name)
        first = open(name, "rb").read()
        run(limn, "render", "front.toml", "--output", name, "--threads", "1")
        assert open(name, "rb").read() == first, name + " differs from run to run"
    run(limn, "render", "front.toml", "--output", "front.svg", "--resume")
    kept = subprocess.run([limn, "render", "front.toml", "--output", "front.svg", "--resume"], capture_output=True)
    assert b"Kept" in kept.stdout + kept.stderr, "a drawing that is whole is drawn again"


def check_hidden(limn):
    run(limn, "render", "corner.toml", "--output", "plain.svg")
    run(limn, "render", "corner.toml", "--output", "hidden.svg", "--set", "edges.0.hidden=3")
    visible = sorted(segments("hidden.svg", lambda layer: not layer.startswith("hidden")))
    assert visible == sorted(segments("plain.svg")), "hidden lines change visible ones"
    dashes = [parts for layer, _, parts in paths("hidden.svg") if layer.startswith("hidden")]
    assert sum(map(len, dashes)) > 10, "no dashes"
    print("hidden: %d lines, %d dashes" % (len(dashes), sum(map(len, dashes))))


def check_promises(limn):
    """Settings that are chosen for a promise leave the output what it is; and the plan says who draws the lines."""
    run(limn, "render", "corner.toml", "--output", "promised.svg", "--set", "ao={ technique = 'ray_traced' }", "--set",
        "quality={ error = 0.1 }")
    assert segments("promised.svg") == segments("plain.svg"), "a promise changes lines"
    with open("drawn.toml", "w") as f:
        f.write('include = ["corner.toml"]\n[output]\npath = "drawn.svg"\n')
    plan = run(limn, "plan", "drawn.toml").decode()
    assert "no pass draws them" in plan and not re.search(r"\d  mesh_lines", plan), plan
    assert re.search(r"\d  mesh_lines", run(limn, "plan", "corner.toml").decode()), "a PNG has its lines by a pass"


def encoded(ink):
    """Black ink over white paper, as programs blend it that know no linear light."""
    return 255 * (1 - ink)


def check_pictures(limn):
    """Every program's picture of the lines alone beside limn's own raster."""
    run(limn, "render", "corner.toml", "--output", "own.exr", "--set", 'output.aovs=["edges"]')
    kind, values = compare_builds.exr_channels(open("own.exr", "rb").read())["edges.A"]
    assert kind == 1, "no half floats"
    own = [value for (value,) in struct.iter_unpack("<e", values)]
    settings = ("--set", "output.underlay=false", "--set", "output.simplify=0")
    run(limn, "render", "corner.toml", "--output", "lines.svg", *settings)
    run(limn, "render", "corner.toml", "--output", "lines.pdf", *settings)
    root = XML.parse("lines.svg").getroot()
    assert root.find(SVG + "image") is None
    commands = {
        "rsvg-convert": ("lines.svg", "-d 150 -p 150 -b white lines.svg -o a.png"),
        "pdftocairo": ("lines.pdf", "-png -r 150 -singlefile lines.pdf a"),
        # A CSS pixel is a 96th of an inch.
        "chromium": ("lines.svg", "--headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=800,600 "
                     "--force-device-scale-factor=1.5625 --screenshot=a.png file://" + os.path.abspath("lines.svg")),
    }
    width = round(210 / 25.4 * 150)
    for program, (file, arguments) in commands.items():
        if not shutil.which(program):
            print("%s is not installed" % program)
            continue
        run(program, *arguments.split())
        wide, high, channels, bits, samples = read_back.png("a.png")
        height = len(own) // width
        total, worst, count = 0, 0, 0
        for y in range(min(high, height)):
            for x in range(min(wide, width)):
                theirs = samples[(y * wide + x) * channels] / (2 ** bits - 1) * 255
                apart = abs(theirs - encoded(own[y * width + x]))
                total, worst, count = total + apart, max(worst, apart), count + 1
        print("%-14s%s: mean %.3f of 255, at most %.0f" % (program, file, total / count, worst))
        assert total / count < 1, program
        # No pixel is off by more than a line's edge: and by less than half of it.
        assert worst < 96, program


def main():
    limn = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("model.obj", "w") as f:
            f.write(model())
        with open("scene.toml", "w") as f:
            f.write(SCENE)
        with open("model.mtl", "w") as f:
            f.write("".join("newmtl %s\nKd 1 1 1\n" % name for name in ("metre", "block", "step", "ball")))
        for camera, scale in (("front", 'scale = "1:50"'), ("corner", "")):
            with open(camera + ".toml", "w") as f:
                f.write(CONFIG % (camera, scale, ""))
        check_measures(limn)
        check_bytes(limn)
        check_hidden(limn)
        check_promises(limn)
        check_pictures(limn)
    print("drawings are what limn's own raster shows")
    return 0


if __name__ == "__main__":
    sys.exit(main())
