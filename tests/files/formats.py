#!/usr/bin/env python3
"""Opens every kind of file that limn writes with programs of others: python3 tests/files/formats.py LIMN [--table]

One scene is drawn in every format, bit depth and layout (whole, in tiles, cropped), opaque and transparent, with every
AOV. Readers: the few lines of read_back.py and compare_builds.py, ImageMagick, netpbm (libpng), libtiff's tools,
OpenEXR's exrinfo, and Chromium. Lossless files must hold the same numbers for all of them. JPEG may differ by 2/255
between decoders, and keeps at least 40 dB to the lossless picture. Programs that are not installed are named.
"""

import base64
import itertools
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "bench")]
import compare_builds  # noqa: E402
import read_back  # noqa: E402

SIZE = 75, 53
AOVS = ["ambient_occlusion", "ambient_occlusion_raw", "shade", "albedo", "edges", "normal", "normal_geometric", "depth",
        "position", "object_id", "material_id"]
CONFIG = """
scene = "scene.toml"
[image]
size = [75, 53]
samples = 4
background = %s
[shading]
technique = "lambert"
[ao]
technique = "gtao"
filter = { technique = "plane_aware" }
[[edges]]
technique = "depth_normal"
[output]
path = "picture.exr"
aovs = [%s]
"""
LAYOUTS = {"whole": [], "tiles": ["--set", "image.tile=32"], "crop": ["--crop", "10,7,41,29"]}
PAGE = """<body onload="show()">%s<script>
function show() {
  const lines = [];
  for (const image of document.images) {
    const canvas = document.createElement("canvas");
    canvas.width = image.naturalWidth; canvas.height = image.naturalHeight;
    const context = canvas.getContext("2d"); context.drawImage(image, 0, 0);
    lines.push(Array.from(context.getImageData(0, 0, canvas.width, canvas.height).data).join(","));
  }
  document.body.textContent = lines.join(";");
}
</script></body>"""


def tool(name):
    return shutil.which(name)


def run(*command):
    done = subprocess.run(command, capture_output=True)
    if done.returncode or (done.stderr.strip() and command[0] != "chromium"):
        sys.exit("%s ends with %d\n%s" % (" ".join(command), done.returncode, done.stderr.decode()))
    return done.stdout


def fail(what, *values):
    sys.exit("%s: %s" % (what, " ".join(str(v) for v in values)))


def magick(path, channels, bits):
    """Samples of a picture as ImageMagick decodes it."""
    kind = {1: "gray", 3: "rgb", 4: "rgba"}[channels]
    raw = run("convert-im6.q16", path, "-depth", str(bits), "-endian", "LSB", kind + ":-")
    return list(memoryview(raw).cast("B" if bits == 8 else "H"))


def pnm(path, channels, bits):
    """Samples of an opaque picture as netpbm decodes it, by libpng or libtiff."""
    command = ["pngtopnm"] if path.endswith("png") else ["tifftopnm", "-quiet", "-byrow"]  # by row: all 16 bits
    data = run(*command, path)
    kind, size, most, raw = re.match(rb"(P[56])\s+(\d+ \d+)\s+(\d+)\s(.*)", data, re.S).groups()
    if (kind, int(most)) != (b"P6" if channels == 3 else b"P5", (1 << bits) - 1):
        fail(path, "netpbm finds", kind, most)
    return list(raw) if bits == 8 else [raw[i] << 8 | raw[i + 1] for i in range(0, len(raw), 2)]


def chromium(paths):
    """RGBA of 8 bits of each picture, as Chromium shows it."""
    tags = ["<img src='data:image/%s;base64,%s'>" % ("png" if path.endswith("png") else "jpeg",
                                                     base64.b64encode(open(path, "rb").read()).decode())
            for path in paths]
    open("page.html", "w").write(PAGE % "".join(tags))
    text = run("chromium", "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom",
               "file://" + os.path.abspath("page.html")).decode()
    found = re.search(r"<body[^>]*>([\d,;]+)</body>", text)
    if not found:
        fail("Chromium", "shows no pictures", text[:300])
    return [[int(v) for v in part.split(",")] for part in found.group(1).split(";")]


