"""Identity: things that share a name, or an object that stands for several meshes.

blender -b --factory-startup --python-exit-code 1 -P make_identity.py     (after make_libraries.py)
"""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stationlib import *  # noqa: F401,F403 - a small language for these files

LEFT, RIGHT = (-0.7, 0, 0), (0.7, 0, 0)
LIB_A, LIB_B = os.path.join(BLENDS, "lib_a.blend"), os.path.join(BLENDS, "lib_b.blend")


# Names that libraries share. Linked objects cannot be moved: they are shown by instances.


def show_linked(s, text, obj, at):
    group = s.group(text)
    group.objects.link(obj)
    s.instance(text + " instance", group, at)


def local_twin(s, name, size=0.9, **settings):
    """A local object whose object, mesh and material are called as the libraries' are."""
    paint = bpy.data.materials.get("Twin paint")
    if paint is None or paint.library:
        paint = painted("Twin paint", (0.8, 0.1, 0.1))
    mesh = cube_mesh(name + " mesh", size, [paint])
    obj = bpy.data.objects.new(name, mesh)
    obj.rotation_euler = TURN
    for key, value in settings.items():
        setattr(obj, key, value)
    return obj


def twin_objects(s):
    """Object, mesh and material called the same here and in a library"""
    obj = local_twin(s, "Twin")
    s.scene.collection.objects.link(obj)
    obj.location = s.origin
    obj.location.x += LEFT[0]
    (objects,) = link_library(LIB_A, objects=["Twin"])
    show_linked(s, "linked", objects[0], RIGHT)


def twin_libraries(s):
    """Object, mesh and material called the same in two libraries"""
    for text, path, at in (("a", LIB_A, LEFT), ("b", LIB_B, RIGHT)):
        (objects,) = link_library(path, objects=["Twin"])
        show_linked(s, text, objects[0], at)


def twin_materials(s):
    """Materials called the same in two libraries, meshes called otherwise"""
    for text, path, at in (("a", LIB_A, LEFT), ("b", LIB_B, RIGHT)):
        (objects,) = link_library(path, objects=["Twin plain"])
        show_linked(s, text, objects[0], at)


def twin_modified(s):
    """Objects with modifiers called the same in two libraries"""
    for text, path, at in (("a", LIB_A, LEFT), ("b", LIB_B, RIGHT)):
        (objects,) = link_library(path, objects=["Twin modified"])
        show_linked(s, text, objects[0], at)


def twin_slots(s):
    """One local mesh with both libraries' materials of the same name"""
    paints = [link_library(path, materials=["Twin paint"])[0][0] for path in (LIB_A, LIB_B)]
    mesh = s.plane(cuts=2, materials=paints)
    for polygon in mesh.polygons:
        polygon.material_index = polygon.index % 2
    s.put("plane", mesh, turn=(0, 0, 0))


def twin_meshes_direct(s):
    """Only the mesh is linked: called as the local one"""
    (meshes,) = link_library(LIB_A, meshes=["Twin mesh"])
    s.put("linked", meshes[0], RIGHT)
    mesh = cube_mesh("Twin mesh", 0.9, [s.paint()])
    s.put("local", mesh, LEFT)


# Geometry nodes.


def points_group(s):
    """Nodes with two points left and right, and an instancer on them."""
    nodes, entry, out = geometry_group(s.named("nodes"))
    line = nodes.new("GeometryNodeMeshLine")
    line.inputs["Count"].default_value = 2
    line.inputs["Start Location"].default_value = LEFT
    line.inputs["Offset"].default_value = (1.4, 0, 0)
    on_points = nodes.new("GeometryNodeInstanceOnPoints")
    nodes.link(line, "Mesh", on_points, "Points")
    return nodes, entry, out, on_points


def node_cone(nodes, paint):
    cone, setter = nodes.new("GeometryNodeMeshCone"), nodes.new("GeometryNodeSetMaterial")
    cone.inputs["Radius Bottom"].default_value, cone.inputs["Depth"].default_value = 0.5, 1.0
    setter.inputs["Material"].default_value = paint
    nodes.link(cone, "Mesh", setter, "Geometry")
    return setter


