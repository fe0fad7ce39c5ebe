"""Small modelling kit for limn's own scenes: bevelled boxes, turned and swept shapes, textures, and the files they go into.

Pure Python, so that the scenes can be made again anywhere:  python3 scenes/quickstart/make.py
Units are metres, y is up. Normals are left to limn, which smooths across edges flatter than 30 degrees.
"""

import math
import os
import struct
import zlib


class Mesh:
    """Polygons with UVs, in parts that each have a material."""

    def __init__(self):
        self.points, self.uvs, self.faces = [], [], []  # face: (material, [(point, uv)])

    def point(self, p):
        self.points.append(tuple(p))
        return len(self.points) - 1

    def uv(self, u, v):
        self.uvs.append((u, v))
        return len(self.uvs) - 1

    def face(self, corners, material):
        self.faces.append((material, corners))

    def grid(self, rows, material, uvs=None, close_u=False, close_v=False):
        """Quads between rows of points (all of one length). Winding: rows up, columns to the right, seen from outside."""
        height, width = len(rows), len(rows[0])
        ids = [[self.point(p) for p in row] for row in rows]
        uv = [[self.uv(*(uvs[j][i] if uvs else (i / max(width - 1, 1), j / max(height - 1, 1)))) for i in range(width)] for j in range(height)]
        for j in range(height if close_v else height - 1):
            for i in range(width if close_u else width - 1):
                j1, i1 = (j + 1) % height, (i + 1) % width
                corners = [(ids[j][i], uv[j][i]), (ids[j][i1], uv[j][i1]), (ids[j1][i1], uv[j1][i1]), (ids[j1][i], uv[j1][i])]
                unique = []
                for corner in corners:
                    if all(self.points[corner[0]] != self.points[other[0]] for other in unique):
                        unique.append(corner)
                if len(unique) >= 3:
                    self.face(unique, material)
        return self

    def add(self, other, move=(0, 0, 0), turn=0.0, scale=1.0, tilt=(0.0, 0.0)):
        """Joins a copy of another mesh: scaled, tilted about x and z, turned about y (degrees), moved."""
        base, uv_base = len(self.points), len(self.uvs)
        self.points += [translate(turn_y(turn_x(turn_z([c * scale for c in p], tilt[1]), tilt[0]), turn), move) for p in other.points]
        self.uvs += other.uvs
        for material, corners in other.faces:
            self.faces.append((material, [(p + base, t + uv_base) for p, t in corners]))
        return self

    def welded(self):
        """Points at the same place become one, so that surfaces are closed and smooth."""
        seen, index = {}, []
        for p in self.points:
            key = tuple("%.5g" % c for c in p)  # as it is written
            index.append(seen.setdefault(key, len(seen)))
        points = [None] * len(seen)
        for p, i in zip(self.points, index):
            points[i] = tuple(p)
        seen_uv, uv_index = {}, []
        for t in self.uvs:
            uv_index.append(seen_uv.setdefault((round(t[0], 5), round(t[1], 5)), len(seen_uv)))
        mesh = Mesh()
        mesh.points, mesh.uvs = points, list(seen_uv)
        for material, corners in self.faces:
            corners = [(index[p], uv_index[t]) for p, t in corners]
            corners = [c for i, c in enumerate(corners) if c[0] != corners[i - 1][0]]
            if len(corners) >= 3:
                mesh.faces.append((material, corners))
        return mesh

    def write(self, path, name):
        mesh = self.welded()
        lines = ["o " + name]
        lines += ["v %.5g %.5g %.5g" % tuple(p) for p in mesh.points]
        lines += ["vt %.5g %.5g" % t for t in mesh.uvs]
        material = None
        for m, corners in mesh.faces:
            if m != material:
                lines.append("usemtl " + m)
                material = m
            lines.append("f " + " ".join("%d/%d" % (p + 1, t + 1) for p, t in corners))
        with open(path, "w") as f:
            f.write("\n".join(lines) + "\n")


def translate(p, by):
    return [p[0] + by[0], p[1] + by[1], p[2] + by[2]]


def turn_y(p, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2]]


def turn_x(p, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]]


def turn_z(p, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]]


