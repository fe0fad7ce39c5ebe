#!/usr/bin/env python3
"""Makes contact sheets: python3 render_configs/sheets/make.py [LIMN] [NAME...]

Each NAME.toml beside this script lists panels: a caption, a config in TOML, settings that all share. Each becomes NAME.png, panels from left to
right and top to bottom in the order of the file.
"""

import os
import struct
import subprocess
import sys
import tempfile
import tomllib
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
GAP = 6


def read_png(path):
    """Rows of an 8-bit picture without an alpha channel, as bytes of RGB."""
    data = open(path, "rb").read()
    width, height, bits, kind = struct.unpack(">IIBB", data[16:26])
    channels = {0: 1, 2: 3, 6: 4}[kind]
    assert bits == 8, path
    at, packed = 8, b""
    while at < len(data):
        (size,) = struct.unpack(">I", data[at : at + 4])
        if data[at + 4 : at + 8] == b"IDAT":
            packed += data[at + 8 : at + 8 + size]
        at += 12 + size
    raw, rows, before = zlib.decompress(packed), [], bytearray(width * channels)
    for y in range(height):
        line = raw[y * (width * channels + 1) : (y + 1) * (width * channels + 1)]
        rule, row = line[0], bytearray(line[1:])
        for i in range(len(row)):
            left = row[i - channels] if i >= channels else 0
            up, corner = before[i], before[i - channels] if i >= channels else 0
            if rule == 1:
                row[i] = (row[i] + left) & 255
            elif rule == 2:
                row[i] = (row[i] + up) & 255
            elif rule == 3:
                row[i] = (row[i] + (left + up) // 2) & 255
            elif rule == 4:
                guess = left + up - corner
                a, b, c = abs(guess - left), abs(guess - up), abs(guess - corner)
                row[i] = (row[i] + (left if a <= b and a <= c else up if b <= c else corner)) & 255
        before = row
        rows.append(bytes(v for i in range(0, len(row), channels) for v in (row[i : i + 3] if channels > 1 else row[i : i + 1] * 3)))
    return width, height, rows


def write_png(path, width, rows):
    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    raw = b"".join(b"\0" + row for row in rows)
    with open(path, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def make(limn, name):
    with open(os.path.join(HERE, name + ".toml"), "rb") as f:
        sheet = tomllib.load(f)
    columns, pictures = sheet.get("columns", 2), []
    for panel in sheet["panel"]:
        # The config stands beside the sheet for a moment, so that its paths are relative to it.
        handle, config = tempfile.mkstemp(suffix=".toml", prefix=".panel-", dir=HERE)
        with os.fdopen(handle, "w") as f:
            f.write(panel["config"] + "\n" + sheet.get("common", ""))   # keys of the file before its tables
        with tempfile.TemporaryDirectory() as folder:
            aov = panel.get("aov", "beauty")
            output = os.path.join(folder, "panel.png")
            try:
                subprocess.run([limn, "--quiet", "render", config, "--set", "output.aovs=['%s']" % aov, "--output", output], check=True)
            finally:
                os.remove(config)
            pictures.append(read_png(output if aov == "beauty" else os.path.join(folder, "panel.%s.png" % aov)))
    width, height = pictures[0][0], pictures[0][1]
    total = columns * width + (columns + 1) * GAP
    blank, rows = b"\xff" * (total * 3), []
    for first in range(0, len(pictures), columns):
        rows += [blank] * GAP
        row = pictures[first : first + columns]
        for y in range(height):
            line = b"".join(b"\xff" * (3 * GAP) + picture[2][y] for picture in row)
            rows.append(line + b"\xff" * (total * 3 - len(line)))
    write_png(os.path.join(HERE, name + ".png"), total, rows + [blank] * GAP)
    print(name + ".png")


if __name__ == "__main__":
    program = sys.argv[1] if len(sys.argv) > 1 else os.path.join(HERE, "..", "..", "limn")
    for sheet in sys.argv[2:] or sorted(f[:-5] for f in os.listdir(HERE) if f.endswith(".toml") and not f.startswith(".")):
        make(program, sheet)
