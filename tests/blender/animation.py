"""Builds a scene in which things move in every way, exports it with its frames, and writes down where Blender has them.

blender -b -P animation.py -- EXPORTER OUT_DIR
"""

import math
import os
import sys

import bpy
import bmesh
from mathutils import Euler, Matrix

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from common import exporter, out, scene

scene.frame_start, scene.frame_end = 3, 9
scene.render.fps, scene.render.fps_base = 24, 1.001


def add(name, data, place=(0, 0, 0)):
    obj = bpy.data.objects.new(name, data)
    obj.location = place
    scene.collection.objects.link(obj)
    return obj


def cube(name):
    mesh = bpy.data.meshes.new(name)
    bm = bmesh.new()
    bmesh.ops.create_cube(bm, size=1)
    bm.to_mesh(mesh)
    bm.free()
    return mesh


def keys(obj, path, values):
    for frame, value in values.items():
        setattr(obj, path, value)
        obj.keyframe_insert(path, frame=frame)


# Turning past half a circle, moving and growing at once; Blender's curves between the keys are not straight.
keys(add("mover", cube("Mover")), "location", {3: (0, 0, 0), 9: (4, 1, 2)})
keys(scene.objects["mover"], "rotation_euler", {3: (0, 0, 0), 9: (0.4, 0.2, 5.0)})
keys(scene.objects["mover"], "scale", {3: (1, 1, 1), 9: (2, 0.5, 1)})
add("rigid", cube("Rigid"), (0, 4, 0))

# A mesh that changes its shape, and one with a modifier that does not.
bending = add("bending", cube("Bending"), (0, -4, 0))
bending.shape_key_add(name="Basis")
key = bending.shape_key_add(name="Wide")
for point in key.data:
    point.co.x *= 2
keys(key, "value", {3: 0.0, 9: 1.0})
still = add("still", cube("Still"), (3, -4, 0))
still.modifiers.new("Mirror", "MIRROR")

parent = add("parent", None, (0, 8, 0))
keys(parent, "rotation_euler", {3: (0, 0, 0), 9: (0, 0, 1.0)})
child = add("child", cube("Child"), (2, 0, 0))
child.parent = parent

camera = add("camera", bpy.data.cameras.new("camera"))
keys(camera, "location", {3: (10, -10, 5), 9: (12, -8, 6)})
keys(camera, "rotation_euler", {3: (1.1, 0, 0.8), 9: (1.2, 0, 0.9)})
keys(camera.data, "lens", {3: 35.0, 9: 60.0})
lamp = add("lamp", bpy.data.lights.new("lamp", "POINT"))
keys(lamp, "location", {3: (0, 0, 5), 9: (2, 0, 6)})
scene.camera = camera

exporter.export(bpy.context, out, animated=True)

# One line per frame and object: its matrix, row by row; then the camera's place and lens, and the widest x of what
# bends.
with open(os.path.join(out, "truth.txt"), "w") as file:
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        for name in ("mover", "rigid", "bending", "still", "child"):
            matrix = scene.objects[name].evaluated_get(depsgraph).matrix_world
            file.write(
                "%d %s %s\n" % (frame, name, " ".join("%.9g" % matrix[r][c] for r in range(4) for c in range(4)))
            )
        eye = scene.objects["camera"].evaluated_get(depsgraph)
        file.write(
            "%d camera %.9g %.9g %.9g %.9g\n" % ((frame,) + tuple(eye.matrix_world.translation) + (eye.data.lens,))
        )
        mesh = scene.objects["bending"].evaluated_get(depsgraph).to_mesh()
        file.write("%d shape %.9g\n" % (frame, max(v.co.x for v in mesh.vertices)))
