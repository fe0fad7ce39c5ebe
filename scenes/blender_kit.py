"""What the scenes that are made in Blender share. Run one with:  blender -b --python-exit-code 1 -P scenes/solids/make.py

Units are metres, z is up. Every curved thing is a cage with a Subdivision Surface modifier; limn's own exporter writes the files.
"""

import importlib.util
import os

import bmesh
import bpy
from mathutils import Matrix, Vector

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def begin():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 1280, 720
    return scene


def material(name, color):
    """A colour as in a paint box: sRGB hex."""
    def linear(c):
        return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    rgb = [linear(int(color[i:i + 2], 16) / 255) for i in (1, 3, 5)]
    result.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*rgb, 1)
    return result


def mesh(name, build):
    """A mesh that `build` fills through bmesh."""
    data = bpy.data.meshes.new(name)
    bm = bmesh.new()
    build(bm)
    bm.to_mesh(data)
    bm.free()
    for polygon in data.polygons:
        polygon.use_smooth = True
    return data


def add(name, data, paint=None, move=(0, 0, 0), turn=(0, 0, 0), scale=(1, 1, 1), level=0, creases=None):
    """An object; `level`: of its subdivision; `creases`: sharpness 0...1 of an edge, given its two ends."""
    obj = bpy.data.objects.new(name, data)
    obj.location, obj.rotation_euler, obj.scale = move, turn, scale
    bpy.context.scene.collection.objects.link(obj)
    if paint and not data.materials:
        data.materials.append(paint)
    if creases:
        for edge in data.edges:
            edge.crease = creases(*(data.vertices[v].co for v in edge.vertices))
    if level:
        modifier = obj.modifiers.new("Subdivision", "SUBSURF")
        modifier.levels = modifier.render_levels = level
    return obj


def camera(name, place, at, lens):
    data = bpy.data.cameras.new(name)
    data.lens = lens
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    direction = Vector(place) - Vector(at)
    obj.matrix_world = Matrix.Translation(place) @ direction.to_track_quat("Z", "Y").to_matrix().to_4x4()
    bpy.context.scene.camera = obj
    return obj


def sun(direction, strength=3.0):
    data = bpy.data.lights.new("sun", "SUN")
    data.energy = strength
    obj = bpy.data.objects.new("sun", data)
    bpy.context.scene.collection.objects.link(obj)
    obj.rotation_euler = (-Vector(direction)).to_track_quat("Z", "Y").to_euler()
    return obj


def export(folder):
    """Writes scene.toml and the meshes; the configs in render_configs take the place of the exporter's own."""
    spec = importlib.util.spec_from_file_location("limn_export", os.path.join(ROOT, "src", "blender", "export.py"))
    exporter = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(exporter)
    bpy.context.view_layer.update()
    exporter.export(bpy.context, folder)
    for name in os.listdir(folder):
        if name.endswith(".toml") and name != "scene.toml":
            os.remove(os.path.join(folder, name))