def draw(limn, output, settings=(), warns=False):
    command = [limn, "render", "config.toml", "--output", output, *settings]
    done = subprocess.run(command, capture_output=True, text=True)
    lines = (done.stdout + done.stderr).splitlines()
    said = [line for line in lines if not line.startswith("Saved: ") and "..." not in line]  # "...": progress
    if done.returncode or bool(said) != warns:
        fail(output, done.returncode, said)
    return said


def write_scene(transparent):
    open("m.obj", "w").write(read_back.OBJ)
    open("scene.toml", "w").write(read_back.SCENE)
    names = ", ".join('"%s"' % name for name in ["beauty", *AOVS])
    open("config.toml", "w").write(CONFIG % ('"transparent"' if transparent else '"#d9cfbc"', names))


def lossless(limn, bits, transparent, layout):
    """PNG and TIFF of one kind: every reader finds the same samples. Returns them."""
    what = "%d bits, %s, %s" % (bits, "transparent" if transparent else "opaque", layout)
    channels, settings = 4 if transparent else 3, ["--set", "output.bits=%d" % bits, *LAYOUTS[layout]]
    draw(limn, "a.png", settings)
    draw(limn, "a.tif", settings)
    width, height, found_channels, found_bits, wanted = read_back.png("a.png")
    size = (41, 29) if layout == "crop" else SIZE
    if (width, height, found_channels, found_bits) != (*size, channels, bits) or len(set(wanted)) < 8:
        fail(what, "the PNG is no such picture")
    readers = {"TIFF, own lines": read_back.tiff("a.tif")[0][4]}
    if tool("convert-im6.q16"):
        readers.update({"ImageMagick, " + e: magick("a." + e, channels, bits) for e in ("png", "tif")})
    if tool("pngtopnm") and not transparent:
        readers.update({"netpbm, " + e: pnm("a." + e, channels, bits) for e in ("png", "tif")})
    if tool("tiffinfo"):
        run("tiffinfo", "-D", "a.tif")
    for reader, samples in readers.items():
        if samples != wanted:
            fail(what, reader, "finds other samples:", sum(a != b for a, b in zip(samples, wanted)), "of", len(wanted))
    for name in AOVS:
        same_aov(what, name, bits)
    return what, wanted, len(readers)


def same_aov(what, name, bits):
    """An AOV beside a PNG and beside a TIFF holds the same numbers."""
    exact = "a.%s.exr" % name
    if os.path.exists(exact):
        if tool("exrinfo"):
            run("exrinfo", "-s", exact)
        os.rename(exact, "kept." + exact)
        return
    png, tif = read_back.png("a.%s.png" % name), read_back.tiff("a.%s.tif" % name)[0]
    if png != tif or png[3] != bits:
        fail(what, name, "differs between PNG and TIFF")
    if tool("convert-im6.q16") and magick("a.%s.png" % name, png[2], bits) != png[4]:
        fail(what, name, "ImageMagick finds other samples")


def encoded(linear):
    x = min(max(linear, 0.0), 1.0)
    return round(65535 * (12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055))


def multilayer(limn, transparent, layout, wanted16):
    """An EXR of all AOVs: beauty as in the PNG, and each AOV as in its own file."""
    what = "EXR, %s, %s" % ("transparent" if transparent else "opaque", layout)
    draw(limn, "a.exr", LAYOUTS[layout])
    if tool("exrinfo"):
        run("exrinfo", "-s", "a.exr")
    channels = compare_builds.exr_channels(open("a.exr", "rb").read())
    values = {name: compare_builds.numbers(kind, raw) for name, (kind, raw) in channels.items()}
    alpha = values["A"]
    for c, name in enumerate("RGB"):
        for i, a in enumerate(alpha):
            # Half floats have eleven bits: 2^-12 of the value at most, which display encoding halves; near black more.
            # Below an alpha of 1/255 halves are too coarse to divide by.
            seen = encoded(values[name][i] / a if a > 0 else 0.0)
            wanted = wanted16[i * (4 if transparent else 3) + c]
            if (a == 0 or a > 1 / 255) and abs(seen - wanted) > (20 if a == 1 else 60):
                fail(what, "beauty", name, i, seen, wanted)
    compared = 0
    for name in AOVS:
        own = "kept.a.%s.exr" % name
        if not os.path.exists(own):
            continue
        for channel, (kind, raw) in compare_builds.exr_channels(open(own, "rb").read()).items():
            together = channels[channel if channel.startswith(name) else "%s.%s" % (name, channel)]
            if together != (kind, raw):
                fail(what, name, channel, "differs from its own file")
            compared += 1
        os.remove(own)
    return what, compared


