"""Pink: one soft toy, a rabbit of rounded limbs.  blender -b --python-exit-code 1 -P scenes/pink/make.py"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import blender_kit as kit
import bmesh
import bpy
from mathutils import Matrix, Vector

kit.begin()
pink, light, dark, ground = (kit.material(n, c) for n, c in (("pink", "#ef8fae"), ("belly", "#fbd5de"), ("eyes", "#2b1d24"), ("ground", "#f4ece2")))

kit.add("ground", kit.mesh("ground", lambda bm: bmesh.ops.create_grid(bm, x_segments=1, y_segments=1, size=4000)), ground)

# The figure: bones with a radius at each joint; Blender's Skin modifier makes the cage around them.
joints = [  # place, radii
    ((0, 0, 0.95), (0.62, 0.56)), ((0, 0, 1.55), (0.72, 0.66)), ((0, 0, 2.2), (0.5, 0.46)),          # hips, belly, chest
    ((0, -0.05, 2.55), (0.34, 0.34)), ((0, -0.1, 3.1), (0.82, 0.78)), ((0, -0.12, 3.6), (0.6, 0.58)),  # neck, head
    ((0.42, -0.05, 0.72), (0.34, 0.34)), ((0.55, -0.35, 0.42), (0.27, 0.27)), ((0.6, -0.85, 0.3), (0.3, 0.3)),     # right leg and foot
    ((-0.42, -0.05, 0.72), (0.34, 0.34)), ((-0.55, -0.35, 0.42), (0.27, 0.27)), ((-0.6, -0.85, 0.3), (0.3, 0.3)),
    ((0.62, -0.05, 2.1), (0.22, 0.22)), ((1.02, -0.3, 1.72), (0.19, 0.19)), ((0.92, -0.72, 1.5), (0.23, 0.23)),    # arms
    ((-0.62, -0.05, 2.1), (0.22, 0.22)), ((-1.08, 0.0, 2.45), (0.19, 0.19)), ((-1.28, -0.12, 2.95), (0.24, 0.24)),   # this one waves
    ((0.34, -0.05, 4.1), (0.17, 0.13)), ((0.46, 0.0, 4.75), (0.26, 0.13)), ((0.5, 0.08, 5.3), (0.12, 0.08)),      # ears
    ((-0.34, -0.05, 4.1), (0.17, 0.13)), ((-0.52, 0.0, 4.7), (0.26, 0.13)), ((-0.78, 0.02, 5.15), (0.12, 0.08)),
]
bones = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (0, 6), (6, 7), (7, 8), (0, 9), (9, 10), (10, 11), (2, 12), (12, 13), (13, 14), (2, 15), (15, 16), (16, 17), (5, 18), (18, 19), (19, 20), (5, 21), (21, 22), (22, 23)]
data = bpy.data.meshes.new("figure")
data.from_pydata([j[0] for j in joints], bones, [])
figure = kit.add("figure", data, pink)
bpy.context.view_layer.objects.active = figure
skin = figure.modifiers.new("Skin", "SKIN")
for vertex, (_, radius) in zip(data.skin_vertices[0].data, joints):
    vertex.radius = radius
data.skin_vertices[0].data[0].use_root = True
subdivision = figure.modifiers.new("Subdivision", "SUBSURF")
subdivision.levels = subdivision.render_levels = 5
skin.use_smooth_shade = True


def blob(name, paint, place, size, turn=(0, 0, 0)):
    kit.add(name, kit.mesh(name, lambda bm: bmesh.ops.create_icosphere(bm, subdivisions=2, radius=1)), paint, place, turn, size, level=4)


blob("belly", light, (0, -0.43, 1.5), (0.48, 0.3, 0.6))
blob("muzzle", light, (0, -0.82, 2.98), (0.34, 0.22, 0.24))
blob("nose", dark, (0, -1.03, 3.1), (0.09, 0.06, 0.065))
blob("eye right", dark, (0.32, -0.8, 3.32), (0.085, 0.06, 0.12))
blob("eye left", dark, (-0.32, -0.8, 3.32), (0.085, 0.06, 0.12))
blob("tail", light, (0, 0.66, 0.95), (0.28, 0.26, 0.28))

kit.camera("portrait", (4.4, -13.2, 4.4), (0, -0.1, 2.62), 50)
kit.sun((-0.55, 0.75, -1.0))
kit.export(os.path.dirname(os.path.abspath(__file__)))
