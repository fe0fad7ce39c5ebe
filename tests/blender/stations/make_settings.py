"""Render settings everywhere: what Blender renders, not what it shows on the screen.

blender -b --factory-startup --python-exit-code 1 -P make_settings.py
"""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stationlib import *  # noqa: F401,F403 - a small language for these files


# Objects that live only in instanced collections.


def subsurf_instanced(s):
    """Subsurf levels (0 viewport, 3 render) in an instanced collection"""
    group = s.group("group")
    subsurf(s.put("cube", s.cube(), into=group), 0, 3)
    s.instance("instance", group)


def subsurf_middle_instanced(s):
    """Subsurf levels before another modifier, in an instanced collection"""
    group = s.group("group")
    obj = s.put("cube", s.cube(size=1.0), into=group)
    subsurf(obj, 0, 3)
    modifier(obj, "ARRAY", count=2, relative_offset_displace=(0.8, 0, 0))
    obj.location.x = -0.4
    s.instance("instance", group)


def array_viewport_off(s):
    """Array off in viewport, on in render, in an instanced collection"""
    group = s.group("group")
    modifier(s.put("cube", s.cube(size=0.6), (-0.6, 0, 0), into=group), "ARRAY", count=3, show_viewport=False)
    s.instance("instance", group)


def array_render_off(s):
    """Array on in viewport, off in render, in an instanced collection"""
    group = s.group("group")
    modifier(s.put("cube", s.cube(size=0.6), (-0.6, 0, 0), into=group), "ARRAY", count=3, show_render=False)
    s.instance("instance", group)


def hide_render_instanced(s):
    """hide_render object in an instanced collection (beside a shown one)"""
    group = s.group("group")
    s.put("shown", s.cube("shown", 0.8), (-0.6, 0, 0), into=group)
    s.put("hidden", s.cube("hidden", 0.8), (0.6, 0, 0), into=group).hide_render = True
    s.instance("instance", group)


def hide_viewport_instanced(s):
    """hide_viewport object in an instanced collection must be drawn"""
    group = s.group("group")
    s.put("shown", s.cube("shown", 0.8), (-0.6, 0, 0), into=group)
    s.put("screen", s.cube("screen", 0.8), (0.6, 0, 0), into=group).hide_viewport = True
    s.instance("instance", group)


def hidden_child_collection(s):
    """Child collection with hide_render in an instanced collection"""
    group = s.group("group")
    s.put("shown", s.cube("shown", 0.8), (-0.6, 0, 0), into=group)
    inner = s.group("inner", group)
    s.put("hidden", s.cube("hidden", 0.8), (0.6, 0, 0), into=inner)
    inner.hide_render = True
    s.instance("instance", group)


def screen_hidden_child_collection(s):
    """Child collection with hide_viewport in an instanced collection must be drawn"""
    group = s.group("group")
    s.put("shown", s.cube("shown", 0.8), (-0.6, 0, 0), into=group)
    inner = s.group("inner", group)
    s.put("screen", s.cube("screen", 0.8), (0.6, 0, 0), into=inner)
    inner.hide_viewport = True
    s.instance("instance", group)


def nested_instances(s):
    """Subsurf levels two instances deep"""
    inner, outer = s.group("inner"), s.group("outer")
    subsurf(s.put("cube", s.cube(), into=inner), 0, 3)
    s.instance("inner instance", inner, into=outer)
    s.instance("outer instance", outer)


def hidden_instancer(s):
    """Instancing empty with hide_render draws nothing"""
    group = s.group("group")
    s.put("cube", s.cube(), into=group)
    s.instance("instance", group).hide_render = True
    s.extra["empty"] = True


def screen_hidden_instancer(s):
    """Instancing empty with hide_viewport must be drawn"""
    group = s.group("group")
    s.put("cube", s.cube(), into=group)
    s.instance("instance", group).hide_viewport = True


# Linked libraries.


def linked_collection(s):
    """Instance of a linked collection: Subsurf levels, hide_render, hide_viewport"""
    (collections,) = link_library(os.path.join(BLENDS, "lib_a.blend"), collections=["Lib settings"])
    s.instance("instance", collections[0])


