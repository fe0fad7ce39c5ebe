"""Things that change with the frame. All sheets are exported with --frames.

blender -b --factory-startup --python-exit-code 1 -P make_animation.py
"""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stationlib import *  # noqa: F401,F403 - a small language for these files

FRAMES = (1, 2, 3)
LEFT, RIGHT = (-0.6, 0, 0), (0.6, 0, 0)
BENT = (0.6, 0, 0)


def stretch(s, obj):
    """Three frames of a shape key that grows."""
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Wide")
    for point in key.data:
        point.co.x *= 2
    keys(key, "value", {min(s.sheet.record["frames"]): 0.0, max(s.sheet.record["frames"]): 1.0})
    return obj


# What is hidden at some frames.


def appears(s):
    """hide_render keyed from true to false at frame 2"""
    keys(s.put("cube", s.cube()), "hide_render", {1: True, 2: False})


def disappears(s):
    """hide_render keyed from false to true at frame 2"""
    keys(s.put("cube", s.cube()), "hide_render", {1: False, 2: True})


def instancer_appears(s):
    """hide_render keyed on an instancing empty"""
    group = s.group("group")
    s.put("cube", s.cube(), into=group)
    keys(s.instance("instance", group), "hide_render", {1: True, 2: False})


def instanced_appears(s):
    """hide_render keyed on an object in an instanced collection"""
    group = s.group("group")
    s.put("cube", s.cube(size=0.7), LEFT, into=group)
    keys(s.put("comes", s.cube("comes", 0.7), RIGHT, into=group), "hide_render", {1: True, 2: False})
    s.instance("instance", group)


def screen_keyed(s):
    """hide_viewport keyed: must not matter"""
    keys(s.put("cube", s.cube()), "hide_viewport", {1: True, 2: False, 3: True})


def driven_hiding(s):
    """hide_render driven by the frame"""
    obj = s.put("cube", s.cube())
    driver = obj.driver_add("hide_render").driver
    driver.expression = "frame < 2"


def scaled_to_nothing(s):
    """Scale keyed from 0 (hidden the old way)"""
    keys(s.put("cube", s.cube()), "scale", {1: (0, 0, 0), 2: (1, 1, 1)})


# Modifiers that are keyed.


def modifier_render_keyed(s):
    """show_render of an array keyed from off to on"""
    array = modifier(s.put("cube", s.cube(size=0.6), LEFT), "ARRAY", count=3)
    keys(array, "show_render", {1: False, 2: True})


def modifier_screen_keyed(s):
    """show_viewport of an array keyed: must not matter"""
    array = modifier(s.put("cube", s.cube(size=0.6), LEFT), "ARRAY", count=3)
    keys(array, "show_viewport", {1: False, 2: True, 3: False})


def subsurf_keyed(s):
    """render_levels of a Subsurf keyed from 0 to 3"""
    keys(subsurf(s.put("cube", s.cube()), 0, 0), "render_levels", {1: 0, 2: 3})


def subsurf_shown_keyed(s):
    """show_render of the last Subsurf keyed from off to on"""
    keys(subsurf(s.put("cube", s.cube()), 0, 3), "show_render", {1: False, 2: True})


def array_count_keyed(s):
    """count of an array keyed (the control)"""
    keys(modifier(s.put("cube", s.cube(size=0.6), LEFT), "ARRAY"), "count", {1: 1, 2: 2, 3: 3})


# Parents that deform.


def armature(s, text="rig", bend=True):
    """Two bones upright; the upper one turns."""
    data = bpy.data.armatures.new(s.named(text))
    rig = s.put(text, data, (0, 0, -0.7), (0, 0, 0))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    lower, upper = data.edit_bones.new("lower"), data.edit_bones.new("upper")
    lower.head, lower.tail = (0, 0, 0), (0, 0, 0.7)
    upper.head, upper.tail = (0, 0, 0.7), (0, 0, 1.4)
    upper.parent = lower
    bpy.ops.object.mode_set(mode="OBJECT")
    if bend:
        bone = rig.pose.bones["upper"]
        bone.rotation_mode = "XYZ"
        keys(bone, "rotation_euler", {1: (0, 0, 0), 3: (0, 0, 0.9)})
    return rig


def tower(s, text="tower", width=0.4, **settings):
    """An upright strip with cuts, and vertex groups for both bones."""
    return s.plane(text, width=width, height=1.4, cuts=8, **settings)


