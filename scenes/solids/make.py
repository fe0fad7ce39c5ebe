"""Solids: what geometry is taught with, some round, some creased, on a table.  blender -b --python-exit-code 1 -P scenes/solids/make.py"""

import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import blender_kit as kit
import bmesh
from mathutils import Matrix

kit.begin()
paper = kit.material("table", "#e9dfcb")
red, blue, yellow, green, white, violet = (kit.material(n, c) for n, c in (
    ("red", "#c8402f"), ("blue", "#2f5f9e"), ("yellow", "#e5b034"), ("green", "#4f8a4c"), ("white", "#f3efe6"), ("violet", "#77548f")))


def table(bm):
    bmesh.ops.create_grid(bm, x_segments=1, y_segments=1, size=400)


kit.add("table", kit.mesh("table", table), paper)

# A ball from a cube: at its limit nearly a sphere.
kit.add("ball", kit.mesh("ball", lambda bm: bmesh.ops.create_icosphere(bm, subdivisions=2, radius=1.05)), red, (-2.6, -0.4, 1.0), level=4)
# A die: creased half, so that its edges are round.
kit.add("die", kit.mesh("die", lambda bm: bmesh.ops.create_cube(bm, size=1.7)), white, (0.2, -1.5, 0.85), (0, 0, 0.5), level=5, creases=lambda a, b: 0.62)


def prism(bm):
    bmesh.ops.create_cone(bm, cap_ends=True, segments=6, radius1=0.85, radius2=0.85, depth=2.6)


def rim(a, b):
    return 1.0 if abs(a.z - b.z) < 1e-4 else 0.45


kit.add("prism", kit.mesh("prism", prism), blue, (2.5, 0.6, 1.3), (0, 0, 0.3), level=5, creases=rim)


def cone(bm):
    bmesh.ops.create_cone(bm, cap_ends=True, segments=12, radius1=1.2, radius2=0.0, depth=2.8)


kit.add("cone", kit.mesh("cone", cone), yellow, (-2.0, 2.6, 1.4), level=4, creases=lambda a, b: 1.0 if a.z < -1 and b.z < -1 else 0.0)


def ring(bm):
    rows, around = 10, 6
    points = [[bm.verts.new(((1.15 + 0.42 * math.cos(v)) * math.cos(u), (1.15 + 0.42 * math.cos(v)) * math.sin(u), 0.42 * math.sin(v)))
               for v in (2 * math.pi * j / around for j in range(around))] for u in (2 * math.pi * i / rows for i in range(rows))]
    for i in range(rows):
        for j in range(around):
            bm.faces.new((points[i][j], points[(i + 1) % rows][j], points[(i + 1) % rows][(j + 1) % around], points[i][(j + 1) % around]))


kit.add("ring", kit.mesh("ring", ring), green, (-2.3, -3.1, 0.36), level=4)
kit.add("ring leaning", kit.mesh("ring leaning", ring), violet, (4.3, -1.0, 1.46), (math.radians(78), 0, 0.9), level=4)


def tetrahedron(bm):
    bmesh.ops.create_cone(bm, cap_ends=True, segments=3, radius1=1.15, radius2=0.0, depth=1.65)


kit.add("tetrahedron", kit.mesh("tetrahedron", tetrahedron), blue, (2.2, -3.4, 0.82), (0, 0, 0.2), level=5, creases=lambda a, b: 0.7)


def dodecahedron(bm):
    bmesh.ops.create_icosphere(bm, subdivisions=1, radius=1.0)
    # The dual: a vertex per triangle, a pentagon per vertex.
    bm.verts.ensure_lookup_table()
    faces = list(bm.faces)
    centres = {f: f.calc_center_median() * 1.25 for f in faces}
    fans = []
    for vertex in bm.verts:
        around, normal = list(vertex.link_faces), vertex.co.normalized()
        side = (centres[around[0]] - vertex.co).normalized()
        other = normal.cross(side)
        around.sort(key=lambda f: math.atan2((centres[f] - vertex.co).dot(other), (centres[f] - vertex.co).dot(side)))
        fans.append([centres[f] for f in around])
    bm.clear()
    known = {}
    for fan in fans:
        bm.faces.new([known.setdefault(tuple(round(c, 5) for c in p), None) or known.__setitem__(tuple(round(c, 5) for c in p), bm.verts.new(p)) or known[tuple(round(c, 5) for c in p)] for p in fan])


kit.add("dodecahedron", kit.mesh("dodecahedron", dodecahedron), yellow, (-4.9, 1.2, 0.98), (0.55, 0.1, 0.4), level=4, creases=lambda a, b: 0.75)

kit.camera("table", (1.0, -14.6, 6.4), (-0.1, -0.35, 0.85), 42)
kit.sun((0.65, 0.55, -1.0))
kit.export(os.path.dirname(os.path.abspath(__file__)))