def linked_object(s):
    """Linked object in the scene: Subsurf levels (0 viewport, 3 render)"""
    (objects,) = link_library(os.path.join(BLENDS, "lib_a.blend"), objects=["Lib rounded"])
    s.scene.collection.objects.link(objects[0])  # stays where its file has it: in the middle of a sheet of one


def overridden_object(s):
    """Library override of an object with an array off in viewport"""
    (objects,) = link_library(os.path.join(BLENDS, "lib_a.blend"), objects=["Lib arrayed"])
    obj = objects[0].override_create()
    s.scene.collection.objects.link(obj)
    obj.location = s.origin
    obj.location.x -= 0.6


def collection_info(s):
    """Geometry nodes: Collection Info of a collection outside the scene, Subsurf levels"""
    group = s.group("group")
    subsurf(s.put("cube", s.cube(), into=group), 0, 3)
    nodes, _, out = geometry_group(s.named("nodes"))
    info = nodes.new("GeometryNodeCollectionInfo")
    info.inputs[0].default_value = group
    nodes.link(info, 0, out, 0)
    modifier(s.put("host", s.cube("host"), turn=(0, 0, 0)), "NODES", node_group=nodes.tree)


def vertex_instances(s):
    """Instances on vertices: child has Subsurf levels"""
    host = s.put("host", s.plane("host", width=1.2, height=1.2), turn=(0, 0, 0))
    host.instance_type = "VERTS"
    host.show_instancer_for_render = False
    child = s.put("child", s.cube("child", 0.7), turn=TURN)
    child.parent, child.location = host, (0, 0, 0)
    subsurf(child, 0, 3)


def particle_object_outside(s):
    """Particle instances of an object outside the scene with Subsurf levels"""
    hair_objects(s, s.cube("part", 3.0), 6)


# Resolutions.


def circle_curve(s, viewport, render, **settings):
    curve = bpy.data.curves.new(s.named("curve"), "CURVE")
    curve.resolution_u, curve.render_resolution_u = viewport, render
    spline = curve.splines.new("BEZIER")
    spline.bezier_points.add(3)
    spline.use_cyclic_u = True
    for point, (x, y) in zip(spline.bezier_points, ((1, 0), (0, 1), (-1, 0), (0, -1))):
        point.co = (x, 0, y)
        point.handle_left_type = point.handle_right_type = "AUTO"
    for key, value in settings.items():
        setattr(curve, key, value)
    curve.materials.append(s.paint())
    return curve


def curve_resolution(s):
    """Curve: resolution 1 on screen, 16 in render"""
    s.put("curve", circle_curve(s, 1, 16, dimensions="3D", bevel_depth=0.15), turn=(0, 0, 0))


def curve_resolution_zero(s):
    """Curve: render resolution 0 means as on screen (8)"""
    s.put("curve", circle_curve(s, 8, 0, dimensions="3D", bevel_depth=0.15), turn=(0, 0, 0))


def curve_instanced(s):
    """Curve resolution in an instanced collection"""
    group = s.group("group")
    s.put("curve", circle_curve(s, 1, 16, dimensions="3D", bevel_depth=0.15), turn=(0, 0, 0), into=group)
    s.instance("instance", group)


def surface_resolution(s):
    """NURBS surface: resolution 1 on screen, 12 in render"""
    bpy.ops.surface.primitive_nurbs_surface_sphere_add(radius=1.0, location=s.origin)
    obj = bpy.context.object
    obj.name = obj.data.name = s.named("surface")
    obj.data.resolution_u = obj.data.resolution_v = 1
    obj.data.splines[0].resolution_u = obj.data.splines[0].resolution_v = 1
    obj.data.render_resolution_u = obj.data.render_resolution_v = 12
    obj.data.materials.append(s.paint())


def text_resolution(s):
    """Text: resolution 1 on screen, 12 in render"""
    text = bpy.data.curves.new(s.named("text"), "FONT")
    text.body, text.size, text.align_x, text.align_y = "O", 3.0, "CENTER", "CENTER"
    text.resolution_u, text.render_resolution_u = 1, 12
    text.materials.append(s.paint())
    s.put("text", text, turn=(1.5707963, 0, 0))