def node_ball(nodes, paint, radius=0.5):
    ball, setter = nodes.new("GeometryNodeMeshUVSphere"), nodes.new("GeometryNodeSetMaterial")
    ball.inputs["Radius"].default_value = radius
    setter.inputs["Material"].default_value = paint
    nodes.link(ball, "Mesh", setter, "Geometry")
    return setter


def host_with(s, nodes, data=None, turn=(0, 0, 0)):
    host = s.put("host", data or s.cube("host", 0.5), turn=turn)
    modifier(host, "NODES", node_group=nodes.tree)
    return host


def bare_instances(s):
    """Instances of a bare mesh (cones on two points)"""
    nodes, _, out, on_points = points_group(s)
    nodes.link(node_cone(nodes, s.paint("cone", 2)), 0, on_points, "Instance")
    nodes.link(on_points, 0, out, 0)
    host_with(s, nodes)


def bare_instances_joined(s):
    """Instances of a bare mesh beside the object's own mesh"""
    nodes, entry, out, on_points = points_group(s)
    nodes.link(node_cone(nodes, s.paint("cone", 2)), 0, on_points, "Instance")
    join = nodes.new("GeometryNodeJoinGeometry")
    nodes.link(entry, 0, join, 0)
    nodes.link(on_points, 0, join, 0)
    nodes.link(join, 0, out, 0)
    host_with(s, nodes)


def bare_kinds(s):
    """Instances of two bare meshes in turn (cone, ball)"""
    nodes, _, out, on_points = points_group(s)
    kinds = nodes.new("GeometryNodeGeometryToInstance")
    nodes.link(node_cone(nodes, s.paint("cone", 2)), 0, kinds, 0)
    nodes.link(node_ball(nodes, s.paint("ball", 5)), 0, kinds, 0)
    nodes.link(kinds, 0, on_points, "Instance")
    on_points.inputs["Pick Instance"].default_value = True
    nodes.link(on_points, 0, out, 0)
    host_with(s, nodes)


def object_info(s):
    """Instances of another object (Object Info, as instance), hidden itself"""
    nodes, _, out, on_points = points_group(s)
    part = s.put("part", s.cone("part", 0.5, 1.0))
    part.hide_render = True
    info = nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = part
    info.inputs["As Instance"].default_value = True
    nodes.link(info, "Geometry", on_points, "Instance")
    nodes.link(on_points, 0, out, 0)
    host_with(s, nodes)


def collection_pick(s):
    """Instances of a collection's children in turn"""
    nodes, _, out, on_points = points_group(s)
    group = s.group("group")
    s.put("a cone", s.cone("a cone", 0.5, 1.0), into=group)
    s.put("b ball", s.sphere("b ball", 0.5), into=group)
    info = nodes.new("GeometryNodeCollectionInfo")
    info.inputs["Collection"].default_value = group
    info.inputs["Separate Children"].default_value = info.inputs["Reset Children"].default_value = True
    nodes.link(info, 0, on_points, "Instance")
    on_points.inputs["Pick Instance"].default_value = True
    nodes.link(on_points, 0, out, 0)
    host_with(s, nodes)


def bare_instances_scattered(s):
    """Two objects with the same group of bare instances"""
    nodes, _, out, on_points = points_group(s)
    nodes.link(node_cone(nodes, s.paint("cone", 2)), 0, on_points, "Instance")
    nodes.link(on_points, 0, out, 0)
    for number, z in enumerate((-0.7, 0.7)):
        host = s.put("host %d" % number, s.cube("host %d" % number, 0.3), (0, 0, z), (0, 0, 0))
        modifier(host, "NODES", node_group=nodes.tree)


def bare_in_collection(s):
    """Bare instances on an object in an instanced collection"""
    nodes, _, out, on_points = points_group(s)
    nodes.link(node_cone(nodes, s.paint("cone", 2)), 0, on_points, "Instance")
    nodes.link(on_points, 0, out, 0)
    group = s.group("group")
    host = s.put("host", s.cube("host", 0.4), turn=(0, 0, 0), into=group)
    modifier(host, "NODES", node_group=nodes.tree)
    s.instance("instance", group)


