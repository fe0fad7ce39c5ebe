"""Terrain: hills around a lake, with firs and boulders.  blender -b --python-exit-code 1 -P scenes/terrain/make.py"""

import math
import os
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import blender_kit as kit
import bmesh
import bpy
from mathutils import Matrix, Vector, noise

kit.begin()
rock, water, fir, trunk = (kit.material(n, c) for n, c in (("rock", "#9a8f80"), ("water", "#6f9db8"), ("fir", "#3f6b4a"), ("trunk", "#7a5a41")))

SIDE, CELLS, LAKE = 60.0, 72, 0.6


def height(x, y):
    ridges = 1 - abs(noise.noise(Vector((x * 0.045 + 3.1, y * 0.045, 1.7))))
    hills = noise.fractal(Vector((x * 0.05, y * 0.05, 0.3)), 1.0, 2.0, 4)
    far = min(1.0, max(0.0, (y + 6) / 26))                 # mountains stand behind
    basin = math.exp(-((x + 2) ** 2 + (y + 8) ** 2) / 160)
    return 2.2 + 1.8 * hills + 9.0 * far * ridges ** 3 - 3.4 * basin


def terrain(bm):
    layer = bm.loops.layers.uv.new("UVMap")
    rows = [[bm.verts.new((x, y, height(x, y))) for x in (SIDE * (i / CELLS - 0.5) for i in range(CELLS + 1))] for y in (SIDE * (j / CELLS - 0.5) for j in range(CELLS + 1))]
    for j in range(CELLS):
        for i in range(CELLS):
            face = bm.faces.new((rows[j][i], rows[j][i + 1], rows[j + 1][i + 1], rows[j + 1][i]))
            for loop in face.loops:
                loop[layer].uv = (loop.vert.co.x / SIDE + 0.5, loop.vert.co.y / SIDE + 0.5)


def ground_map(texels=1024):
    """Which of the four grounds lies where, by height and slope: curves that no grid of faces could follow."""
    colors = [[int(c[i:i + 2], 16) / 255 for i in (1, 3, 5)] + [1.0] for c in ("#7f9d54", "#a5b568", "#9a8f80", "#f4f4f2")]
    step, pixels = SIDE / texels, []
    heights = [[height(SIDE * ((i + 0.5) / texels - 0.5), SIDE * ((j + 0.5) / texels - 0.5)) for i in range(texels)] for j in range(texels)]
    for j in range(texels):
        for i in range(texels):
            z = heights[j][i]
            slope = math.hypot(heights[j][min(i + 1, texels - 1)] - heights[j][max(i - 1, 0)], heights[min(j + 1, texels - 1)][i] - heights[max(j - 1, 0)][i]) / (2 * step)
            ragged = noise.noise(Vector((i * 0.02, j * 0.02, 4.0)))
            ground = 3 if z > 8.4 + 0.5 * ragged and slope < 1.3 else 2 if z > 6.2 + 1.2 * ragged or slope > 0.85 else 1 if z < 2.0 + 0.3 * ragged else 0
            pixels += colors[ground]
    image = bpy.data.images.new("ground", texels, texels)
    image.pixels = pixels
    image.pack()
    return image


land = kit.mesh("land", terrain)
grounds = kit.material("grounds", "#ffffff")
picture = grounds.node_tree.nodes.new("ShaderNodeTexImage")
picture.image = ground_map()
grounds.node_tree.links.new(picture.outputs["Color"], grounds.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
kit.add("land", land, grounds, level=3)
kit.add("lake", kit.mesh("lake", lambda bm: bmesh.ops.create_grid(bm, x_segments=1, y_segments=1, size=SIDE / 2)), water, (0, 0, LAKE))


def tree(bm):
    bmesh.ops.create_cone(bm, cap_ends=True, segments=6, radius1=0.1, radius2=0.08, depth=0.8, matrix=Matrix.Translation((0, 0, 0.3)))
    stem = set(bm.faces)
    for step, (radius, low) in enumerate(((0.62, 0.45), (0.5, 0.9), (0.36, 1.35))):
        bmesh.ops.create_cone(bm, cap_ends=True, segments=8, radius1=radius, radius2=0.02, depth=0.95, matrix=Matrix.Translation((0, 0, low + 0.475)) @ Matrix.Rotation(step * 0.4, 4, "Z"))
    for face in bm.faces:
        face.material_index = 0 if face in stem else 1


tree_mesh = kit.mesh("tree", tree)
tree_mesh.materials.append(trunk)
tree_mesh.materials.append(fir)


def boulder(bm):
    bmesh.ops.create_icosphere(bm, subdivisions=1, radius=0.6)
    for vertex in bm.verts:
        vertex.co *= 0.8 + 0.45 * noise.noise(vertex.co * 2.1)


boulder_mesh = kit.mesh("boulder", boulder)
dice = random.Random(7)
count = 0
while count < 130:
    x, y = dice.uniform(-24, 24), dice.uniform(-22, 18)
    z = height(x, y)
    steep = math.hypot(height(x + 0.5, y) - z, height(x, y + 0.5) - z)
    crowded = noise.noise(Vector((x * 0.12, y * 0.12, 9.0)))
    if z < LAKE + 0.4 or z > 6.5 or steep > 0.45 or crowded < 0.02:
        continue
    size = dice.uniform(0.7, 1.35)
    kit.add("tree %d" % count, tree_mesh, None, (x, y, z - 0.15), (0, 0, dice.uniform(0, 6.28)), (size, size, size), level=2)
    count += 1
for index in range(26):
    x, y = dice.uniform(-18, 18), dice.uniform(-20, 8)
    z = height(x, y)
    size = dice.uniform(0.35, 1.2)
    kit.add("boulder %d" % index, boulder_mesh, rock, (x, y, max(z, LAKE - 0.2)), (dice.uniform(0, 6), dice.uniform(0, 6), 0), (size, size, size * 0.8), level=3)

kit.camera("shore", (3.5, -27.5, 6.6), (-0.5, 4.0, 2.6), 30)
kit.sun((0.8, 0.35, -0.75))
kit.export(os.path.dirname(os.path.abspath(__file__)))