def metaball(s, name, into=None):
    ball = bpy.data.metaballs.new(s.named(name))
    ball.resolution, ball.render_resolution = 1.0, 0.1
    for x in (-0.4, 0.4):
        element = ball.elements.new()
        element.co, element.radius = (x, 0, 0), 1.0
    ball.materials.append(s.paint())
    return s.put(name, ball, into=into)


def metaball_resolution(s):
    """Metaball: resolution 1 on screen, 0.1 in render"""
    metaball(s, "ball")


def screw_steps(s):
    """Screw: 3 steps on screen, 32 in render"""
    mesh = bpy.data.meshes.new(s.named("profile"))
    mesh.from_pydata([(0.3, 0, -0.8), (0.9, 0, 0), (0.3, 0, 0.8)], [(0, 1), (1, 2)], [])
    mesh.update()
    mesh.materials.append(s.paint())
    modifier(s.put("screw", mesh, turn=(0.3, 0, 0)), "SCREW", steps=3, render_steps=32, use_smooth_shade=True)


def ocean_resolution(s):
    """Ocean: resolution 2 on screen, 12 in render"""
    obj = s.put("ocean", s.cube("ocean"), turn=(0.9, 0, 0))
    modifier(obj, "OCEAN", viewport_resolution=2, resolution=12, spatial_size=8, size=0.2, wave_scale=0.6)


def multires_instanced(s):
    """Multires: 0 on screen, 2 in render, in an instanced collection"""
    group = s.group("group")
    obj = s.put("cube", s.cube())
    multires = modifier(obj, "MULTIRES")
    bpy.context.view_layer.objects.active = obj
    for _ in range(2):
        bpy.ops.object.multires_subdivide(modifier=multires.name, mode="CATMULL_CLARK")
    multires.levels, multires.render_levels = 0, 2
    s.scene.collection.objects.unlink(obj)
    group.objects.link(obj)
    obj.location = (0, 0, 0)
    s.instance("instance", group)


def is_viewport_switch(s):
    """Geometry nodes: Is Viewport switches a cube (screen) for a sphere (render)"""
    nodes, _, out = geometry_group(s.named("nodes"))
    test, switch = nodes.new("GeometryNodeIsViewport"), nodes.new("GeometryNodeSwitch", input_type="GEOMETRY")
    cube, ball = nodes.new("GeometryNodeMeshCube"), nodes.new("GeometryNodeMeshIcoSphere")
    ball.inputs["Subdivisions"].default_value = 3
    choices = [socket for socket in switch.inputs if socket.type == "GEOMETRY"]
    nodes.tree.links.new(test.outputs[0], switch.inputs[1])
    nodes.tree.links.new(ball.outputs[0], choices[0])
    nodes.tree.links.new(cube.outputs[0], choices[1])
    nodes.tree.links.new([o for o in switch.outputs if o.type == "GEOMETRY"][0], out.inputs[0])
    modifier(s.put("host", s.cube("host")), "NODES", node_group=nodes.tree)


def subsurf_zero_render(s):
    """Subsurf: 3 on screen, 0 in render, in the scene"""
    subsurf(s.put("cube", s.cube()), 3, 0)


# Particles and instancers.


def hair_objects(s, part_mesh, count, show_emitter=False, **settings):
    """Hair particles on an upright plane that show an object from outside the scene."""
    host = s.put("host", s.plane("host", width=1.8, height=1.8), turn=(0, 0, 0))
    modifier(host, "PARTICLE_SYSTEM")
    system = host.particle_systems[0].settings
    system.name = s.named("system")
    system.type, system.count, system.render_type, system.hair_length = "HAIR", count, "OBJECT", 0.15
    part = bpy.data.objects.new(s.named("part"), part_mesh)
    part.use_fake_user = True  # particle systems do not keep what they show
    system.instance_object, system.particle_size = part, 1.0
    host.show_instancer_for_render = show_emitter
    for key, value in settings.items():
        setattr(system, key, value)
    return host, system


def display_percentage(s):
    """Particles: 10 % shown on screen, all in render"""
    hair_objects(s, s.cube("part", 1.2), 30, display_percentage=10)