def grouped(obj):
    lower, upper = obj.vertex_groups.new(name="lower"), obj.vertex_groups.new(name="upper")
    for vertex in obj.data.vertices:
        (upper if vertex.co.z > 0 else lower).add([vertex.index], 1.0, "REPLACE")
    return obj


def armature_parent(s):
    """Armature as parent that deforms (parent_type ARMATURE)"""
    rig, obj = armature(s), grouped(s.put("strip", tower(s), turn=(0, 0, 0)))
    obj.parent, obj.parent_type, obj.location = rig, "ARMATURE", (0, 0, 0.7)


def armature_parent_shared(s):
    """Armature as parent of one of two objects with the same mesh"""
    rig, mesh = armature(s), tower(s)
    s.put("straight", mesh, (-0.9, 0, 0), (0, 0, 0))
    obj = grouped(s.put("strip", mesh, turn=(0, 0, 0)))
    obj.parent, obj.parent_type, obj.location = rig, "ARMATURE", (0, 0, 0.7)


def lattice_parent(s):
    """Lattice as parent that deforms (parent_type LATTICE)"""
    data = bpy.data.lattices.new(s.named("lattice"))
    lattice = s.put("lattice", data, turn=(0, 0, 0))
    lattice.scale = (2, 2, 2)
    stretch(s, lattice)
    obj = s.put("cube", s.cube(size=0.8))
    obj.parent, obj.parent_type, obj.location = lattice, "LATTICE", (0, 0, 0)
    obj.scale = (0.5, 0.5, 0.5)


def bone_parent(s):
    """Bone as parent (the control)"""
    rig, obj = armature(s), s.put("cube", s.cube(size=0.5), (0, 0, 0))
    obj.parent, obj.parent_type, obj.parent_bone = rig, "BONE", "upper"
    obj.location = (0, 0, 0)


def vertex_parent(s):
    """Vertex of a mesh that deforms as parent"""
    host = stretch(s, s.put("host", s.cube("host", 0.6), turn=(0, 0, 0)))
    obj = s.put("cube", s.cube(size=0.4))
    obj.parent, obj.parent_type, obj.parent_vertices = host, "VERTEX", (7, 0, 0)
    obj.location = (0, 0, 0.3)


def curve_parent(s):
    """Curve as parent, with path animation"""
    curve = bpy.data.curves.new(s.named("path"), "CURVE")
    curve.dimensions, curve.use_path, curve.path_duration = "3D", True, 3
    spline = curve.splines.new("POLY")
    spline.points.add(1)
    spline.points[0].co, spline.points[1].co = (-0.8, 0, 0, 1), (0.8, 0, 0.5, 1)
    path = s.put("path", curve, turn=(0, 0, 0))
    keys(curve, "eval_time", {1: 0.0, 3: 3.0})
    obj = s.put("cube", s.cube(size=0.5))
    constraint = obj.constraints.new("FOLLOW_PATH")
    constraint.target = path
    obj.location = (0, 0, 0)


def armature_modifier(s):
    """Armature by a modifier (the control)"""
    obj = grouped(s.put("strip", tower(s), turn=(0, 0, 0)))
    modifier(obj, "ARMATURE", object=armature(s))


# Objects that depend on others.


def metaball(s, text, at):
    """One ball of a family: Blender tells families by what is before the last dot."""
    data = bpy.data.metaballs.new(s.named(text))
    data.resolution = data.render_resolution = 0.12
    data.elements.new().radius = 0.9
    data.materials.append(s.paint(text))
    return s.put(text, data, at, (0, 0, 0))


def metaball_family(s):
    """Metaball family: the second ball moves"""
    metaball(s, "ball", LEFT)
    child = metaball(s, "ball.001", (0.2, 0, 0))
    x, _, z = child.location
    keys(child, "location", {1: (x, 0, z), 3: (x + 0.6, 0, z + 0.5)})


def polyline(s, text="curve", **settings):
    curve = bpy.data.curves.new(s.named(text), "CURVE")
    curve.dimensions = "3D"
    spline = curve.splines.new("POLY")
    spline.points.add(2)
    for point, (x, z) in zip(spline.points, ((-0.8, -0.5), (0, 0.5), (0.8, -0.5))):
        point.co = (x, 0, z, 1)
    for key, value in settings.items():
        setattr(curve, key, value)
    curve.materials.append(s.paint(text))
    return curve


def profile(s, radius=0.1):
    bpy.ops.curve.primitive_bezier_circle_add(radius=radius, location=s.origin)
    circle = bpy.context.object
    circle.name = s.named("profile")
    circle.location.y = 5
    return circle