def jpeg(limn, transparent, layout, to):
    """A JPEG says that it cannot be transparent, and nothing else."""
    said = draw(limn, to, LAYOUTS[layout], warns=transparent)
    if transparent and "transparent" not in said[0]:
        fail(to, said)


def decibels(samples, wanted):
    error = sum((a - b) ** 2 for a, b in zip(samples, wanted)) / len(wanted)
    return 10 * math.log10(255**2 / max(error, 1e-9))


def compare_jpegs(pictures):
    """Decoders of JPEG agree, and the picture is near the lossless one. `pictures`: name, what, RGB or nothing."""
    shown = chromium([name for name, _, _ in pictures]) if tool("chromium") else []
    for p, (name, what, wanted) in enumerate(pictures):
        decoded = {"Chromium": [v for i, v in enumerate(shown[p]) if i % 4 != 3]} if shown else {}
        if tool("convert-im6.q16"):
            decoded["ImageMagick"] = magick(name, 3, 8)
        for one, other in itertools.combinations(decoded.values(), 2):
            if len(one) != len(other) or max(abs(a - b) for a, b in zip(one, other)) > 2:
                fail(what, "decoders differ by", max(abs(a - b) for a, b in zip(one, other)))
        worst = min((decibels(samples, wanted) for samples in decoded.values()), default=99) if wanted else 99
        if worst < 40:
            fail(what, "keeps %.1f dB" % worst)
        yield "%s: %d decoders%s" % (what, len(decoded), ", %.1f dB" % worst if wanted else "")


def compare_pngs(pictures):
    """PNGs as Chromium shows them: opaque pixels and alpha are the file's. `pictures`: name, channels, samples."""
    shown = chromium([name for name, _, _ in pictures])
    for (path, channels, wanted), rgba in zip(pictures, shown):
        for i in range(len(rgba) // 4):
            pixel = wanted[i * channels : (i + 1) * channels] + [255] * (4 - channels)
            if rgba[4 * i + 3] != pixel[3] or (pixel[3] == 255 and rgba[4 * i : 4 * i + 3] != pixel[:3]):
                fail(path, "Chromium shows another pixel", i, rgba[4 * i : 4 * i + 4], pixel)


def main():
    limn, table, pngs, jpegs = os.path.abspath(sys.argv[1]), [], [], []
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for transparent, layout in itertools.product((False, True), LAYOUTS):
            write_scene(transparent)
            of_bits = {}
            for bits in (8, 16):
                what, of_bits[bits], readers = lossless(limn, bits, transparent, layout)
                table.append("PNG and TIFF, %s: %d readers, 0 differences" % (what, readers))
                if bits == 8:
                    pngs.append(("kept%d.png" % len(pngs), 4 if transparent else 3, of_bits[8]))
                    shutil.copy("a.png", pngs[-1][0])
            what, compared = multilayer(limn, transparent, layout, of_bits[16])
            table.append("%s: beauty, and %d channels of AOVs as in their own files" % (what, compared))
            jpegs.append(("kept%d.jpg" % len(jpegs), what.replace("EXR", "JPEG"), None if transparent else of_bits[8]))
            jpeg(limn, transparent, layout, jpegs[-1][0])
        table += compare_jpegs(jpegs)
        if tool("chromium"):
            compare_pngs(pngs)
            table.append("Chromium: %d PNGs as they are" % len(pngs))
    if "--table" in sys.argv:
        print("\n".join(table))
    missing = [name for name in ("convert-im6.q16", "pngtopnm", "tiffinfo", "exrinfo", "chromium") if not tool(name)]
    print("%d kinds of files read%s" % (len(table), "; not installed: " + ", ".join(missing) if missing else ""))


if __name__ == "__main__":
    main()