def box(width, height, depth, material, bevel=0.01, segments=3, uv=1.0, bulge=0.0):
    """A box standing on y = 0, its edges rounded. `bulge` swells the faces, as cushions do. UVs run in metres times `uv`."""
    mesh = Mesh()
    half = [width / 2, height / 2, depth / 2]
    bevel = min([bevel] + [h * 0.999 for h in half])
    steps = [-45 + 45 * i / segments for i in range(segments + 1)]
    inner = [(-1, a) for a in steps]
    outer = [(1, -a) for a in reversed(steps)]
    # Cushions need points between the bevels to swell.
    between = [(t, 0) for t in (-0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75)] if bulge else []
    line = inner + between + outer
    for axis, sign in [(0, 1), (0, -1), (1, 1), (1, -1), (2, 1), (2, -1)]:
        a, b = ((1, 2), (2, 0), (0, 1))[axis]
        if sign < 0:
            a, b = b, a
        rows, uvs = [], []
        for sb, angle_b in line:
            row, uv_row = [], []
            for sa, angle_a in line:
                direction = [0, 0, 0]
                direction[axis] = sign
                direction[a] = math.tan(math.radians(angle_a))
                direction[b] = math.tan(math.radians(angle_b))
                length = math.sqrt(sum(c * c for c in direction))
                p = [0, 0, 0]
                p[axis] = sign * (half[axis] - bevel)
                p[a] = sa * (half[a] - bevel)
                p[b] = sb * (half[b] - bevel)
                p = [c + d / length * bevel for c, d in zip(p, direction)]
                if bulge:
                    p[axis] += sign * bulge * (1 - min(1, abs(p[a]) / half[a]) ** 2) * (1 - min(1, abs(p[b]) / half[b]) ** 2)
                uv_row.append(((p[a] + half[a]) * uv, (p[b] + half[b]) * uv))
                row.append([p[0], p[1] + half[1], p[2]])
            rows.append(row)
            uvs.append(uv_row)
        mesh.grid(rows, material, uvs)
    return mesh


def lathe(profile, material, sides=48, squash=1.0):
    """Turns a profile of (radius, height), bottom to top on the outside, about the y axis."""
    lengths = [0]
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        lengths.append(lengths[-1] + math.hypot(r1 - r0, y1 - y0))
    rows, uvs = [], []
    for (r, y), along in zip(profile, lengths):
        rows.append([(r * math.cos(t), y, -r * math.sin(t) * squash) for t in (2 * math.pi * i / sides for i in range(sides + 1))])
        uvs.append([(i / sides, along / max(lengths[-1], 1e-9)) for i in range(sides + 1)])
    return Mesh().grid(rows, material, uvs)


def arc(cx, cy, radius, start, end, steps=6):
    """Points of a profile on a circle, degrees counted from +radius towards +height."""
    return [(cx + radius * math.cos(math.radians(start + (end - start) * i / steps)), cy + radius * math.sin(math.radians(start + (end - start) * i / steps))) for i in range(steps + 1)]


def ball(radius, material, sides=40, squash=1.0, height=1.0):
    return lathe([(radius * math.sin(t), radius * height * (1 - math.cos(t))) for t in (math.pi * i / (sides // 2) for i in range(sides // 2 + 1))], material, sides, squash)


def sweep(path, radii, material, sides=16, closed=False):
    """A tube along points; `radii` one number or one per point. Ends are closed."""
    if not isinstance(radii, (list, tuple)):
        radii = [radii] * len(path)
    rows, frame = [], None
    for i, p in enumerate(path):
        before, after = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        if closed:
            before, after = path[i - 1], path[(i + 1) % len(path)]
        d = unit([b - a for a, b in zip(before, after)])
        if frame is None:
            frame = unit(cross(d, [0, 1, 0] if abs(d[1]) < 0.9 else [1, 0, 0]))
        frame = unit([f - d_i * dot(frame, d) for f, d_i in zip(frame, d)])
        other = cross(d, frame)
        rows.append([[p[k] + radii[i] * (math.cos(t) * frame[k] + math.sin(t) * other[k]) for k in range(3)] for t in (2 * math.pi * s / sides for s in range(sides + 1))])
    if not closed:
        rows.insert(0, [list(path[0])] * (sides + 1))
        rows.append([list(path[-1])] * (sides + 1))
    return Mesh().grid(rows, material, close_v=closed)


def sheet(function, material, columns=24, rows=24, thickness=0.0):
    """A surface: function(u, v) → point, u and v in 0…1. With a thickness it has two sides."""
    mesh = Mesh()
    points = [[function(i / columns, j / rows) for i in range(columns + 1)] for j in range(rows + 1)]
    mesh.grid(points, material)
    if thickness:
        mesh.grid([[[p[0], p[1] - thickness, p[2]] for p in reversed(row)] for row in points], material)
    return mesh


def spline(points, steps=8):
    """A smooth curve through points (Catmull–Rom)."""
    result = []
    for i in range(len(points) - 1):
        a, b, c, d = points[max(i - 1, 0)], points[i], points[i + 1], points[min(i + 2, len(points) - 1)]
        for s in range(steps):
            t = s / steps
            result.append([0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - w) * t * t + (3 * q - p - 3 * r + w) * t ** 3) for p, q, r, w in zip(a, b, c, d)])
    return result + [list(points[-1])]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a)) or 1.0
    return [x / length for x in a]