def rendered_children(s):
    """Particle children: 0 on screen, 12 in render"""
    hair_objects(s, s.cube("part", 1.0), 4, child_type="SIMPLE", child_nbr=0, rendered_child_count=12, child_radius=0.5)


def emitter_particles(s):
    """Emitted particles (at rest), 10 % on screen"""
    host, system = hair_objects(s, s.cube("part", 1.2), 30)
    system.type, system.physics_type = "EMITTER", "NO"
    system.frame_start, system.frame_end, system.lifetime, system.display_percentage = -5, -5, 100, 10
    del host


def emitter_hidden(s):
    """Emitter not shown in render (shown on screen)"""
    hair_objects(s, s.cube("part", 1.0), 5)


def emitter_shown(s):
    """Emitter shown in render (not on screen)"""
    host, _ = hair_objects(s, s.cube("part", 1.0), 5, show_emitter=True)
    host.show_instancer_for_viewport = False


def face_instancer_hidden(s):
    """Instances on faces: host not shown in render"""
    face_instancer(s, render=False, screen=True)


def face_instancer_shown(s):
    """Instances on faces: host shown in render, not on screen"""
    face_instancer(s, render=True, screen=False)


def face_instancer(s, render, screen):
    host = s.put("host", s.plane("host", width=1.6, height=1.6, cuts=2), turn=(0, 0, 0))
    host.instance_type = "FACES"
    host.show_instancer_for_render, host.show_instancer_for_viewport = render, screen
    child = s.put("child", s.sphere("child", 0.2))
    child.parent, child.location = host, (0, 0, 0)


# Visibility.


def camera_invisible(s):
    """visible_camera off (beside a shown cube)"""
    s.put("shown", s.cube("shown", 0.8), (-0.6, 0, 0))
    s.put("invisible", s.cube("invisible", 0.8), (0.6, 0, 0)).visible_camera = False


def camera_invisible_instanced(s):
    """visible_camera off in an instanced collection"""
    group = s.group("group")
    s.put("shown", s.cube("shown", 0.8), (-0.6, 0, 0), into=group)
    s.put("invisible", s.cube("invisible", 0.8), (0.6, 0, 0), into=group).visible_camera = False
    s.instance("instance", group)


def camera_invisible_instancer(s):
    """visible_camera off on an instancing empty"""
    group = s.group("group")
    s.put("cube", s.cube(), into=group)
    s.instance("instance", group).visible_camera = False


def holdout_object(s):
    """Holdout object before a plane"""
    s.put("back", s.plane("back"), (0, 1.5, 0), (0, 0, 0))
    s.put("mask", s.cube("mask", 1.0)).is_holdout = True


def holdout_collection(s):
    """Holdout collection before a plane"""
    s.put("back", s.plane("back"), (0, 1.5, 0), (0, 0, 0))
    collection, layer = s.shown_group("masks")
    obj = s.put("mask", s.cube("mask", 1.0), into=collection)
    obj.location = s.origin
    layer.holdout = True


def holdout_material(s):
    """Holdout shader before a plane"""
    material, nodes, out = node_material(s.named("holdout"))
    nodes.link(nodes.new("ShaderNodeHoldout"), 0, out, 0)
    s.put("back", s.plane("back"), (0, 1.5, 0), (0, 0, 0))
    s.put("mask", s.cube("mask", 1.0, [material]))


def indirect_only(s):
    """Indirect-only collection beside a shown cube"""
    s.put("shown", s.cube("shown", 0.8), (-0.6, 0, 0))
    collection, layer = s.shown_group("indirect")
    obj = s.put("indirect", s.cube("indirect", 0.8), into=collection)
    obj.location = s.origin
    obj.location.x += 0.6
    layer.indirect_only = True


def excluded_collection(s):
    """Excluded layer collection beside a shown cube"""
    s.put("shown", s.cube("shown", 0.8), (-0.6, 0, 0))
    collection, layer = s.shown_group("excluded")
    obj = s.put("excluded", s.cube("excluded", 0.8), into=collection)
    obj.location = s.origin
    obj.location.x += 0.6
    layer.exclude = True


