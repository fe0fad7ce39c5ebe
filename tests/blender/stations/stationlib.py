"""Builds sheets of test stations in Blender: small separate situations in a grid, seen by one orthographic camera.

A sheet is one .blend with a .json beside it that says where in the picture each station lies and what to compare.
"""

import colorsys
import json
import math
import os

import bmesh
import bpy
from mathutils import Vector

HERE = os.path.dirname(os.path.abspath(__file__))
BLENDS = os.environ["STATIONS_BLENDS"]
CELL = 3.0  # width of a station in scene units
TURN = (0.5, 0.3, 0.4)  # solids are turned so that their silhouettes tell more


def reset():
    """An empty scene without anything of the last sheet."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    return scene


def hue(index, value=0.8):
    """A colour that differs from its neighbours', linear."""
    return colorsys.hsv_to_rgb((index * 0.381966) % 1.0, 0.75, value)


def mesh_from(name, build, materials=(), smooth=False):
    """A mesh made by a function of a bmesh."""
    mesh = bpy.data.meshes.new(name)
    bm = bmesh.new()
    build(bm)
    bm.to_mesh(mesh)
    bm.free()
    for material in materials:
        mesh.materials.append(material)
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(mesh.polygons))
    return mesh


def cube_mesh(name, size=1.4, materials=()):
    return mesh_from(name, lambda bm: bmesh.ops.create_cube(bm, size=size), materials)


