#!/usr/bin/env python3
"""Opens limn's TIFF and PNG files with readers that share no code with limn: python3 tests/files/read_back.py LIMN

Draws one picture as TIFF and as PNG, of 8 and of 16 bits, opaque and transparent, and a sheet with a resolution. The
decoders below must find the same pixels in both; libtiff's own tools must read the TIFF without a word.
"""

import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "bench"))
import compare_builds  # noqa: E402

OBJ = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 -1 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 4 1 3\n"
SCENE = '[[mesh]]\nname = "m"\nfile = "m.obj"\n'
CONFIG = """
scene = "scene.toml"
[image]
size = [75, 53]
samples = 4
dpi = 300
background = %s
[shading]
technique = "lambert"
[output]
path = "picture.png"
bits = %d
"""

TIFF_TYPES = {1: "B", 2: "s", 3: "H", 4: "I", 5: "II", 11: "f", 12: "d"}


def tiff_tags(data):
    """The first directory of a TIFF: {tag: values}."""
    order = {b"II*\0": "<", b"MM\0*": ">"}[data[:4]]
    (at,) = struct.unpack(order + "I", data[4:8])
    (count,) = struct.unpack(order + "H", data[at : at + 2])
    tags = {}
    for i in range(count):
        tag, kind, number, _ = struct.unpack(order + "HHII", data[at + 2 + 12 * i : at + 14 + 12 * i])
        if kind not in TIFF_TYPES:
            continue
        form = order + ("%ds" % number if kind == 2 else TIFF_TYPES[kind] * number)
        size, place = struct.calcsize(form), at + 10 + 12 * i
        if size > 4:
            (place,) = struct.unpack(order + "I", data[place : place + 4])
        tags[tag] = struct.unpack(form, data[place : place + size])
    return order, tags


def tiff(path):
    """(width, height, channels, bits, samples in rows from the top), after TIFF 6.0."""
    data = open(path, "rb").read()
    order, tags = tiff_tags(data)
    missing = [tag for tag in (256, 257, 258, 273, 279) if tag not in tags]
    if missing:
        sys.exit("%s: no TIFF without its tags %s" % (path, missing))
    width, height, channels, bits = tags[256][0], tags[257][0], tags.get(277, (1,))[0], tags[258][0]
    assert tags.get(284, (1,))[0] == 1 and tags.get(274, (1,))[0] == 1, "channels interleaved, from the top"
    rows_of_strip, rows = tags.get(278, (height,))[0], []
    letter = {8: "B", 16: "H"}[bits]
    for strip, (offset, size) in enumerate(zip(tags[273], tags[279])):
        body = data[offset : offset + size]
        body = {1: lambda b: b, 8: zlib.decompress}[tags.get(259, (1,))[0]](body)
        for y in range(min(rows_of_strip, height - strip * rows_of_strip)):
            per_row = width * channels
            row = list(struct.unpack_from("%s%d%s" % (order, per_row, letter), body, y * per_row * bits // 8))
            if tags.get(317, (1,))[0] == 2:  # each sample as its difference from the pixel before
                for x in range(channels, per_row):
                    row[x] = (row[x] + row[x - channels]) & ((1 << bits) - 1)
            rows += row
    return (width, height, channels, bits, rows), tags


def png(path):
    """As tiff(), after the PNG specification."""
    raw = compare_builds.png_pixels(open(path, "rb").read())[""]
    width, height, bits, colour, _, _, interlaced = struct.unpack(">IIBBBBB", raw[:13])
    assert not interlaced
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    step, length = channels * bits // 8, width * channels * bits // 8
    above, samples = bytes(length), []
    for y in range(height):
        start = 13 + y * (length + 1)
        method, row = raw[start], bytearray(raw[start + 1 : start + 1 + length])
        for x in range(length):
            a, b, c = (row[x - step], above[x], above[x - step]) if x >= step else (0, above[x], 0)
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[x] = (row[x] + (0, a, b, (a + b) // 2, nearest)[method]) & 255
        samples += struct.unpack(">%d%s" % (width * channels, {8: "B", 16: "H"}[bits]), row)
        above = bytes(row)
    return width, height, channels, bits, samples


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode or done.stderr.strip():
        sys.exit("%s ends with %d\n%s" % (" ".join(command), done.returncode, done.stderr))
    return done.stdout


def main():
    limn = os.path.abspath(sys.argv[1])
    tools = shutil.which("tiffcp") and shutil.which("tiffinfo")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        open("m.obj", "w").write(OBJ)
        open("scene.toml", "w").write(SCENE)
        for bits in (8, 16):
            for background, channels in (('"#d9cfbc"', 3), ('"transparent"', 4)):
                what = "%d bits, background %s" % (bits, background)
                open("config.toml", "w").write(CONFIG % (background, bits))
                for extension in ("png", "tif"):
                    run(limn, "--quiet", "render", "config.toml", "--output", "a." + extension)
                wanted = png("a.png")
                if wanted[:4] != (75, 53, channels, bits) or len(set(wanted[4])) < 8:
                    sys.exit("%s: the PNG is no picture: %s" % (what, wanted[:4]))
                found, tags = tiff("a.tif")
                if found != wanted:
                    sys.exit("%s: TIFF and PNG differ: %s and %s" % (what, found[:4], wanted[:4]))
                if tags[282] != tags[283] or tags[282][0] != 300 * tags[282][1] or tags[296] != (2,):
                    sys.exit("%s: 300 dots per inch became %s" % (what, (tags[282], tags[296])))
                if channels == 4 and tags.get(338) != (2,):
                    sys.exit("%s: alpha is not marked as unassociated: %s" % (what, tags.get(338)))
                if tools:
                    run("tiffinfo", "-D", "a.tif")
                    run("tiffcp", "-c", "none", "-r", "1", "a.tif", "b.tif")
                    if tiff("b.tif")[0] != wanted:
                        sys.exit("%s: libtiff reads other pixels" % what)
        print("TIFF and PNG hold the same pixels%s" % ("" if tools else "; libtiff's tools are not installed"))


if __name__ == "__main__":
    main()