def bevel_object(s):
    """Bevel object of a curve grows"""
    circle = profile(s)
    s.put("curve", polyline(s, bevel_mode="OBJECT", bevel_object=circle), turn=(0, 0, 0))
    keys(circle, "scale", {1: (1, 1, 1), 3: (3, 3, 3)})
    s.extra["named_by"] = "bevel obj"


def bevel_object_shape(s):
    """Points of a bevel object move (shape key)"""
    circle = profile(s)
    circle.shape_key_add(name="Basis")
    key = circle.shape_key_add(name="Big")
    for point in key.data:
        point.co, point.handle_left, point.handle_right = (3 * v for v in (
            point.co, point.handle_left, point.handle_right))
    keys(key, "value", {1: 0.0, 3: 1.0})
    s.extra["named_by"] = "bevel obj"
    s.put("curve", polyline(s, bevel_mode="OBJECT", bevel_object=circle), turn=(0, 0, 0))


def taper_object(s):
    """Taper object of a curve moves its points"""
    taper = bpy.data.curves.new(s.named("taper"), "CURVE")
    taper.dimensions = "3D"
    spline = taper.splines.new("POLY")
    spline.points.add(1)
    spline.points[0].co, spline.points[1].co = (0, 0.5, 0, 1), (1, 0.5, 0, 1)
    obj = s.put("taper", taper, turn=(0, 0, 0))
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="High")
    for point in key.data:
        point.co.y = 2.0
    keys(key, "value", {1: 0.0, 3: 1.0})
    s.extra["named_by"] = "taper obj"
    s.put("curve", polyline(s, bevel_depth=0.15, taper_object=obj), turn=(0, 0, 0))


def curve_depth(s):
    """Bevel depth of a curve keyed (the control)"""
    curve = polyline(s, bevel_depth=0.05)
    s.put("curve", curve, turn=(0, 0, 0))
    keys(curve, "bevel_depth", {1: 0.05, 3: 0.3})


def text_size(s):
    """Size of a text keyed"""
    text = bpy.data.curves.new(s.named("text"), "FONT")
    text.body, text.align_x, text.align_y, text.size = "X", "CENTER", "CENTER", 1.0
    text.materials.append(s.paint())
    s.put("text", text, turn=(1.5707963, 0, 0))
    keys(text, "size", {1: 1.0, 3: 2.5})


def text_on_curve(s):
    """Text on a curve that is moved by a shape key"""
    curve = polyline(s)
    for point in curve.splines[0].points:
        point.co = (point.co.x, point.co.z, 0, 1)
    path = s.put("curve", curve, turn=(1.5707963, 0, 0))
    path.shape_key_add(name="Basis")
    key = path.shape_key_add(name="Flat")
    for point in key.data:
        point.co.y = 0
    keys(key, "value", {1: 0.0, 3: 1.0})
    text = bpy.data.curves.new(s.named("text"), "FONT")
    text.body, text.size, text.follow_curve = "LIMN", 0.7, path
    text.materials.append(s.paint("text"))
    s.put("text", text, turn=(1.5707963, 0, 0))
    s.extra["named_by"] = "text on"


def node_input(s):
    """Geometry nodes follow another object that moves"""
    nodes, _, out = geometry_group(s.named("nodes"))
    info, cube = nodes.new("GeometryNodeObjectInfo"), nodes.new("GeometryNodeMeshCube")
    guide = s.put("guide", None, turn=(0, 0, 0))
    x, _, z = guide.location
    keys(guide, "location", {1: (x, 0, z), 3: (x + 0.8, 0, z)})
    info.transform_space, info.inputs[0].default_value = "RELATIVE", guide
    cube.inputs["Size"].default_value = (0.5, 0.5, 0.5)
    move = nodes.new("GeometryNodeTransform")
    nodes.link(cube, 0, move, 0)
    nodes.link(info, "Location", move, "Translation")
    nodes.link(move, 0, out, 0)
    modifier(s.put("host", s.cube("host"), turn=(0, 0, 0)), "NODES", node_group=nodes.tree)


