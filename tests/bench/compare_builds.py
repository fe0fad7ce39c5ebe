#!/usr/bin/env python3
"""Compares the pixels of two builds: python3 tests/bench/compare_builds.py OLD NEW [--only TEXT] [--keep DIR]

OLD and NEW are limn programs. Both draw every config of render_configs, every panel of render_configs/sheets, and a
test picture of each technique in each of its presets, whole and in tiles, of 8 and of 3 samples. Files are opened
without any code of limn's: PNG and EXR by the few lines below, JPEG and TIFF by their bytes. Prints what differs and by
how much; the exit code is 1 where anything does.

Pictures of a number of samples that is no power of two may differ in the last bits (--ulps, in units of the last place
of the larger value).
"""

import argparse
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import tomllib
import zlib

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def png_pixels(data):
    """What PNG decoders see: the header and the inflated rows."""
    at, packed, header = 8, b"", b""
    while at < len(data):
        (size,) = struct.unpack(">I", data[at : at + 4])
        kind, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            header = body
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    return {"": header + zlib.decompress(packed)}


def exr_channels(data):
    """Channels of a scan line EXR, ZIP compressed: {name: (type, bytes)}."""
    assert struct.unpack("<I", data[:4])[0] == 20000630, "not an EXR"
    at, attributes = 8, {}

    def text(at):
        end = data.index(b"\0", at)
        return data[at:end].decode(), end + 1

    while data[at]:
        name, at = text(at)
        _, at = text(at)
        (size,) = struct.unpack("<I", data[at : at + 4])
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    at += 1
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels, c = [], 0
    listed = attributes["channels"]
    while listed[c]:
        end = listed.index(b"\0", c)
        (kind,) = struct.unpack("<I", listed[end + 1 : end + 5])
        channels.append((listed[c:end].decode(), kind))
        c = end + 17
    bytes_of = {0: 4, 1: 2, 2: 4}
    rows = {name: [] for name, _ in channels}
    assert attributes["compression"] == b"\3", "not ZIP"
    line = sum(width * bytes_of[kind] for _, kind in channels)
    at += 8 * ((height + 15) // 16)
    for first in range(0, height, 16):
        y, size = struct.unpack("<iI", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        at += 8 + size
        wanted = line * min(16, height - (y - y0))
        if size < wanted:
            raw = bytearray(zlib.decompress(body))
            for i in range(1, len(raw)):
                raw[i] = (raw[i - 1] + raw[i] - 128) & 255
            half = (len(raw) + 1) // 2
            body = bytearray(len(raw))
            body[0::2], body[1::2] = raw[:half], raw[half:]
        place = 0
        while place < wanted:
            for name, kind in channels:
                rows[name].append(bytes(body[place : place + width * bytes_of[kind]]))
                place += width * bytes_of[kind]
    return {name: (kind, b"".join(rows[name])) for name, kind in channels}


def exr_payload(data):
    """The compressed rows of an EXR, without its header and its table of offsets: equal bytes are equal pixels."""
    at = 8
    height = 0
    while data[at]:
        name_end = data.index(b"\0", at)
        type_end = data.index(b"\0", name_end + 1)
        (size,) = struct.unpack("<I", data[type_end + 1 : type_end + 5])
        if data[at:name_end] == b"dataWindow":
            _, y0, _, y1 = struct.unpack("<4i", data[type_end + 5 : type_end + 21])
            height = y1 - y0 + 1
        at = type_end + 5 + size
    return data[at + 1 + 8 * ((height + 15) // 16) :]


def jpeg_payload(data):
    """A JPEG without its comments and application data."""
    at, kept = 2, b""
    while data[at + 1] != 0xDA:
        marker, (size,) = data[at + 1], struct.unpack(">H", data[at + 2 : at + 4])
        if marker != 0xFE and not 0xE0 <= marker <= 0xEF:
            kept += data[at : at + 2 + size]
        at += 2 + size
    return kept + data[at:]


def numbers(kind, raw):
    return struct.unpack("<%d%s" % (len(raw) // (2 if kind == 1 else 4), {0: "I", 1: "e", 2: "f"}[kind]), raw)


def ulps(kind, a, b):
    """How many representable numbers lie between two floats."""

    def order(value):
        code, bits = {1: ("<e", 16), 2: ("<f", 32)}[kind]
        i = int.from_bytes(struct.pack(code, value), "little")
        return -(i & ((1 << (bits - 1)) - 1)) if i >> (bits - 1) else i

    return abs(order(a) - order(b))


def difference(old, new, allowed):
    """In words, or nothing."""
    a, b = open(old, "rb").read(), open(new, "rb").read()
    extension = os.path.splitext(old)[1]
    if extension == ".exr":
        if exr_payload(a) == exr_payload(b):
            return None
        x, y = exr_channels(a), exr_channels(b)
        if x.keys() != y.keys():
            return "channels %s and %s" % (sorted(x), sorted(y))
        worst = []
        for name, (kind, raw) in x.items():
            if raw == y[name][1]:
                continue
            pairs = [(p, q) for p, q in zip(numbers(kind, raw), numbers(*y[name])) if p != q]
            if kind == 0:
                worst.append("%s: %d pixels" % (name, len(pairs)))
                continue
            farthest = max(ulps(kind, p, q) for p, q in pairs)
            if farthest > allowed:
                worst.append(
                    "%s: %d pixels, up to %d ulps, %g" % (name, len(pairs), farthest, max(abs(p - q) for p, q in pairs))
                )
        return "; ".join(worst) or None
    if extension == ".png":
        x, y = png_pixels(a)[""], png_pixels(b)[""]
        if x == y:
            return None
        return "%d bytes of %d" % (sum(p != q for p, q in zip(x, y)), len(x))
    if extension in (".jpg", ".jpeg"):
        a, b = jpeg_payload(a), jpeg_payload(b)
    return None if a == b else "bytes differ"


def shipped(folder):
    for name in sorted(os.listdir(os.path.join(TOP, "render_configs"))):
        if name.endswith(".toml"):
            yield name[:-5], os.path.join(TOP, "render_configs", name), 0


def sheets(folder):
    """Each panel of each sheet as a config of its own."""
    root = os.path.join(TOP, "render_configs", "sheets")
    for name in sorted(name for name in os.listdir(root) if name.endswith(".toml")):
        sheet = tomllib.load(open(os.path.join(root, name), "rb"))
        for number, panel in enumerate(sheet["panel"]):
            text = panel["config"] + "\n" + sheet.get("common", "")
            for key in ("scene", "include"):
                text = re.sub(
                    key + r' = (["\'])(\.[^"\']*)', lambda m: "%s = %s%s" % (key, m[1], os.path.join(root, m[2])), text
                )
            path = os.path.join(folder, "sheet_%s_%d.toml" % (name[:-5], number))
            open(path, "w").write(text)
            yield os.path.basename(path)[:-5], path, 0


def techniques(old, folder):
    """A picture of each technique in each preset."""
    listed = json.loads(subprocess.run([old, "techniques", "--format", "json"], capture_output=True, check=True).stdout)
    listed = listed["techniques"] if isinstance(listed, dict) else listed
    scene = os.path.join(TOP, "scenes", "room", "scene.toml")
    for t in listed:
        for preset in [""] + [p["name"] for p in t["presets"]]:
            choice = "technique = '%s'" % t["name"]
            if preset:
                choice += ", mode = 'paper'" if preset == "paper" else ", preset = '%s'" % preset
            table = "{ %s }" % choice
            aovs = ["beauty", "depth", "normal", "object_id", "shade"]
            toon = "shading = 'toon'\n"
            if t["slot"] == "geometry":
                config = toon + "accuracy = '%s'\n" % t["name"]
            elif t["slot"] == "ao":
                config = toon + "ao = %s\n" % table
                aovs += ["ambient_occlusion"]
            elif t["slot"] == "filter":
                config = toon + "ao = { technique = 'hbao', filter = %s }\n" % table
                aovs += ["ambient_occlusion", "ambient_occlusion_raw"]
            elif t["slot"] == "shading":
                config = "shading = %s\nao = 'toon_ssao'\n" % table
            elif t["slot"] == "edges":
                config = toon + "edges = %s\n" % table
                aovs += ["edges"]
            else:
                continue
            for samples, tile in ((8, 0), (3, 64)):
                text = 'scene = "%s"\n%s[image]\nsize = [200, 120]\nsamples = %d\ntile = %d\n' % (
                    scene,
                    config,
                    samples,
                    tile,
                )
                text += "[output]\naovs = %s\n" % json.dumps(aovs)
                name = "_".join(x for x in (t["slot"], t["name"], preset, str(samples)) if x)
                path = os.path.join(folder, name + ".toml")
                open(path, "w").write(text)
                yield name, path, 0 if samples == 8 else samples


def draw(program, config, output, settings=()):
    os.makedirs(output, exist_ok=True)
    command = [program, "--quiet", "render", config, "--output", output + "/"]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.returncode, done.stderr.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--only", default="", help="names that contain this")
    parser.add_argument(
        "--keep", help="keep what was drawn in this folder; pictures of OLD that are there are not drawn again"
    )
    parser.add_argument("--ulps", type=int, default=1, help="allowed per sample where their number is no power of two")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        kept = options.keep or temporary
        os.makedirs(kept, exist_ok=True)
        compared = files = different = 0
        cases = list(shipped(kept)) + list(techniques(options.old, kept)) + list(sheets(kept))
        for name, config, samples in cases:
            if options.only not in name:
                continue
            settings = (
                ["output.path=%s.exr" % name]
                if name.startswith(("ao_", "filter_", "edges_", "shading_", "geometry_"))
                else []
            )
            outputs = []
            for side, program in (("old", options.old), ("new", options.new)):
                folder = os.path.join(kept, side, name)
                if side == "new":
                    shutil.rmtree(folder, ignore_errors=True)
                if not os.path.isdir(folder):
                    code, said = draw(program, config, folder, settings)
                    if code:
                        print("%s: %s ends with %d: %s" % (name, side, code, said))
                outputs.append(folder)
            compared += 1
            a, b = (set(os.listdir(folder)) for folder in outputs)
            if a != b or not a:
                different += 1
                print("%s: files %s and %s" % (name, sorted(a), sorted(b)))
            for file in sorted(a & b):
                files += 1
                what = difference(
                    os.path.join(outputs[0], file), os.path.join(outputs[1], file), samples * options.ulps
                )
                if what:
                    different += 1
                    print("%s/%s: %s" % (name, file, what))
            sys.stdout.flush()
        print("%d configs, %d files compared, %d different" % (compared, files, different))
        return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