# --- Textures ---------------------------------------------------------------------------------------------------------------------


def noise(x, y, seed=0):
    """Smooth value noise in 0…1 that repeats every 256 units."""

    def value(i, j):
        h = (i % 256 * 374761393 + j % 256 * 668265263 + seed * 974711) & 0xFFFFFFFF
        h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
        return ((h ^ (h >> 16)) & 0xFFFF) / 65535

    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    return (value(i, j) * (1 - u) + value(i + 1, j) * u) * (1 - v) + (value(i, j + 1) * (1 - u) + value(i + 1, j + 1) * u) * v


def write_png(path, width, height, color):
    """color(u, v) → (r, g, b) in 0…1, display-encoded; v counts from the bottom."""
    rows = []
    for y in range(height):
        row = bytearray([0])
        for x in range(width):
            row += bytes(max(0, min(255, round(c * 255))) for c in color((x + 0.5) / width, 1 - (y + 0.5) / height))
        rows.append(bytes(row))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b""))


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def hex_color(text):
    return tuple(int(text[i : i + 2], 16) / 255 for i in (1, 3, 5))


def planks(dark, light, boards=4, seed=1):
    """Wooden boards along u."""
    dark, light = hex_color(dark), hex_color(light)

    def color(u, v):
        board = int(v * boards)
        offset = noise(board * 7.3, 3.1, seed) * 9
        grain = noise(u * 5 + offset, v * boards * 14 + board * 31, seed) * 0.6 + noise(u * 22 + offset, v * boards * 46, seed + 1) * 0.25
        tone = grain + noise(board * 3.7, 0.5, seed + 2) * 0.35
        across = (v * boards) % 1
        joint = 0.55 if min(across, 1 - across) < 0.012 else 1
        return tuple(c * joint for c in mix(dark, light, min(1, tone)))

    return color


# --- Scenes -----------------------------------------------------------------------------------------------------------------------


class Scene:
    """Collects meshes, instances and materials, and writes a folder: scene.toml, meshes/, textures."""

    def __init__(self, folder, header):
        self.folder, self.header, self.meshes, self.instances, self.materials = folder, header, {}, [], []
        os.makedirs(os.path.join(folder, "meshes"), exist_ok=True)

    def material(self, name, color, texture=None, shininess=None, specular=None):
        text = '[[material]]\nname = "%s"\ncolor = "%s"\n' % (name, color)
        if texture:
            text += 'texture = "%s"\n' % texture
        if shininess:
            text += "shininess = %g\nspecular = %g\n" % (shininess, specular or 1)
        self.materials.append(text)

    def mesh(self, name, mesh):
        self.meshes[name] = mesh
        mesh.write(os.path.join(self.folder, "meshes", name + ".obj"), name)
        return name

    def place(self, mesh, at=(0, 0, 0), turn=(0, 0, 0), scale=1.0, material=None, name=None):
        text = '[[instance]]\nmesh = "%s"\n' % mesh
        if name:
            text += 'name = "%s"\n' % name
        if tuple(at) != (0, 0, 0):
            text += "translate = [%.4g, %.4g, %.4g]\n" % tuple(at)
        turn = turn if isinstance(turn, (tuple, list)) else (0, turn, 0)
        if tuple(turn) != (0, 0, 0):
            text += "rotate = [%.4g, %.4g, %.4g]\n" % tuple(turn)
        scale = scale if isinstance(scale, (tuple, list)) else (scale,) * 3
        if tuple(scale) != (1, 1, 1):
            text += "scale = [%.4g, %.4g, %.4g]\n" % tuple(scale)
        if material:
            text += 'material = "%s"\n' % material
        self.instances.append(text)

    def write(self):
        text = self.header + "\n"
        for name in self.meshes:
            text += '[[mesh]]\nname = "%s"\nfile = "meshes/%s.obj"\n\n' % (name, name)
        text += "\n".join(self.materials) + "\n" + "\n".join(self.instances)
        with open(os.path.join(self.folder, "scene.toml"), "w") as f:
            f.write(text)
        print("%s: %d meshes, %d instances, %d materials" % (self.folder, len(self.meshes), len(self.instances), len(self.materials)))