def eye_closed_collection(s):
    """Layer collection with its eye closed (hidden on screen only) must be drawn"""
    s.put("shown", s.cube("shown", 0.8), (-0.6, 0, 0))
    collection, layer = s.shown_group("eye")
    obj = s.put("eye", s.cube("eye", 0.8), into=collection)
    obj.location = s.origin
    obj.location.x += 0.6
    layer.hide_viewport = True


def eye_closed_object(s):
    """Object with its eye closed (hidden on screen only) must be drawn"""
    s.put("eye", s.cube("eye")).hide_set(True)


def child_of_hidden(s):
    """Child of an object hidden in render must be drawn"""
    parent = s.put("parent", s.cube("parent", 0.8), (-0.6, 0, 0))
    parent.hide_render = True
    child = s.put("child", s.cube("child", 0.8))
    child.parent, child.location = parent, (1.2, 0, 0)


def shadow_catcher(s):
    """Shadow catcher before a plane (Cycles shows what is behind)"""
    s.put("back", s.plane("back"), (0, 1.5, 0), (0, 0, 0))
    s.put("catcher", s.cube("catcher", 1.0)).is_shadow_catcher = True


def wire_display(s):
    """Object displayed as bounds on screen is drawn whole"""
    s.put("cube", s.cube()).display_type = "BOUNDS"


SETTINGS = [
    subsurf_instanced, subsurf_middle_instanced, array_viewport_off, array_render_off, hide_render_instanced,
    hide_viewport_instanced, hidden_child_collection, screen_hidden_child_collection, nested_instances,
    hidden_instancer, screen_hidden_instancer, linked_collection, overridden_object, collection_info,
    vertex_instances, particle_object_outside, curve_resolution, curve_resolution_zero, curve_instanced,
    surface_resolution, text_resolution, metaball_resolution, screw_steps, ocean_resolution, multires_instanced,
    is_viewport_switch, subsurf_zero_render, display_percentage, rendered_children, emitter_particles, emitter_hidden,
    emitter_shown, face_instancer_hidden, face_instancer_shown, camera_invisible, camera_invisible_instanced,
    camera_invisible_instancer, holdout_object, holdout_collection, holdout_material, indirect_only,
    excluded_collection, eye_closed_collection, eye_closed_object, child_of_hidden, shadow_catcher, wire_display,
]


# Simplify: sheets of their own, for it rules the whole scene.


def simplified_last(s):
    """Simplify: Subsurf as last modifier"""
    subsurf(s.put("cube", s.cube()), 3, 3)


def simplified_middle(s):
    """Simplify: Subsurf before an array"""
    obj = s.put("cube", s.cube(size=1.0), (-0.4, 0, 0))
    subsurf(obj, 3, 3)
    modifier(obj, "ARRAY", count=2, relative_offset_displace=(0.8, 0, 0))


def simplified_instanced(s):
    """Simplify: Subsurf in an instanced collection"""
    group = s.group("group")
    subsurf(s.put("cube", s.cube(), into=group), 3, 3)
    s.instance("instance", group)


def simplified_children(s):
    """Simplify: children of particles"""
    hair_objects(s, s.cube("part", 1.0), 4, child_type="SIMPLE", child_nbr=12, rendered_child_count=12,
                 child_radius=0.5)


SIMPLIFY = [simplified_last, simplified_middle, simplified_instanced, simplified_children]


def simplify(name, prefix, render, screen):
    sheet = sheet_of(name, prefix, SIMPLIFY, columns=4)
    settings = sheet.scene.render
    settings.use_simplify = True
    settings.simplify_subdivision_render, settings.simplify_subdivision = render, screen
    settings.simplify_child_particles_render = 0.0 if render == 0 else 1.0
    settings.simplify_child_particles = 0.0 if screen == 0 else 1.0
    sheet.save()


def metaball_group(s):
    """Metaball family in an instanced collection"""
    group = s.group("group")
    metaball(s, "ball", into=group)
    s.instance("instance", group)


if __name__ == "__main__":
    sheet_of("settings", "R", SETTINGS, columns=8).save()
    sheet_of("settings_linked", "RL", [linked_object], tile=160).save()
    sheet_of("settings_metaball", "RM", [metaball_group], tile=160).save()
    simplify("simplify_render", "SR", render=0, screen=6)
    simplify("simplify_screen", "SS", render=6, screen=0)