def node_instances_grow(s):
    """Count of geometry-node instances keyed"""
    nodes, _, out = geometry_group(s.named("nodes"))
    line, cube = nodes.new("GeometryNodeMeshLine"), nodes.new("GeometryNodeMeshCube")
    on_points = nodes.new("GeometryNodeInstanceOnPoints")
    cube.inputs["Size"].default_value = (0.4, 0.4, 0.4)
    line.inputs["Start Location"].default_value, line.inputs["Offset"].default_value = LEFT, (0.6, 0, 0)
    count = nodes.new("FunctionNodeInputInt")
    time = nodes.new("GeometryNodeInputSceneTime")
    nodes.link(time, "Frame", line, "Count")
    nodes.link(line, 0, on_points, "Points")
    nodes.link(cube, 0, on_points, "Instance")
    nodes.link(on_points, 0, out, 0)
    nodes.tree.nodes.remove(count)
    modifier(s.put("host", s.cube("host"), turn=(0, 0, 0)), "NODES", node_group=nodes.tree)


# Materials that are keyed.


def color_keyed(s):
    """Base Color keyed"""
    paint = s.paint()
    keys(paint.node_tree.nodes["Principled BSDF"].inputs["Base Color"], "default_value",
         {1: (0.8, 0.1, 0.1, 1), 3: (0.1, 0.1, 0.8, 1)})
    s.put("cube", s.cube(materials=[paint]))


def emission_keyed(s):
    """Strength of an Emission keyed"""
    material, nodes, out = node_material(s.named("paint"))
    shader = nodes.new("ShaderNodeEmission")
    shader.inputs[0].default_value = (*s.color, 1)
    nodes.link(shader, 0, out, 0)
    keys(shader.inputs["Strength"], "default_value", {1: 0.1, 3: 1.0})
    s.put("cube", s.cube(materials=[material]))


def rgb_keyed(s):
    """RGB node keyed"""
    material, nodes, out = node_material(s.named("paint"))
    shader, rgb = nodes.new("ShaderNodeBsdfPrincipled"), nodes.new("ShaderNodeRGB")
    nodes.link(rgb, 0, shader, "Base Color")
    nodes.link(shader, 0, out, 0)
    keys(rgb.outputs[0], "default_value", {1: (0.8, 0.1, 0.1, 1), 3: (0.1, 0.1, 0.8, 1)})
    s.put("cube", s.cube(materials=[material]))


def viewport_color_keyed(s):
    """Viewport colour of a material without nodes keyed"""
    material = bpy.data.materials.new(s.named("paint"))
    keys(material, "diffuse_color", {1: (0.8, 0.1, 0.1, 1), 3: (0.1, 0.1, 0.8, 1)})
    s.put("cube", s.cube(materials=[material]))


def mapping_keyed(s):
    """Location of a Mapping keyed"""
    material, nodes, out = node_material(s.named("paint"))
    shader, image, mapping, source = (nodes.new(k) for k in (
        "ShaderNodeBsdfPrincipled", "ShaderNodeTexImage", "ShaderNodeMapping", "ShaderNodeTexCoord"))
    image.image = blocks_image(s.named("image"))
    nodes.link(source, "UV", mapping, 0)
    nodes.link(mapping, 0, image, 0)
    nodes.link(image, 0, shader, "Base Color")
    nodes.link(shader, 0, out, 0)
    keys(mapping.inputs["Location"], "default_value", {1: (0, 0, 0), 3: (0.5, 0.25, 0)})
    s.put("plane", s.plane(materials=[material]), turn=(0, 0, 0))


def image_sequence(s):
    """Image sequence as texture"""
    folder = os.path.join(BLENDS, "sequence")
    os.makedirs(folder, exist_ok=True)
    for frame in FRAMES:
        image = blocks_image("sequence", seed=frame, save_to=os.path.join(folder, "blocks_%04d.png" % frame))
        bpy.data.images.remove(image)
    image = bpy.data.images.load(os.path.join(folder, "blocks_0001.png"))
    image.source = "SEQUENCE"
    material, nodes, out = node_material(s.named("paint"))
    shader, texture = nodes.new("ShaderNodeBsdfPrincipled"), nodes.new("ShaderNodeTexImage")
    texture.image = image
    texture.image_user.frame_duration, texture.image_user.frame_start = 3, 1
    texture.image_user.use_auto_refresh = True
    nodes.link(texture, 0, shader, "Base Color")
    nodes.link(shader, 0, out, 0)
    s.put("plane", s.plane(materials=[material]), turn=(0, 0, 0))


# Particles and motion.