def block(width, height, depth, material):
    """A box with sharp edges, standing on y = 0."""
    x, z = width / 2, depth / 2
    return prism([(-x, z), (x, z), (x, -z), (-x, -z)], height, material)


def prism(outline, height, material, base=0.0):
    """Walls of a height over an outline of (x, z), counter-clockwise seen from above (x right, z towards the viewer), with a floor and a top."""
    mesh = Mesh()
    count = len(outline)
    low = [mesh.point((x, base, z)) for x, z in outline]
    high = [mesh.point((x, base + height, z)) for x, z in outline]
    t = mesh.uv(0, 0)
    for i in range(count):
        j = (i + 1) % count
        mesh.face([(low[i], t), (low[j], t), (high[j], t), (high[i], t)], material)
    mesh.face([(p, t) for p in high], material)
    mesh.face([(p, t) for p in reversed(low)], material)
    return mesh


def wall(length, height, thickness, material, openings=(), reveal=None, gable=0.0):
    """A wall along x, from 0 to `length`, its middle on z = 0, standing on y = 0, closed all around. `openings`: (x, y, width, height). `gable`: height
    of a triangle on top."""
    xs = sorted({0.0, length} | {v for x, y, w, h in openings for v in (x, x + w)} | ({length / 2} if gable else set()))
    ys = sorted({0.0, height} | {v for x, y, w, h in openings for v in (y, y + h)})
    z = thickness / 2

    def solid(i, j):
        if not (0 <= i < len(xs) - 1 and 0 <= j < len(ys) - 1):
            return False
        cx, cy = (xs[i] + xs[i + 1]) / 2, (ys[j] + ys[j + 1]) / 2
        return not any(x < cx < x + w and y < cy < y + h for x, y, w, h in openings)

    mesh = Mesh()
    t = mesh.uv(0, 0)

    def quad(points, paint):
        mesh.face([(mesh.point(p), t) for p in points], paint)

    for i in range(len(xs) - 1):
        for j in range(len(ys) - 1):
            if not solid(i, j):
                continue
            x0, x1, y0, y1 = xs[i], xs[i + 1], ys[j], ys[j + 1]
            quad([(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)], material)
            quad([(x1, y0, -z), (x0, y0, -z), (x0, y1, -z), (x1, y1, -z)], material)
            inside = reveal or material
            if not solid(i - 1, j):
                quad([(x0, y0, -z), (x0, y0, z), (x0, y1, z), (x0, y1, -z)], inside if i > 0 else material)
            if not solid(i + 1, j):
                quad([(x1, y0, z), (x1, y0, -z), (x1, y1, -z), (x1, y1, z)], inside if i < len(xs) - 2 else material)
            if not solid(i, j - 1):
                quad([(x0, y0, -z), (x1, y0, -z), (x1, y0, z), (x0, y0, z)], inside if j > 0 else material)
            if not solid(i, j + 1) and not (gable and j == len(ys) - 2):
                quad([(x0, y1, z), (x1, y1, z), (x1, y1, -z), (x0, y1, -z)], inside if j < len(ys) - 2 else material)
    if gable:
        top = lambda x: height + gable * (1 - abs(x - length / 2) / (length / 2))
        # Fans over the wall's own points, so that nothing gapes.
        for left, right in zip(xs, xs[1:]):
            front = [(left, height, z), (right, height, z)]
            front += [(right, top(right), z)] if top(right) > height else []
            front += [(left, top(left), z)] if top(left) > height else []
            quad(front, material)
            quad([(x, y, -z) for x, y, _ in reversed(front)], material)
            quad([(left, top(left), z), (right, top(right), z), (right, top(right), -z), (left, top(left), -z)], material)
    return mesh
