"""Reads PNG files of 8 or 16 bits, and of grey, RGB or RGBA, by the standard library alone."""

import struct
import zlib

CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}


class Picture:
    """Pixels as rows of (red, green, blue, alpha), each 0 to 1."""

    def __init__(self, width, height, rows):
        self.width, self.height, self.rows = width, height, rows


def unfilter(raw, height, stride, step):
    lines, last, at = [], bytes(stride), 0
    for _ in range(height):
        kind, line = raw[at], bytearray(raw[at + 1:at + 1 + stride])
        at += 1 + stride
        if kind == 1:
            for i in range(step, stride):
                line[i] = (line[i] + line[i - step]) & 255
        elif kind == 2:
            line = bytearray((a + b) & 255 for a, b in zip(line, last))
        elif kind == 3:
            for i in range(stride):
                left = line[i - step] if i >= step else 0
                line[i] = (line[i] + (left + last[i]) // 2) & 255
        elif kind == 4:
            paeth(line, last, step)
        lines.append(bytes(line))
        last = line
    return lines


def paeth(line, last, step):
    for i in range(len(line)):
        a, c = (line[i - step], last[i - step]) if i >= step else (0, 0)
        b = last[i]
        p = a + b - c
        pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
        nearest = a if pa <= pb and pa <= pc else b if pb <= pc else c
        line[i] = (line[i] + nearest) & 255


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("%s is no PNG" % path)
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    channels, size = CHANNELS[color], depth // 8
    lines = unfilter(zlib.decompress(packed), height, width * channels * size, channels * size)
    rows = []
    for line in lines:
        values = struct.unpack(">%dH" % (width * channels), line) if size == 2 else line
        top = 65535 if size == 2 else 255
        rows.append([pixel([v / top for v in values[i:i + channels]]) for i in range(0, len(values), channels)])
    return Picture(width, height, rows)


def pixel(values):
    if len(values) == 1:
        return (values[0],) * 3 + (1.0,)
    if len(values) == 2:
        return (values[0],) * 3 + (values[1],)
    return tuple(values) if len(values) == 4 else tuple(values) + (1.0,)