def string_to_curves(s):
    """Text by geometry nodes: each letter an instance of its own mesh"""
    nodes, _, out = geometry_group(s.named("nodes"))
    letters, fill = nodes.new("GeometryNodeStringToCurves"), nodes.new("GeometryNodeFillCurve")
    setter, turn = nodes.new("GeometryNodeSetMaterial"), nodes.new("GeometryNodeTransform")
    letters.inputs["String"].default_value, letters.inputs["Size"].default_value = "LOX", 1.4
    setter.inputs["Material"].default_value = s.paint("letters", 3)
    turn.inputs["Rotation"].default_value, turn.inputs["Translation"].default_value = (1.5707963, 0, 0), (-1.2, 0, -0.5)
    nodes.link(letters, 0, fill, 0)
    nodes.link(fill, 0, setter, 0)
    nodes.link(setter, 0, turn, 0)
    nodes.link(turn, 0, out, 0)
    host_with(s, nodes)


def set_material(s):
    """Set Material on the object's own mesh"""
    nodes, entry, out = geometry_group(s.named("nodes"))
    setter = nodes.new("GeometryNodeSetMaterial")
    setter.inputs["Material"].default_value = s.paint("set", 3)
    nodes.link(entry, 0, setter, 0)
    nodes.link(setter, 0, out, 0)
    host_with(s, nodes, s.cube("host"), TURN)


def set_material_half(s):
    """Set Material on half of the faces"""
    nodes, entry, out = geometry_group(s.named("nodes"))
    setter, place = nodes.new("GeometryNodeSetMaterial"), nodes.new("GeometryNodeInputPosition")
    split, test = nodes.new("ShaderNodeSeparateXYZ"), nodes.new("FunctionNodeCompare")
    test.data_type, test.operation = "FLOAT", "GREATER_THAN"
    setter.inputs["Material"].default_value = s.paint("set", 3)
    nodes.link(place, 0, split, 0)
    nodes.link(split, 0, test, 0)
    nodes.link(test, 0, setter, "Selection")
    nodes.link(entry, 0, setter, 0)
    nodes.link(setter, 0, out, 0)
    host_with(s, nodes, s.plane("host", cuts=2))


def replace_material(s):
    """Replace Material"""
    nodes, entry, out = geometry_group(s.named("nodes"))
    replacer, old = nodes.new("GeometryNodeReplaceMaterial"), s.paint("old")
    replacer.inputs["Old"].default_value, replacer.inputs["New"].default_value = old, s.paint("new", 3)
    nodes.link(entry, 0, replacer, 0)
    nodes.link(replacer, 0, out, 0)
    host_with(s, nodes, s.cube("host", materials=[old]), TURN)


def set_material_index(s):
    """Set Material Index among the object's slots"""
    nodes, entry, out = geometry_group(s.named("nodes"))
    setter = nodes.new("GeometryNodeSetMaterialIndex")
    setter.inputs["Material Index"].default_value = 1
    nodes.link(entry, 0, setter, 0)
    nodes.link(setter, 0, out, 0)
    host_with(s, nodes, s.cube("host", materials=[s.paint("a"), s.paint("b", 3)]), TURN)


def joined_materials(s):
    """Another object's mesh joined by nodes, with its own material"""
    nodes, entry, out = geometry_group(s.named("nodes"))
    part = s.put("part", s.cone("part", 0.5, 1.0, [s.paint("part", 3)]))
    part.hide_render = True
    info, join = nodes.new("GeometryNodeObjectInfo"), nodes.new("GeometryNodeJoinGeometry")
    info.inputs["Object"].default_value = part
    move = nodes.new("GeometryNodeTransform")
    move.inputs["Translation"].default_value = RIGHT
    nodes.link(info, "Geometry", move, 0)
    nodes.link(entry, 0, join, 0)
    nodes.link(move, 0, join, 0)
    nodes.link(join, 0, out, 0)
    host_with(s, nodes, s.cube("host", 0.7))


def curve_to_mesh(s):
    """Mesh made of a curve object by nodes"""
    nodes, entry, out = geometry_group(s.named("nodes"))
    sweep, circle = nodes.new("GeometryNodeCurveToMesh"), nodes.new("GeometryNodeCurvePrimitiveCircle")
    setter = nodes.new("GeometryNodeSetMaterial")
    circle.inputs["Radius"].default_value = 0.2
    setter.inputs["Material"].default_value = s.paint("set", 3)
    nodes.link(entry, 0, sweep, "Curve")
    nodes.link(circle, 0, sweep, "Profile Curve")
    nodes.link(sweep, 0, setter, 0)
    nodes.link(setter, 0, out, 0)
    curve = bpy.data.curves.new(s.named("curve"), "CURVE")
    curve.dimensions = "3D"
    spline = curve.splines.new("POLY")
    spline.points.add(2)
    for point, (x, z) in zip(spline.points, ((-0.9, -0.6), (0, 0.7), (0.9, -0.6))):
        point.co = (x, 0, z, 1)
    host_with(s, nodes, curve)


