"""Shapes that show what a technique of ambient occlusion does: python3 scenes/proofs/make.py

A coarsely tessellated sphere, a block to step down from, slats, a card before a wall; and a row of one organic figure. Units are metres, y is up.
"""

import math
import os

HERE = os.path.dirname(os.path.abspath(__file__))


def obj(name, parts):
    """Writes an OBJ of named parts, each (points, faces); normals are left out: every facet is flat."""
    os.makedirs(os.path.join(HERE, "meshes"), exist_ok=True)
    with open(os.path.join(HERE, "meshes", name + ".obj"), "w") as f:
        base = 1
        for part, points, faces in parts:
            f.write("o %s\n" % part)
            for p in points:
                f.write("v %.6g %.6g %.6g\n" % tuple(p))
            f.write("s off\n")
            for face in faces:
                f.write("f " + " ".join(str(base + i) for i in face) + "\n")
            base += len(points)


def box(name, lo, hi):
    points = [(x, y, z) for z in (lo[2], hi[2]) for x, y in ((lo[0], lo[1]), (hi[0], lo[1]), (hi[0], hi[1]), (lo[0], hi[1]))]
    return name, points, [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def sphere(name, centre, radius, sides):
    rings = sides // 2
    points = []
    for r in range(rings + 1):
        for s in range(sides):
            theta, phi = math.pi * r / rings, 2 * math.pi * s / sides
            points.append((centre[0] + radius * math.sin(theta) * math.cos(phi), centre[1] + radius * math.cos(theta), centre[2] - radius * math.sin(theta) * math.sin(phi)))
    faces = []
    for r in range(rings):
        for s in range(sides):
            a, b, c, d = r * sides + s, (r + 1) * sides + s, (r + 1) * sides + (s + 1) % sides, r * sides + (s + 1) % sides
            faces.append((a, b, c) if r == 0 else (a, b, d) if r == rings - 1 else (a, b, c, d))
    return name, points, faces


def main():
    floor = [box("floor", (-6, -0.2, -4), (6, 0, 6)), box("wall", (-6, 0, -4.2), (6, 4, -4))]
    obj("shapes", floor + [sphere("coarse sphere", (-2.1, 0.9, 0), 0.9, 16), box("block", (-0.5, 0, -1), (1.1, 0.8, 0.6)), box("step", (-0.5, 0.8, -1), (0.3, 1.1, 0.6))]
        + [box("slat", (1.9 + 0.22 * i, 0, -0.5), (1.95 + 0.22 * i, 1.5, -0.45)) for i in range(8)]
        + [box("rail", (1.8, 1.5, -0.55), (3.6, 1.58, -0.4)), box("card", (-3.6, 0.6, -3.1), (-2.4, 2.2, -3.08)), box("wedge", (3.4, 0, 0.8), (4.6, 0.35, 2.4))])
    half, bar = 1.0, 0.36
    ends = ((-half, -half + bar), (half - bar, half))
    bars = []
    for one in ends:
        for other in ends:
            bars.append(box("bar", (-half, one[0] + half, other[0]), (half, one[1] + half, other[1])))
            bars.append(box("bar", (one[0], 0, other[0]), (one[1], 2 * half, other[1])))
            bars.append(box("bar", (one[0], other[0] + half, -half), (one[1], other[1] + half, half)))
    obj("hollow_cube", bars)
    # A board that leans away from a wall: the gap behind its edges grows from left to right.
    board = [(-3, 0.0, 0.0), (3, 0.0, 1.2), (3, 1.6, 1.2), (-3, 1.6, 0.0)]
    obj("wedge", [box("wall", (-4, -1, -0.1), (4, 4, 0)), ("board", board, [(0, 1, 2, 3)])])
    obj("ground", [("ground", [(-40, 0, 40), (40, 0, 40), (40, 0, -40), (-40, 0, -40)], [(0, 1, 2, 3)])])


if __name__ == "__main__":
    main()