def emitted_particles(s):
    """Particles born from frame to frame (at rest)"""
    host = s.put("host", s.plane("host", width=1.8, height=1.8), turn=(0, 0, 0))
    modifier(host, "PARTICLE_SYSTEM")
    system = host.particle_systems[0].settings
    system.count, system.frame_start, system.frame_end, system.lifetime = 9, 1, 4, 100
    system.physics_type, system.render_type, system.particle_size = "NO", "OBJECT", 0.3
    part = bpy.data.objects.new(s.named("part"), s.cube("part", 1.0))
    part.use_fake_user = True
    system.instance_object, host.show_instancer_for_render = part, False


def moving_parent(s):
    """Moving parent, turned and scaled unevenly (shear)"""
    parent = s.put("parent", None, turn=(0, 0, 0))
    parent.scale = (1, 1, 2)
    keys(parent, "rotation_euler", {1: (0, 0, 0), 3: (0, 0.9, 0)})
    obj = s.put("cube", s.cube(size=0.6), turn=(0.3, 0.7, 0.2))
    obj.parent, obj.location = parent, (0, 0, 0)


def instance_moves(s):
    """Object that moves inside an instanced collection"""
    group = s.group("group")
    obj = s.put("cube", s.cube(size=0.5), into=group)
    keys(obj, "location", {1: (-0.8, 0, 0), 3: (0.8, 0, 0.5)})
    s.instance("instance", group)


def instance_deforms(s):
    """Object that deforms inside an instanced collection, instanced twice"""
    group = s.group("group")
    stretch(s, s.put("cube", s.cube(size=0.5), into=group))
    s.instance("instance", group, (0, 0, 0.6))
    s.instance("instance 2", group, (0, 0, -0.6))


def subsurf_deforms(s):
    """Shape key under a Subsurf"""
    subsurf(stretch(s, s.put("cube", s.cube(size=0.7))), 0, 3)


ANIMATION = [
    disappears, instancer_appears, instanced_appears, driven_hiding, scaled_to_nothing,
    modifier_render_keyed, modifier_screen_keyed, subsurf_keyed, subsurf_shown_keyed, array_count_keyed,
    armature_parent, armature_parent_shared, lattice_parent, bone_parent, vertex_parent, curve_parent,
    armature_modifier, metaball_family, bevel_object, bevel_object_shape, taper_object, curve_depth, text_size,
    text_on_curve, node_input, node_instances_grow, color_keyed, emission_keyed, rgb_keyed, viewport_color_keyed,
    mapping_keyed, image_sequence, moving_parent, instance_moves, instance_deforms, subsurf_deforms, appears,
]


# One sheet each: what may make an export that does not open.


def appears_alone(s):
    """hide_render keyed from true to false: the only object"""
    appears(s)


def faces_later(s):
    """Build: no faces at the first frame"""
    modifier(s.put("plane", s.plane(cuts=4), turn=(0, 0, 0)), "BUILD", frame_start=1, frame_duration=3)


def faces_vanish(s):
    """Build backwards: no faces at the last frame"""
    build = modifier(s.put("plane", s.plane(cuts=4), turn=(0, 0, 0)), "BUILD", frame_start=1, frame_duration=2)
    build.use_reverse = True


def nodes_later(s):
    """Geometry nodes: an empty mesh at the first frame, a cube later"""
    nodes, _, out = geometry_group(s.named("nodes"))
    switch, cube = nodes.new("GeometryNodeSwitch", input_type="GEOMETRY"), nodes.new("GeometryNodeMeshCube")
    time, test = nodes.new("GeometryNodeInputSceneTime"), nodes.new("FunctionNodeCompare")
    test.data_type, test.operation = "FLOAT", "GREATER_THAN"
    test.inputs[1].default_value = 1.5
    nodes.link(time, "Frame", test, 0)
    nodes.tree.links.new(test.outputs[0], switch.inputs[1])
    nodes.tree.links.new(cube.outputs[0], [i for i in switch.inputs if i.type == "GEOMETRY"][1])
    nodes.tree.links.new([o for o in switch.outputs if o.type == "GEOMETRY"][0], out.inputs[0])
    modifier(s.put("host", s.cube("host"), turn=(0.5, 0.3, 0.4)), "NODES", node_group=nodes.tree)


def stretches(s):
    """A mesh that deforms"""
    stretch(s, s.put("cube", s.cube(size=0.7)))


def moves(s):
    """A mesh that moves, and does not deform"""
    obj = s.put("cube", s.cube(size=0.7))
    x, y, z = obj.location
    frames = s.sheet.record["frames"]
    keys(obj, "location", {min(frames): (x - 0.6, y, z), max(frames): (x + 0.6, y, z)})