# One mesh, many objects.


def object_slots(s):
    """Shared mesh: the second object has its own material in the slot"""
    mesh = s.cube("shared", 0.9)
    s.put("first", mesh, LEFT)
    second = s.put("second", mesh, RIGHT)
    second.material_slots[0].link = "OBJECT"
    second.material_slots[0].material = s.paint("own", 3)


def pinned_shape(s):
    """Shared mesh with shape keys: the second object pins another key"""
    mesh = s.cube("shared", 0.8)
    first, second = s.put("first", mesh, LEFT), s.put("second", mesh, RIGHT)
    first.shape_key_add(name="Basis")
    key = first.shape_key_add(name="Tall")
    for point in key.data:
        point.co.z *= 2
    second.show_only_shape_key, second.active_shape_key_index = True, 1


def shared_and_modified(s):
    """Shared mesh: the second object has an array"""
    mesh = s.cube("shared", 0.5)
    s.put("first", mesh, LEFT)
    modifier(s.put("second", mesh, (0.2, 0, 0)), "ARRAY", count=2)


def boolean_materials(s):
    """Boolean union with an object of another material"""
    other = s.put("other", s.sphere("other", 0.5, [s.paint("other", 3)]), (0.6, -0.3, 0.2))
    other.hide_render = True
    modifier(s.put("cube", s.cube("cube", 0.9)), "BOOLEAN", operation="UNION", object=other)


def names_of_instances(s):
    """An object called like an instance's path"""
    group = s.group("group")
    part = s.put("part", s.cube("part", 0.6), into=group)
    empty = s.instance("instance", group, LEFT)
    other = s.put("other", s.sphere("other", 0.4), RIGHT)
    other.name = "%s/%s" % (empty.name, part.name)


def names_of_seconds(s):
    """An object called like the second of two instances (NAME.2)"""
    group = s.group("group")
    part = s.put("part", s.cube("part", 0.5), into=group)
    host = s.put("host", s.plane("host", width=1.6, height=0.01), (0, 0, -0.6), (0, 0, 0))
    child = s.put("child", s.cube("child", 0.5))
    host.instance_type = "VERTS"
    child.parent, child.location = host, (0, 0, 0)
    other = s.put("other", s.sphere("other", 0.4), (0, 0, 0.6))
    other.name = "%s/%s.2" % (host.name, child.name)
    s.instance("instance", group, (0, 0, 0))
    del part


def similar_file_names(s):
    """Meshes whose names differ only in letters that file names do not take"""
    for number, (name, at) in enumerate((("mesh ü", LEFT), ("mesh ö", (0, 0, 0)), ("MESH ü", RIGHT))):
        mesh = (s.cube, s.sphere, s.cone)[number]("x", 0.5)
        mesh.name = s.named(name)
        s.put("object %d" % number, mesh, at)


def dupli_materials(s):
    """Particle and object colours aside: instance of an object with its material in an object slot"""
    group = s.group("group")
    mesh = s.cube("shared", 0.8)
    part = s.put("part", mesh, into=group)
    part.material_slots[0].link = "OBJECT"
    part.material_slots[0].material = s.paint("own", 3)
    s.instance("instance", group, RIGHT)
    s.put("plain", mesh, LEFT)


IDENTITY = [
    twin_objects, twin_libraries, twin_materials, twin_modified, twin_slots, twin_meshes_direct, bare_instances,
    bare_instances_joined, bare_kinds, object_info, collection_pick, bare_instances_scattered, bare_in_collection,
    string_to_curves, set_material, set_material_half, replace_material, set_material_index, joined_materials,
    curve_to_mesh, object_slots, pinned_shape, shared_and_modified, boolean_materials, names_of_instances,
    names_of_seconds, similar_file_names, dupli_materials,
]

if __name__ == "__main__":
    sheet_of("identity", "I", IDENTITY, columns=7).save()
