"""Draws in Blender, with Workbench and Freestyle, what limn draws.   blender -b -P freestyle.py -- MODE ARGUMENTS

  lines FOLDER          black lines on white of every NAME.obj and NAME.camera in a folder, to NAME.other.png
  scene SCENE.toml CAMERA WIDTH HEIGHT OUT.png
                        a scene of limn's; prints RENDER_S, the seconds of a second render with Freestyle, PLAIN_S,
                        that of one without lines, and LINE_ART_S, that of one with Line Art (Grease Pencil's), start-up
                        and loading excluded
"""

import math
import os
import sys
import time

import bpy
from mathutils import Euler, Matrix, Vector

UP = Matrix.Rotation(math.radians(90), 4, "X")  # y up to z up


def freestyle(thickness):
    scene = bpy.context.scene
    scene.render.use_freestyle = True
    layer = bpy.context.view_layer
    layer.use_freestyle = True
    settings = layer.freestyle_settings
    settings.crease_angle = math.radians(140)  # as limn's 40 degrees, measured the other way round
    lines = settings.linesets[0] if settings.linesets else settings.linesets.new("lines")
    for kind in ("silhouette", "border", "crease"):
        setattr(lines, "select_" + kind, True)
    style = bpy.data.linestyles.new("plain")
    style.color, style.thickness, style.thickness_position = (0, 0, 0), thickness, "CENTER"
    lines.linestyle = style


def camera(place, at, fov, height, size):
    data = bpy.data.cameras.new("camera")
    obj = bpy.data.objects.new("camera", data)
    bpy.context.scene.collection.objects.link(obj)
    back = (Vector(place) - Vector(at)).normalized()
    right = Vector((0, 1, 0)).cross(back).normalized()
    up = back.cross(right)
    obj.matrix_world = UP @ Matrix.Translation(place) @ Matrix((right, up, back)).transposed().to_4x4()
    data.clip_start, data.clip_end = 0.05, 1000
    if height > 0:
        data.type, data.ortho_scale = "ORTHO", height * max(size[0] / size[1], 1)
    else:
        data.sensor_fit, data.angle = "HORIZONTAL", fov
    bpy.context.scene.camera = obj
    return data


def prepare(size):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    render = scene.render
    render.engine = "BLENDER_WORKBENCH"
    render.resolution_x, render.resolution_y, render.resolution_percentage = size[0], size[1], 100
    scene.view_settings.view_transform = "Standard"
    return scene


def load(path):
    before = set(bpy.data.objects)
    bpy.ops.wm.obj_import(filepath=path, forward_axis="NEGATIVE_Z", up_axis="Y")
    return [o for o in bpy.data.objects if o not in before]


mode, arguments = sys.argv[sys.argv.index("--") + 1], sys.argv[sys.argv.index("--") + 2 :]
if mode == "lines":
    for name in sorted(os.listdir(arguments[0])):
        if not name.endswith(".camera"):
            continue
        base = os.path.join(arguments[0], name[:-7])
        numbers = [float(x) for x in open(base + ".camera").read().split()]
        size = [int(n) for n in numbers[8:]]
        scene = prepare(size)
        load(base + ".obj")
        camera(numbers[:3], numbers[3:6], math.radians(numbers[6]), numbers[7], size)
        freestyle(1.0)
        # White things before white nothing: what is dark is a line.
        shading = scene.display.shading
        shading.light, shading.color_type, shading.single_color = "FLAT", "SINGLE", (1, 1, 1)
        shading.background_type = "VIEWPORT"
        shading.background_color = (1, 1, 1)
        scene.render.film_transparent = False
        scene.world = bpy.data.worlds.new("white")
        scene.world.color = (1, 1, 1)
        scene.render.filepath = base + ".other.png"
        bpy.ops.render.render(write_still=True)
else:
    import tomllib

    path, wanted, size, out = arguments[0], arguments[1], [int(arguments[2]), int(arguments[3])], arguments[4]
    scene = prepare(size)
    description = tomllib.load(open(path, "rb"))
    meshes = {
        m["name"]: [o.data for o in load(os.path.join(os.path.dirname(path), m["file"]))] for m in description["mesh"]
    }
    for o in list(bpy.data.objects):
        bpy.data.objects.remove(o)
    for i in description["instance"]:
        turn = Euler([math.radians(a) for a in i.get("rotate", (0, 0, 0))], "XYZ").to_matrix().to_4x4()
        place = (
            UP
            @ Matrix.Translation(i.get("translate", (0, 0, 0)))
            @ turn
            @ Matrix.Diagonal((*i.get("scale", (1, 1, 1)), 1))
        )
        for data in meshes[i["mesh"]]:
            o = bpy.data.objects.new(data.name, data)
            scene.collection.objects.link(o)
            o.matrix_world = place
    c = next(c for c in description["camera"] if c["name"] == wanted)
    data = camera(
        c["position"],
        c["look_at"],
        2 * math.atan(18 / c.get("focal_length", 35)),
        c.get("orthographic_height", 0),
        size,
    )
    data.shift_x, data.shift_y = c.get("shift", (0, 0))
    freestyle(1.3)
    scene.display.shading.show_cavity, scene.display.shading.cavity_type, scene.display.shading.color_type = (
        True,
        "BOTH",
        "MATERIAL",
    )
    scene.render.filepath = out

    def timed(name):
        bpy.ops.render.render()
        start = time.time()
        bpy.ops.render.render(write_still=True)
        print("%s %.3f" % (name, time.time() - start))

    timed("RENDER_S")
    scene.render.use_freestyle = False
    timed("PLAIN_S")
    bpy.ops.object.gpencil_add(type="LRT_SCENE")
    timed("LINE_ART_S")