def sphere_mesh(name, radius=0.9, materials=(), segments=24):
    def build(bm):
        bmesh.ops.create_uvsphere(bm, u_segments=segments, v_segments=max(3, segments // 2), radius=radius)

    return mesh_from(name, build, materials)


def cone_mesh(name, radius=0.8, depth=1.6, materials=()):
    def build(bm):
        bmesh.ops.create_cone(bm, cap_ends=True, segments=24, radius1=radius, radius2=0.0, depth=depth)

    return mesh_from(name, build, materials)


def sheet_mesh(name, width=2.2, height=2.2, cuts=1, materials=(), layers=("UVMap",)):
    """An upright rectangle that faces the camera, with UV layers: the first straight, others turned and smaller."""
    mesh = bpy.data.meshes.new(name)
    points = [(width * (i / cuts - 0.5), 0.0, height * (j / cuts - 0.5))
              for j in range(cuts + 1) for i in range(cuts + 1)]
    row = cuts + 1
    faces = [(j * row + i, j * row + i + 1, (j + 1) * row + i + 1, (j + 1) * row + i)
             for j in range(cuts) for i in range(cuts)]
    mesh.from_pydata(points, [], faces)
    mesh.update(calc_edges=True)
    for number, layer_name in enumerate(layers):
        layer = mesh.uv_layers.new(name=layer_name)
        for loop, item in zip(mesh.loops, layer.data):
            place = mesh.vertices[loop.vertex_index].co
            u, v = place.x / width + 0.5, place.z / height + 0.5
            item.uv = (u, v) if number == 0 else (0.1 + 0.5 * v, 0.2 + 0.5 * (1 - u))
    for material in materials:
        mesh.materials.append(material)
    return mesh


def painted(name, color, **inputs):
    """A material with a Principled shader."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    for key, value in inputs.items():
        shader.inputs[key].default_value = value
    material.diffuse_color = (0.25, 0.25, 0.25, 1.0)  # what is on the screen must not matter
    return material


def blocks_image(name, size=128, blocks=4, alpha=None, seed=0, save_to=None):
    """An image of coloured blocks, each unlike the others. `alpha`: function of (u, v)."""
    pixels = []
    for y in range(size):
        for x in range(size):
            index = (y * blocks // size) * blocks + x * blocks // size
            color = colorsys.hsv_to_rgb((index * 0.381966 + seed * 0.17) % 1.0, 0.7, 0.45 + 0.5 * (index % 3) / 2)
            pixels += (*color, 1.0 if alpha is None else alpha((x + 0.5) / size, (y + 0.5) / size))
    image = bpy.data.images.new(name, size, size, alpha=True)
    image.pixels = pixels
    if save_to:
        image.filepath_raw, image.file_format = save_to, "PNG"
        image.save()
        bpy.data.images.remove(image)
        return bpy.data.images.load(save_to)
    image.pack()
    return image


class Nodes:
    """A node tree, written tersely: nodes by type, links by name or number of sockets."""

    def __init__(self, tree, clear=True):
        self.tree = tree
        if clear:
            tree.nodes.clear()

    def new(self, kind, **settings):
        node = self.tree.nodes.new(kind)
        for key, value in settings.items():
            setattr(node, key, value)
        return node

    def link(self, source, output, target, entry):
        self.tree.links.new(source.outputs[output], target.inputs[entry])


def node_material(name):
    """An empty material, its nodes, and its output."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.diffuse_color = (0.25, 0.25, 0.25, 1.0)
    nodes = Nodes(material.node_tree)
    return material, nodes, nodes.new("ShaderNodeOutputMaterial")


def geometry_group(name):
    """An empty group of geometry nodes with one geometry in and out."""
    tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
    tree.inputs.new("NodeSocketGeometry", "Geometry")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    nodes = Nodes(tree, clear=False)
    return nodes, nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")


class Station:
    """One situation in one cell of a sheet. All its names begin with its code, so that the summary can be searched."""

    def __init__(self, sheet, code, title, origin, index):
        self.sheet, self.code, self.title, self.origin, self.index = sheet, code, title, Vector(origin), index
        self.scene = sheet.scene
        self.color = hue(index)
        self.extra = {}

    def named(self, text):
        return "%s %s" % (self.code, text)

    def paint(self, text="paint", shift=0.0, **inputs):
        return painted(self.named(text), hue(self.index + shift), **inputs)

    def cube(self, text="cube", size=1.4, materials=None):
        return cube_mesh(self.named(text), size, materials or [self.paint(text)])

    def sphere(self, text="sphere", radius=0.9, materials=None, segments=24):
        return sphere_mesh(self.named(text), radius, materials or [self.paint(text)], segments)

    def cone(self, text="cone", radius=0.8, depth=1.6, materials=None):
        return cone_mesh(self.named(text), radius, depth, materials or [self.paint(text)])

    def plane(self, text="plane", **settings):
        settings.setdefault("materials", [self.paint(text)])
        return sheet_mesh(self.named(text), **settings)

    def put(self, text, data, at=(0, 0, 0), turn=TURN, into=None):
        """An object in the scene at this station, or in a collection, at that one's own origin."""
        obj = bpy.data.objects.new(self.named(text), data)
        obj.rotation_euler = turn
        obj.location = Vector(at) + (Vector() if into else self.origin)
        (into or self.scene.collection).objects.link(obj)
        return obj

    def group(self, text, inside=None):
        """A collection that is not in the scene, or in another one."""
        collection = bpy.data.collections.new(self.named(text))
        if inside:
            inside.children.link(collection)
        return collection

    def shown_group(self, text):
        """A collection in the scene, and its layer collection."""
        collection = self.group(text, self.scene.collection)
        return collection, bpy.context.view_layer.layer_collection.children[collection.name]

    def instance(self, text, collection, at=(0, 0, 0), into=None):
        empty = self.put(text, None, at, (0, 0, 0), into)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        return empty


def modifier(obj, kind, **settings):
    result = obj.modifiers.new(kind.title(), kind)
    for key, value in settings.items():
        setattr(result, key, value)
    return result


def subsurf(obj, viewport, render, **settings):
    return modifier(obj, "SUBSURF", levels=viewport, render_levels=render, **settings)


class Sheet:
    """One .blend: a grid of stations before an orthographic camera that looks along +Y."""

    def __init__(self, name, prefix, columns, rows, tile=90, frames=None, arguments=(), mode="flat", engine="CYCLES",
                 camera_name="front"):
        self.scene = reset()
        self.name, self.prefix, self.columns, self.rows, self.tile = name, prefix, columns, rows, tile
        self.stations = []
        self.record = {"name": name, "mode": mode, "engine": engine, "frames": list(frames or [1]),
                       "arguments": (["--frames"] if frames else []) + list(arguments), "camera": camera_name,
                       "size": [columns * tile, rows * tile], "stations": []}
        bpy.context.preferences.edit.use_negative_frames = True  # or a start below 0 becomes 0
        if frames:
            self.scene.frame_start, self.scene.frame_end = min(frames), max(frames)
        self.scene.frame_set(min(frames) if frames else 1)
        self.scene.render.resolution_x, self.scene.render.resolution_y = columns * tile, rows * tile
        self.scene.render.resolution_percentage = 100
        self.camera = self.add_camera(camera_name)
        self.scene.camera = self.camera

    def add_camera(self, name):
        data = bpy.data.cameras.new(name)
        data.type, data.clip_end = "ORTHO", 200
        data.ortho_scale = CELL * max(self.columns, self.rows)
        camera = bpy.data.objects.new(name, data)
        camera.location, camera.rotation_euler = (0, -50, 0), (math.pi / 2, 0, 0)
        self.scene.collection.objects.link(camera)
        return camera

    def station(self, build):
        """Builds the next station by a function of it, whose docstring is the title."""
        index = len(self.stations)
        column, row = index % self.columns, index // self.columns
        if row >= self.rows:
            raise SystemExit("sheet %s is full" % self.name)
        origin = ((column + 0.5 - self.columns / 2) * CELL, 0, (self.rows / 2 - row - 0.5) * CELL)
        station = Station(self, "%s%02d" % (self.prefix, index + 1), build.__doc__.strip(), origin, index)
        build(station)
        self.stations.append(station)
        entry = {"code": station.code, "title": station.title, "function": build.__name__,
                 "rect": [column * self.tile, row * self.tile, (column + 1) * self.tile, (row + 1) * self.tile]}
        entry.update(station.extra)
        self.record["stations"].append(entry)
        return station

    def save(self, **extra):
        self.record.update(extra)
        os.makedirs(BLENDS, exist_ok=True)
        path = os.path.join(BLENDS, self.name + ".blend")
        bpy.ops.wm.save_as_mainfile(filepath=path, compress=False)
        with open(os.path.join(BLENDS, self.name + ".json"), "w", encoding="utf-8") as file:
            json.dump(self.record, file, indent=1, ensure_ascii=False)


def sheet_of(name, prefix, builds, columns=1, **settings):
    """A whole sheet from functions."""
    rows = -(-len(builds) // columns)
    sheet = Sheet(name, prefix, columns, rows, **settings)
    for build in builds:
        sheet.station(build)
    return sheet


def keys(owner, path, values, linear=True, index=-1):
    """Sets keys of a property, given by frame. A path such as `inputs[0].default_value` ends in a name."""
    for frame, value in values.items():
        if index >= 0:
            getattr(owner, path)[index] = value
        else:
            setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame, index=index)
    if linear:
        for curve in owner.id_data.animation_data.action.fcurves:
            for point in curve.keyframe_points:
                if point.interpolation == "BEZIER":
                    point.interpolation = "LINEAR"


def link_library(path, **wanted):
    """Links data-blocks of another file: link_library(path, objects=["a"]). Returns lists in the same order."""
    with bpy.data.libraries.load(path, link=True) as (_, target):
        for kind, names in wanted.items():
            setattr(target, kind, list(names))
    return [getattr(target, kind) for kind in wanted]