def single(name, prefix, build, frames=FRAMES, **settings):
    return sheet_of(name, prefix, [build], tile=120, frames=frames, **settings)


def stepped():
    for name, prefix, build in (("step_deform", "AS", stretches), ("step_move", "AT", moves)):
        sheet = single(name, prefix, build, (1, 3, 5))
        sheet.scene.frame_step = 2
        sheet.save()
    sheet = single("step_uneven", "AU", stretches, (1, 4))  # the last frame, 5, is not one of those rendered
    sheet.scene.frame_step, sheet.scene.frame_end = 3, 5
    sheet.save()


def numbered():
    single("negative_frames", "AN", stretches, (-2, -1, 0, 1)).save()
    single("negative_still", "AM", moves, (-2, -1, 0, 1)).save()
    single("large_frames", "AL", stretches, (9999, 10000, 10001)).save()
    single("one_frame", "AO", stretches, (5,)).save()


def cameras():
    """Cameras whose numbers are keyed; the stations are what they see."""
    cases = {
        "camera_shift": ("CS", "Camera shift keyed from 0", lambda c: keys(c.data, "shift_x", {1: 0.0, 3: 0.2})),
        "camera_shift_y": ("CY", "Camera shift_y keyed to 0", lambda c: keys(c.data, "shift_y", {1: 0.2, 3: 0.0})),
        "camera_scale": ("CO", "Orthographic scale keyed", lambda c: keys(c.data, "ortho_scale", {1: 3.0, 3: 6.0})),
        "camera_near": ("CN", "clip_start keyed: the cube is cut away", lambda c: keys(
            c.data, "clip_start", {1: 1.0, 3: 50.0})),
        "camera_far": ("CF", "clip_end keyed: the cube is cut away", lambda c: keys(
            c.data, "clip_end", {1: 100.0, 2: 50.0, 3: 40.0})),
        "camera_type": ("CT", "Camera type keyed from orthographic to perspective", camera_type),
        "camera_sensor": ("CW", "Sensor width keyed (perspective)", camera_sensor),
        "camera_lens": ("CL", "Lens keyed (the control)", camera_lens),
    }
    for name, (prefix, title, change) in cases.items():
        def build(s):
            s.put("cube", s.cube())
        build.__doc__ = title
        sheet = single(name, prefix, build)
        change(sheet.camera)
        sheet.save()


def camera_lens(camera):
    camera.data.type, camera.location = "PERSP", (0, -6, 0)
    keys(camera.data, "lens", {1: 35.0, 3: 70.0})


def camera_sensor(camera):
    camera.data.type, camera.location, camera.data.lens = "PERSP", (0, -6, 0), 50
    keys(camera.data, "sensor_width", {1: 36.0, 3: 60.0})


def camera_type(camera):
    camera.location, camera.data.lens = (0, -6, 0), 60
    keys(camera.data, "type", {1: "ORTHO", 2: "PERSP"})


def static_clips():
    """Clip distances that are not keyed, in a still."""
    for name, prefix, title, start, end in (("clip_start", "KS", "clip_start cuts the cube open", 49.9, 200),
                                            ("clip_end", "KE", "clip_end leaves a part of the cube", 0.1, 49.6)):
        def build(s):
            s.put("cube", s.cube())
        build.__doc__ = title
        sheet = sheet_of(name, prefix, [build], tile=120)
        sheet.camera.data.clip_start, sheet.camera.data.clip_end = start, end
        sheet.save()


def markers():
    """Timeline markers that bind cameras: what Blender renders of the animation."""
    def build(s):
        s.put("cube", s.cube(size=0.6))
        s.extra["named_by"] = "marker"
    build.__doc__ = "Cameras bound to timeline markers"
    sheet = single("markers", "MB", build)
    other = sheet.add_camera("other")
    other.data.ortho_scale = 1.5
    for frame, camera in ((1, sheet.camera), (2, other)):
        sheet.scene.timeline_markers.new("shot %d" % frame, frame=frame).camera = camera
    sheet.save(markers=True)


if __name__ == "__main__":
    sheet_of("animation", "A", ANIMATION, columns=8, tile=80, frames=FRAMES).save()
    single("screen_keyed", "AK", screen_keyed).save()
    single("appears_alone", "AA", appears_alone).save()
    single("faces_later", "AF", faces_later).save()
    single("faces_vanish", "AV", faces_vanish).save()
    single("nodes_later", "AG", nodes_later).save()
    stepped()
    numbered()
    cameras()
    static_clips()
    markers()
