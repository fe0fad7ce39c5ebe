"""Builds a scene with every hard thing at once, exports it, and writes down what Blender itself makes of it.

blender -b -P round_trip.py -- EXPORTER OUT_DIR
"""

import math
import os
import sys

import bpy
import bmesh
from mathutils import Euler, Matrix

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from common import exporter, out, scene


def add(name, data, matrix=Matrix.Identity(4)):
    obj = bpy.data.objects.new(name, data)
    obj.matrix_world = matrix
    scene.collection.objects.link(obj)
    return obj


def subsurf(obj, limit, level=2, **settings):
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = 0, level  # what is on the screen must not matter
    modifier.use_limit_surface = limit
    modifier.quality = 10  # Blender too stops short of the limit near creases, unless told otherwise
    for key, value in settings.items():
        setattr(modifier, key, value)
    return modifier


def mesh_from(name, build, uvs=True):
    mesh = bpy.data.meshes.new(name)
    bm = bmesh.new()
    build(bm)
    bm.to_mesh(mesh)
    bm.free()
    if uvs:
        # Each face unwrapped on its own at a place of its own: seams everywhere but where neighbours happen to agree.
        layer = mesh.uv_layers.new(name="UVMap")
        for polygon in mesh.polygons:
            for k, corner in enumerate(polygon.loop_indices):
                if polygon.index % 3 == 0:  # an island that follows the positions, so that some edges are no seams
                    co = mesh.vertices[mesh.loops[corner].vertex_index].co
                    layer.data[corner].uv = (co.x * 0.25 + co.z * 0.1, co.y * 0.25 + co.z * 0.07)
                else:
                    angle = 2 * math.pi * k / len(polygon.loop_indices)
                    layer.data[corner].uv = (polygon.index * 0.1 + 0.04 * math.cos(angle), 0.04 * math.sin(angle))
    return mesh


def creased_cube(bm):
    bmesh.ops.create_cube(bm, size=2)


cube = mesh_from("Creased", creased_cube)
for edge, crease in zip(cube.edges, (0.2, 0.5, 0.9, 1.0, 0, 0, 0.35, 0, 0, 0, 0, 0)):
    edge.crease = crease
bm = bmesh.new()
bm.from_mesh(cube)
layer = bm.verts.layers.crease.verify()
bm.verts.ensure_lookup_table()
for index, crease in ((2, 0.6), (5, 1.0)):
    bm.verts[index][layer] = crease
bm.to_mesh(cube)
bm.free()


def ngons(bm):
    bmesh.ops.create_cone(bm, cap_ends=True, segments=7, radius1=1.2, radius2=0.7, depth=2)
    bmesh.ops.create_cube(bm, size=0.8, matrix=Matrix.Translation((0, 0, 2)))


def sheet(bm):
    bmesh.ops.create_grid(bm, x_segments=3, y_segments=2, size=1)
    for vertex in bm.verts:
        vertex.co.z = 0.3 * math.sin(3 * vertex.co.x) + 0.2 * vertex.co.y


for limit in (False, True):
    suffix = "_limit" if limit else "_plain"
    shift = 12.0 if limit else 0.0
    obj = add("creased" + suffix, cube, Matrix.Translation((0, shift, 0)) @ Euler((0.3, 0.2, 0.9)).to_matrix().to_4x4())
    subsurf(obj, limit)
    obj = add(
        "ngons" + suffix,
        mesh_from("Ngons" + suffix, ngons),
        Matrix.Translation((4, shift, 0)) @ Matrix.Diagonal((1, 1.4, 0.8, 1)),
    )
    subsurf(obj, limit)
    obj = add("sheet" + suffix, mesh_from("Sheet" + suffix, sheet), Matrix.Translation((-4, shift, 0)))
    subsurf(obj, limit, boundary_smooth="ALL", uv_smooth="PRESERVE_CORNERS")
    # Mirrored and arrayed before it is subdivided: creases survive.
    half = mesh_from(
        "Half" + suffix, lambda bm: bmesh.ops.create_cube(bm, size=1, matrix=Matrix.Translation((0.9, 0, 0)))
    )
    for index, edge in enumerate(half.edges):
        edge.crease = 0.7 if index % 4 == 0 else 0
    obj = add("mirrored" + suffix, half, Matrix.Translation((8, shift, 0)))
    mirror = obj.modifiers.new("Mirror", "MIRROR")
    mirror.use_axis = (True, True, False)
    array = obj.modifiers.new("Array", "ARRAY")
    array.count, array.relative_offset_displace = 2, (0, 0, 1.5)
    subsurf(obj, limit)

# Instances of a collection, one of them mirrored.
group = bpy.data.collections.new("Group")
part = bpy.data.objects.new(
    "part", mesh_from("Part", lambda bm: bmesh.ops.create_icosphere(bm, subdivisions=1, radius=0.8))
)
group.objects.link(part)
for index, matrix in enumerate(
    (Matrix.Translation((0, 5, 2)), Matrix.Translation((3, 6, 0)) @ Matrix.Diagonal((-1, 1, 2, 1)))
):
    empty = add("instance%d" % index, None, matrix)
    empty.instance_type, empty.instance_collection = "COLLECTION", group

hidden = add("hidden in render", mesh_from("Hidden", creased_cube), Matrix.Translation((0, 0, 4)))
hidden.hide_render = True
shown = add("hidden on screen", mesh_from("Shown", creased_cube), Matrix.Translation((-4, 6, 1)))
shown.hide_viewport = True

scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 800, 600, 50


def camera(name, place, at, **settings):
    data = bpy.data.cameras.new(name)
    for key, value in settings.items():
        setattr(data, key, value)
    obj = add(name, data)
    direction = Matrix.Translation(place).translation - Matrix.Translation(at).translation
    obj.matrix_world = Matrix.Translation(place) @ direction.to_track_quat("Z", "Y").to_matrix().to_4x4()
    return obj


cameras = [
    camera("plain", (14, -16, 9), (2, 6, 0), lens=32),
    camera("shifted", (-14, -10, 6), (2, 6, 0), lens=28, shift_x=0.12, shift_y=-0.08),
    camera("upright sensor", (6, -18, 5), (2, 6, 0), lens=30, sensor_fit="VERTICAL", sensor_height=24),
    camera("orthographic", (10, -14, 14), (2, 6, 0), type="ORTHO", ortho_scale=24, shift_x=-0.05),
]
scene.camera = cameras[0]
sun = bpy.data.lights.new("Sun", "SUN")
add("Sun", sun, Euler((0.7, 0.2, 0.4)).to_matrix().to_4x4())
area = bpy.data.lights.new("Window", "AREA")
add("Window", area)

# Colours of vertices, and a mask.
painted = mesh_from("Painted", lambda bm: bmesh.ops.create_grid(bm, x_segments=1, y_segments=1, size=1), uvs=True)
paint = painted.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
for item, color in zip(paint.data, ((1, 0, 0, 1), (0, 0.5, 0, 1), (0, 0, 0.25, 1), (1, 1, 1, 1))):
    item.color = color
painted.color_attributes.active_color = paint
material = bpy.data.materials.new("paint")
material.use_nodes = True
nodes, links = material.node_tree.nodes, material.node_tree.links
source = nodes.new("ShaderNodeVertexColor")
links.new(source.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
painted.materials.append(material)
add("painted", painted, Matrix.Translation((0, 9, 3)))
image = bpy.data.images.new("leaf", 8, 8, alpha=True)
image.pixels = [c for y in range(8) for x in range(8) for c in (0.2, 0.6, 0.1, 1.0 if x < 4 else 0.0)]
leaf = bpy.data.materials.new("leaf")
leaf.use_nodes, leaf.blend_method = True, "CLIP"
nodes, links = leaf.node_tree.nodes, leaf.node_tree.links
source = nodes.new("ShaderNodeTexImage")
source.image = image
links.new(source.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
links.new(source.outputs["Alpha"], nodes["Principled BSDF"].inputs["Alpha"])
foliage = mesh_from("Foliage", lambda bm: bmesh.ops.create_grid(bm, x_segments=1, y_segments=1, size=1))
foliage.materials.append(leaf)
add("foliage", foliage, Matrix.Translation((0, 12, -3)) @ Matrix.Diagonal((0.01, 0.01, 0.01, 1)))

# Copies that differ in the last bit, as those of objects that Blender turned do, and by more.
for index, factor in enumerate((1, 1 + 1e-7, 1 + 1e-5)):
    twin = add(
        "twin%d" % index,
        mesh_from(
            "Twin%d" % index, lambda bm: bmesh.ops.create_icosphere(bm, subdivisions=1, radius=0.7 * factor), uvs=False
        ),
        Matrix.Translation((0, 12, -3.5)) @ Matrix.Diagonal((0.01, 0.01, 0.01, 1)),
    )
    subsurf(twin, False)

inked = bpy.data.materials.new("inked")
inked.line_color = (0.8, 0.1, 0.05, 1)
next(o for o in scene.objects if o.type == "MESH").data.materials.append(inked)
exporter.export(bpy.context, out)

# Blender's own evaluation, at the render levels.
os.makedirs(os.path.join(out, "truth"), exist_ok=True)
for obj in scene.objects:
    for modifier in obj.modifiers:
        if modifier.type == "SUBSURF":
            modifier.levels = modifier.render_levels
bpy.context.view_layer.update()
depsgraph = bpy.context.evaluated_depsgraph_get()
for obj in scene.objects:
    if obj.type != "MESH" or not any(m.type == "SUBSURF" for m in obj.modifiers):
        continue
    mesh = obj.evaluated_get(depsgraph).to_mesh()
    with open(os.path.join(out, "truth", obj.name + ".obj"), "w") as file:
        for vertex in mesh.vertices:
            file.write("v %.9g %.9g %.9g\n" % tuple(vertex.co))
        layer = mesh.uv_layers.active
        for item in layer.data if layer else []:
            file.write("vt %.9g %.9g\n" % tuple(item.uv))
        for polygon in mesh.polygons:
            file.write(
                "f "
                + " ".join(
                    ("%d/%d" % (mesh.loops[c].vertex_index + 1, c + 1))
                    if layer
                    else str(mesh.loops[c].vertex_index + 1)
                    for c in polygon.loop_indices
                )
                + "\n"
            )

# Where Blender's own renderer sees anything.
shown.hide_viewport = False
scene.render.engine = "BLENDER_WORKBENCH"
scene.render.film_transparent = True
scene.display.render_aa = "OFF"
scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "PNG", "RGBA"
for obj in cameras:
    scene.camera = obj
    scene.render.filepath = os.path.join(out, "truth", obj.name.replace(" ", "_") + ".png")
    bpy.ops.render.render(write_still=True)
