"""Exports a Blender scene for limn: scene.toml, control cages as OBJ with subdivision tags, and a render config per
camera.

As a script:   blender -b FILE.blend --python-exit-code 1 -P export.py -- OUT_DIR [--frames] [--dense]
As an add-on:  install this file in Blender's preferences; then File > Export > limn (.toml)

Blender 3.4 to 4.x, Python's standard library alone. Objects are exported as they would be rendered: with render
visibility and the render levels of their modifiers. The last Subdivision Surface of an object is not applied but
written down, so that limn can draw the limit surface of the cage. What has no place in limn is named in one summary at
the end.
"""

import math
import os
import re
import sys

import bpy
from mathutils import Matrix

bl_info = {
    "name": "limn scenes",
    "description": "Export scenes, subdivision cages and cameras for the limn renderer",
    "author": "limn",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "File > Export > limn (.toml)",
    "category": "Import-Export",
}

GEOMETRY = {"MESH", "CURVE", "SURFACE", "META", "FONT"}

# Codes of OpenSubdiv's OBJ tags.
BOUNDARY = {"ALL": 2, "PRESERVE_CORNERS": 1}
UV_BOUNDARY = {
    "NONE": 5,
    "PRESERVE_CORNERS": 1,
    "PRESERVE_CORNERS_AND_JUNCTIONS": 2,
    "PRESERVE_CORNERS_JUNCTIONS_AND_CONCAVE": 3,
    "PRESERVE_BOUNDARIES": 4,
    "SMOOTH_ALL": 0,
}


def number(value):
    """Shortest text of a float that reads back as the same single-precision number."""
    if value == 0:
        return "0"
    text = "%.9g" % value
    for digits in range(1, 9):
        shorter = "%.*g" % (digits, value)
        if float(shorter) == value:
            return shorter
    return text


def vector(values):
    return "[" + ", ".join(number(v) for v in values) + "]"


def quoted(text):
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + re.sub(r"[\x00-\x1f]", " ", escaped) + '"'


def file_name(name, taken):
    """A name that every file system takes, unlike those before."""
    base = re.sub(r"[^A-Za-z0-9._-]+", "_", name).strip("._") or "mesh"
    result, count = base, 2
    while result.lower() in taken:
        result, count = "%s_%d" % (base, count), count + 1
    taken.add(result.lower())
    return result


class LeftOut:
    """What could not be exported, each kind with the names it concerns."""

    def __init__(self):
        self.kinds = {}

    def add(self, kind, name):
        names = self.kinds.setdefault(kind, [])
        if name not in names:
            names.append(name)

    def lines(self):
        for kind, names in self.kinds.items():
            shown = ", ".join(names[:5]) + (", ... (%d in all)" % len(names) if len(names) > 5 else "")
            yield "  %s: %s" % (kind, shown)


class RenderSettings:
    """Makes the dependency graph of a script, which follows viewport settings, show what would be rendered; undone on
    exit.
    """

    def __init__(self, context, keep_cages):
        self.context, self.keep_cages = context, keep_cages
        self.undo = []
        self.cages = {}  # object name -> its Subdivision Surface modifier that is written down instead of applied

    def set(self, owner, attribute, value):
        old = getattr(owner, attribute)
        if old != value:
            self.undo.append((owner, attribute, old))
            setattr(owner, attribute, value)

    def __enter__(self):
        for collection in bpy.data.collections:
            self.set(collection, "hide_viewport", collection.hide_render)
        view_layer = self.context.view_layer
        for obj in self.context.scene.objects:
            self.set(obj, "hide_viewport", obj.hide_render)
            if not obj.hide_render and obj.name in view_layer.objects and obj.hide_get():
                self.undo.append((obj, "hidden", True))
                obj.hide_set(False)
            enabled = [m for m in obj.modifiers if m.show_render]
            for modifier in obj.modifiers:
                self.set(modifier, "show_viewport", modifier.show_render)
                if modifier.type in {"SUBSURF", "MULTIRES"}:
                    self.set(modifier, "levels", modifier.render_levels)
            if (
                self.keep_cages
                and obj.type == "MESH"
                and enabled
                and enabled[-1].type == "SUBSURF"
                and enabled[-1].render_levels > 0
            ):
                self.cages[obj.name] = enabled[-1]
                self.set(enabled[-1], "show_viewport", False)
        view_layer.update()
        return self

    def __exit__(self, *exception):
        for owner, attribute, value in reversed(self.undo):
            if attribute == "hidden":
                owner.hide_set(value)
            else:
                setattr(owner, attribute, value)
        self.context.view_layer.update()
        return False


def edge_creases(mesh):
    if "crease_edge" in mesh.attributes:  # 4.0 on
        return [item.value for item in mesh.attributes["crease_edge"].data]
    if hasattr(mesh, "edges") and len(mesh.edges) and hasattr(mesh.edges[0], "crease"):
        return [edge.crease for edge in mesh.edges]
    return []


def vertex_creases(mesh):
    if "crease_vert" in mesh.attributes:  # 4.0 on
        return [item.value for item in mesh.attributes["crease_vert"].data]
    if getattr(mesh, "vertex_creases", None) and len(mesh.vertex_creases):
        return [item.value for item in mesh.vertex_creases[0].data]
    return []


def corner_normals(mesh):
    """Normals per corner, as Blender shades them."""
    if hasattr(mesh, "corner_normals"):  # 4.1 on
        return [tuple(item.vector) for item in mesh.corner_normals]
    mesh.calc_normals_split()
    return [tuple(loop.normal) for loop in mesh.loops]


def sharpness(crease):
    """Blender's 0...1 as OpenSubdiv's sharpness: 10 times its square; 1 is infinitely sharp."""
    return 10.0 * crease * crease


def encoded(linear):
    """A linear channel as OBJ files have it: display-encoded."""
    linear = min(max(linear, 0.0), 1.0)
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055


def vertex_colors(mesh, name):
    """One linear colour per vertex, and whether the corners of a vertex differed and were averaged; None without
    colours of that name.
    """
    layer = mesh.color_attributes.get(name) if name else mesh.color_attributes.active_color
    if layer is None or len(layer.data) == 0:
        return None, False
    if layer.domain == "POINT":
        return [tuple(item.color)[:3] for item in layer.data], False
    sums, counts, firsts, differ = [(0.0, 0.0, 0.0)] * len(mesh.vertices), [0] * len(mesh.vertices), {}, False
    for loop, item in zip(mesh.loops, layer.data):
        vertex, color = loop.vertex_index, tuple(item.color)[:3]
        differ = differ or firsts.setdefault(vertex, color) != color
        sums[vertex] = tuple(a + b for a, b in zip(sums[vertex], color))
        counts[vertex] += 1
    return [
        tuple(c / max(1, count) for c in total) if count else (1.0, 1.0, 1.0) for total, count in zip(sums, counts)
    ], differ


def same_but_for_rounding(shape, other, largest):
    """Are coordinates equal to two units in the last place of the largest? Objects that Blender turned as it added them
    differ by that much.
    """
    room = 2.0**-22 * largest
    return len(shape) == len(other) and all(abs(a - b) <= room for a, b in zip(shape, other))


def obj_text(mesh, slots, subsurf, colors=None):
    """One mesh in its own coordinates as OBJ. `subsurf`: the modifier to note as tags, or None to write normals
    instead. `colors`: of each vertex.
    """
    lines = ["# limn exporter"]
    for vertex in mesh.vertices:
        values = list(vertex.co) + ([encoded(c) for c in colors[vertex.index]] if colors else [])
        lines.append("v " + " ".join(number(value) for value in values))
    uv_index, uv_lines = [], []
    layer = mesh.uv_layers.active
    if layer:
        known = {}
        uv_index = [0] * len(mesh.loops)
        for polygon in mesh.polygons:
            uvs = [layer.data[corner].uv for corner in polygon.loop_indices]
            winding = sum((a[0] - b[0]) * (a[1] + b[1]) for a, b in zip(uvs[-1:] + uvs[:-1], uvs)) > 0
            for corner, uv in zip(polygon.loop_indices, uvs):
                # Blender's seams: UVs are one where vertex, place and the direction of the face in the map are the
                # same.
                key = (mesh.loops[corner].vertex_index, uv[0], uv[1], winding)
                if key not in known:
                    known[key] = len(known) + 1
                    uv_lines.append("vt %s %s" % (number(uv[0]), number(uv[1])))
                uv_index[corner] = known[key]
    lines += uv_lines
    normal_index = []
    if subsurf is None:
        known, normal_lines = {}, []
        for normal in corner_normals(mesh):
            key = tuple(number(round(c, 6) + 0.0) for c in normal)
            if key not in known:
                known[key] = len(known) + 1
                normal_lines.append("vn %s %s %s" % key)
            normal_index.append(known[key])
        lines += normal_lines
    material = None
    for polygon in mesh.polygons:
        name = slots[polygon.material_index] if polygon.material_index < len(slots) else ""
        if name != material and (name or material):
            lines.append("usemtl " + (name or "none"))
            material = name
        words = []
        for corner in polygon.loop_indices:
            word = str(mesh.loops[corner].vertex_index + 1)
            if uv_index or normal_index:
                word += "/" + (str(uv_index[corner]) if uv_index else "")
            if normal_index:
                word += "/" + str(normal_index[corner])
            words.append(word)
        lines.append("f " + " ".join(words))
    if subsurf is not None:
        lines.append("t interpolateboundary 1/0/0 %d" % BOUNDARY.get(subsurf.boundary_smooth, 1))
        lines.append("t facevaryinginterpolateboundary 1/0/0 %d" % UV_BOUNDARY.get(subsurf.uv_smooth, 4))
        if subsurf.use_creases:
            for edge, crease in zip(mesh.edges, edge_creases(mesh)):
                if crease > 0:
                    lines.append(
                        "t crease 2/1/0 %d %d %s" % (edge.vertices[0], edge.vertices[1], number(sharpness(crease)))
                    )
            for index, crease in enumerate(vertex_creases(mesh)):
                if crease > 0:
                    lines.append("t corner 1/1/0 %d %s" % (index, number(sharpness(crease))))
    return "\n".join(lines) + "\n"


def subdivision_line(subsurf):
    scheme = "bilinear" if subsurf.subdivision_type == "SIMPLE" else "catmull-clark"
    return "subdivision = { scheme = %s, level = %d, limit = %s }" % (
        quoted(scheme),
        subsurf.render_levels,
        "true" if subsurf.use_limit_surface else "false",
    )


def principled(material):
    """The material's Principled shader, or None."""
    if material is not None and material.use_nodes and material.node_tree:
        for node in material.node_tree.nodes:
            if node.type == "BSDF_PRINCIPLED":
                return node
    return None


def linked(socket):
    """The node that feeds a socket, or None."""
    return socket.links[0].from_node if socket is not None and socket.is_linked else None


def color_attribute(material):
    """The name of the mesh's colour attribute that its colour comes from, "" for the active one, or None."""
    node = principled(material)
    source = linked(node.inputs["Base Color"]) if node else None
    if source is None or source.type not in {"VERTEX_COLOR", "ATTRIBUTE"}:
        return None
    return source.layer_name if source.type == "VERTEX_COLOR" else source.attribute_name


def cutout_image(material, left_out):
    """The image whose alpha cuts holes into the material, or None."""
    node = principled(material)
    if node is None:
        return None
    source = linked(node.inputs["Alpha"])
    from_alpha = source is not None and node.inputs["Alpha"].links[0].from_socket.name == "Alpha"
    if from_alpha and source.type == "TEX_IMAGE" and source.image and material.blend_method != "OPAQUE":
        if material.blend_method == "BLEND":
            left_out.add("soft transparency (cut out where alpha is below one half)", material.name)
        return source.image
    if source is not None or node.inputs["Alpha"].default_value < 1:
        left_out.add("transparency (drawn solid)", material.name)
    return None


def base_color(material, left_out):
    """Linear colour and texture file of a material."""
    if color_attribute(material) is not None:
        return (1.0, 1.0, 1.0), None
    if material.use_nodes and material.node_tree:
        for node in material.node_tree.nodes:
            if node.type != "BSDF_PRINCIPLED":
                continue
            socket = node.inputs["Base Color"]
            if not socket.is_linked:
                return tuple(socket.default_value)[:3], None
            source = socket.links[0].from_node
            if source.type == "TEX_IMAGE" and source.image:
                return (1.0, 1.0, 1.0), source.image
            left_out.add("colour from nodes other than an image (the viewport colour is used)", material.name)
            return tuple(material.diffuse_color)[:3], None
        left_out.add("material without a Principled shader (the viewport colour is used)", material.name)
    return tuple(material.diffuse_color)[:3], None


def texture_path(image, folder, taken, left_out):
    """The image as a file beside the scene, relative to it."""
    os.makedirs(os.path.join(folder, "textures"), exist_ok=True)
    source = bpy.path.abspath(image.filepath)
    extension = os.path.splitext(source)[1].lower() or ".png"
    name = file_name(os.path.splitext(os.path.basename(source) or image.name)[0], taken) + extension
    target = os.path.join(folder, "textures", name)
    try:
        if image.packed_file:
            with open(target, "wb") as file:
                file.write(image.packed_file.data)
        elif image.source != "GENERATED" and not image.has_data and not os.path.isfile(source):
            left_out.add("image that cannot be read", image.name)
            return None
        elif image.source == "GENERATED" or not os.path.isfile(source):
            name = os.path.splitext(name)[0] + ".png"
            target = os.path.join(folder, "textures", name)
            # A copy made by Blender would forget what was painted.
            copy = bpy.data.images.new(
                image.name, image.size[0], image.size[1], alpha=True, float_buffer=image.is_float
            )
            copy.colorspace_settings.name = image.colorspace_settings.name
            copy.pixels = image.pixels[:]
            copy.filepath_raw, copy.file_format = target, "PNG"
            try:
                copy.save()
            finally:
                bpy.data.images.remove(copy)
        else:
            with open(source, "rb") as file, open(target, "wb") as out:
                out.write(file.read())
    except (OSError, RuntimeError) as error:
        left_out.add("image that cannot be read", "%s (%s)" % (image.name, error))
        return None
    return "textures/" + name


def camera_numbers(obj, depsgraph, width, height):
    """Position, view direction, up and lens of a camera, as limn describes them."""
    world = obj.matrix_world.copy()  # Blender changes its own with the frame
    position = world.translation
    forward = -(world.to_3x3().col[2]).normalized()
    up = world.to_3x3().col[1].normalized()
    p = obj.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=1.0, scale_y=1.0)
    longer = max(width, height)
    plane = 2.0 / p[0][0]  # width of the picture at unit depth, or in scene units
    pixel = plane / width
    result = {"position": position, "look_at": position + forward, "up": up}
    if obj.data.type == "ORTHO":
        result["orthographic_height"] = pixel * height
        centre = (-p[0][3] / p[0][0], -p[1][3] / p[1][1])
    else:
        result["focal_length"] = 36.0 / plane
        centre = (p[0][2] / p[0][0], p[1][2] / p[1][1])
    shift = [c / (pixel * longer) for c in centre]
    if max(abs(s) for s in shift) > 1e-7:
        result["shift"] = shift
    return result


def keyed(values, frames):
    """A value, or its keys when it moves. `values`: per frame, each a tuple; a single number as a tuple of one."""
    scale = max(1.0, max(abs(c) for value in values for c in value))
    moves = any(abs(a - b) > 1e-6 * scale for value in values for a, b in zip(value, values[0]))
    text = lambda value: number(value[0]) if len(value) == 1 else vector(value)
    if not moves:
        return text(values[0])
    # Frames between two equal neighbours say nothing that linear interpolation does not.
    kept = [
        i for i in range(len(values)) if i in (0, len(values) - 1) or not (values[i - 1] == values[i] == values[i + 1])
    ]
    keys = ", ".join("[%d, %s]" % (frames[i], text(values[i])) for i in kept)
    return '{ keys = [%s], interpolation = "linear" }' % keys


def unwrapped(angles):
    """Euler angles in degrees without jumps of a whole turn."""
    result = [list(angles[0])]
    for value in angles[1:]:
        result.append([v + 360.0 * round((last - v) / 360.0) for v, last in zip(value, result[-1])])
    return [tuple(v) for v in result]


class Exporter:
    def __init__(self, context, folder, animated=False, dense=False):
        self.context, self.folder, self.animated, self.dense = context, folder, animated, dense
        self.left_out = LeftOut()
        self.meshes = {}  # key -> what was written for it
        self.by_look = {}  # (OBJ text without points, colours, subdivision) -> those that look so
        self.taken, self.taken_textures = set(), set()
        self.materials = {}  # Blender name -> lines
        self.plain = set()  # names of those that take no colours of vertices
        self.colored = False  # some mesh has them
        self.counts = {"meshes": 0, "instances": 0, "cameras": 0, "lights": 0}

    def run(self):
        scene = self.context.scene
        os.makedirs(os.path.join(self.folder, "meshes"), exist_ok=True)
        # Blender may skip frames; declared frames are those that it would render.
        frames = (
            list(range(scene.frame_start, scene.frame_end + 1, max(1, scene.frame_step)))
            if self.animated
            else [scene.frame_current]
        )
        if self.animated and scene.frame_step > 1:
            self.left_out.add("frame step (every frame between is interpolated)", str(scene.frame_step))
        start = scene.frame_current
        with RenderSettings(self.context, keep_cages=not self.dense) as render:
            tracks, cameras, lights = {}, {}, {}
            for frame in frames:
                if self.animated:
                    scene.frame_set(frame)
                depsgraph = self.context.evaluated_depsgraph_get()
                self.look(depsgraph, render.cages, frame, frames, tracks, cameras, lights)
            if self.animated:
                scene.frame_set(start)
            self.write(scene, frames, tracks, cameras, lights)
        return self.left_out

    # What stands in the scene at a frame.
    def look(self, depsgraph, cages, frame, frames, tracks, cameras, lights):
        width, height = self.picture_size()
        seen = {}
        for instance in depsgraph.object_instances:
            obj = instance.object
            original = obj.original
            if not instance.show_self or (original.hide_render and not instance.is_instance):
                continue
            if obj.type in GEOMETRY:
                name = (
                    original.name
                    if not instance.is_instance
                    else "%s/%s" % (instance.parent.original.name, original.name)
                )
                seen[name] = seen.get(name, 0) + 1
                key = name if seen[name] == 1 else "%s.%d" % (name, seen[name])
                mesh = self.mesh_of(obj, cages, frame, frames)
                if mesh:
                    tracks.setdefault(key, {"mesh": mesh, "matrices": {}})["matrices"][
                        frame
                    ] = instance.matrix_world.copy()
            elif obj.type == "CAMERA" and not instance.is_instance:
                cameras.setdefault(original.name, {})[frame] = camera_numbers(obj, depsgraph, width, height)
                if frame == frames[0] and obj.data.type == "PANO":
                    self.left_out.add("panoramic camera (taken as perspective)", original.name)
                if frame == frames[0] and obj.data.dof.use_dof:
                    self.left_out.add("depth of field", original.name)
            elif obj.type == "LIGHT":
                if obj.data.type == "AREA":
                    self.left_out.add("area light", original.name)
                    continue
                name = (
                    original.name
                    if not instance.is_instance
                    else "%s/%s" % (instance.parent.original.name, original.name)
                )
                lights.setdefault(name, {})[frame] = self.light_numbers(obj, instance.matrix_world.copy())
            elif obj.type not in {"EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE", "LIGHTPROBE"}:
                self.left_out.add("object of a kind that has no surface", "%s (%s)" % (original.name, obj.type.lower()))

    def picture_size(self):
        render = self.context.scene.render
        return max(1, render.resolution_x * render.resolution_percentage // 100), max(
            1, render.resolution_y * render.resolution_percentage // 100
        )

    @staticmethod
    def light_numbers(obj, world):
        light = obj.data
        numbers = {"kind": light.type.lower(), "color": tuple(light.color)}
        numbers["position"] = world.translation
        numbers["direction"] = -(world.to_3x3().col[2]).normalized()
        # Irradiance 1 on a white surface shows as 1/pi; limn's lights show it as 1.
        numbers["intensity"] = light.energy / math.pi if light.type == "SUN" else light.energy / (4 * math.pi**2)
        if light.type == "SPOT":
            numbers["angle"], numbers["blend"] = math.degrees(light.spot_size), light.spot_blend
        return numbers

    def deforms(self, obj):
        """May the mesh change its shape over frames? Whether it does is seen when every frame has been written."""
        original = obj.original
        data = original.data
        return (
            bool(original.modifiers)
            or getattr(data, "shape_keys", None) is not None
            or getattr(data, "animation_data", None) is not None
        )

    def mesh_of(self, obj, cages, frame, frames):
        """Writes the object's mesh unless that has been done; returns its name in the scene file, or None without
        faces.
        """
        original = obj.original
        subsurf = cages.get(original.name)
        by_object = any(slot.link == "OBJECT" for slot in original.material_slots)
        key = (
            ("object", original.name)
            if original.modifiers or by_object or original.type != "MESH"
            else ("data", original.data.name)
        )
        moving = self.animated and len(frames) > 1 and self.deforms(obj)
        known = self.meshes.get(key)
        if known and (not moving or frame in known["frames"]):
            return known["name"]
        mesh = obj.to_mesh()
        try:
            if mesh is None or not mesh.polygons:
                if mesh is not None and mesh.vertices:
                    self.left_out.add("mesh without faces", original.name)
                return None
            slots = [self.material(slot.material) for slot in original.material_slots]
            wanted = {color_attribute(slot.material) for slot in original.material_slots} - {None}
            colors, differ = vertex_colors(mesh, sorted(wanted)[0]) if wanted else (None, False)
            if wanted and colors is None:
                self.left_out.add(
                    "colour attribute that is not there or holds no colours (drawn white)",
                    "%s (%s)" % (original.name, sorted(wanted)[0]),
                )
            if len(wanted) > 1:
                self.left_out.add(
                    "more than one colour attribute on a mesh",
                    "%s (%s)" % (original.name, ", ".join(sorted(wanted)[1:])),
                )
            self.colored = self.colored or colors is not None
            if differ:
                self.left_out.add("colours that differ between the faces at a vertex (averaged)", original.name)
            text = obj_text(mesh, slots, subsurf, colors)
            shape = [c for vertex in mesh.vertices for c in vertex.co]
            look = (
                "\n".join(line for line in text.split("\n") if not line.startswith("v ")),
                tuple(colors or ()),
                subdivision_line(subsurf) if subsurf else "",
            )
            if not known and not moving:
                largest = max(map(abs, shape))
                for other in self.by_look.get(look, []):
                    if same_but_for_rounding(shape, other["shape"], largest):
                        self.meshes[key] = other  # the same under another name: once is enough
                        return other["name"]
            if not known:
                name = file_name(original.name if key[0] == "object" else original.data.name, self.taken)
                known = self.meshes[key] = {
                    "name": name,
                    "frames": {},
                    "subsurf": subsurf,
                    "shape": None,
                    "moves": False,
                }
                self.counts["meshes"] += 1
                self.note(original, mesh, subsurf)
            if known["shape"] is None:
                known["shape"] = shape
            elif shape != known["shape"]:
                known["moves"] = True
            digits = "_%04d" % frame if moving else ""
            path = os.path.join(self.folder, "meshes", known["name"] + digits + ".obj")
            with open(path, "w", encoding="utf-8", newline="\n") as file:
                file.write(text)
            if not moving:
                self.by_look.setdefault(look, []).append(known)
            known["frames"][frame] = path
            return known["name"]
        finally:
            obj.to_mesh_clear()

    def note(self, original, mesh, subsurf):
        if original.is_holdout:
            self.left_out.add("holdout", original.name)
        for modifier in original.modifiers:
            if (
                modifier.type == "SUBSURF"
                and modifier.show_render
                and modifier != subsurf
                and modifier.render_levels > 0
            ):
                self.left_out.add("subdivision before other modifiers (written as polygons)", original.name)
        if any(getattr(edge, "use_freestyle_mark", False) for edge in mesh.edges):
            self.left_out.add("Freestyle mark", original.name)
        if original.particle_systems:
            self.left_out.add("hair or particles", original.name)

    def material(self, material):
        if material is None:
            return ""
        if material.name not in self.materials:
            color, image = base_color(material, self.left_out)
            lines = [
                "[[material]]",
                "name = " + quoted(material.name),
                "color = " + vector([max(0.0, c) for c in color]),
            ]
            path = None
            if image:
                path = texture_path(image, self.folder, self.taken_textures, self.left_out)
                if path:
                    lines.append("texture = " + quoted(path))
            holes = cutout_image(material, self.left_out)
            if holes:
                path = (
                    path
                    if image == holes and path
                    else texture_path(holes, self.folder, self.taken_textures, self.left_out)
                )
                if path:
                    lines.append("cutout = " + quoted(path))
            # Blender's own default is a transparent black: whoever wants black lines gives them some opacity.
            if tuple(material.line_color) != (0.0, 0.0, 0.0, 0.0):
                lines.append("line_color = " + vector([max(0.0, c) for c in tuple(material.line_color)[:3]]))
            self.materials[material.name] = lines
            if color_attribute(material) is None:
                self.plain.add(material.name)
        return material.name

    # The files.
    def write(self, scene, frames, tracks, cameras, lights):
        lines = [
            "# Written by limn's Blender exporter from %s."
            % quoted(os.path.basename(bpy.data.filepath) or "an unsaved file"),
            "",
            'up = "z"',
            "",
        ]
        lines += [
            "[units]",
            "meters_per_unit = "
            + number(scene.unit_settings.scale_length if scene.unit_settings.system != "NONE" else 1.0),
            "",
        ]
        if self.animated:
            lines += [
                "[animation]",
                'frames = "%d-%d"' % (frames[0], frames[-1]),
                "fps = " + number(scene.render.fps / scene.render.fps_base),
                "",
            ]
        done = set()
        for known in self.meshes.values():
            if known["name"] not in done:
                lines += self.mesh_entry(known)
            done.add(known["name"])
        for name, material in self.materials.items():
            lines += material + (["vertex_colors = false"] if self.colored and name in self.plain else []) + [""]
        for name, track in tracks.items():
            lines += self.instance_entry(name, track, frames)
        for name, by_frame in cameras.items():
            lines += self.camera_entry(name, by_frame, frames)
        for name, by_frame in lights.items():
            lines += self.light_entry(name, by_frame, frames)
        with open(os.path.join(self.folder, "scene.toml"), "w", encoding="utf-8", newline="\n") as file:
            file.write("\n".join(lines).rstrip() + "\n")
        taken = {"scene"}
        for name in cameras or [""]:
            self.write_config(scene, name, file_name(name or "picture", taken))
        if not tracks:
            self.left_out.add("anything to draw", "the scene has no surfaces")

    def mesh_entry(self, known):
        files = sorted(known["frames"].items())
        first = os.path.basename(files[0][1])
        if len(files) > 1:
            if known["moves"]:
                first = known["name"] + "_####.obj"
            else:
                # Nothing moved after all: one file is enough.
                single = os.path.join(self.folder, "meshes", known["name"] + ".obj")
                os.replace(files[0][1], single)
                for _, path in files[1:]:
                    os.remove(path)
                first = os.path.basename(single)
        lines = ["[[mesh]]", "name = " + quoted(known["name"]), "file = " + quoted("meshes/" + first)]
        if known["subsurf"] is not None:
            lines.append(subdivision_line(known["subsurf"]))
        return lines + [""]

    def instance_entry(self, name, track, frames):
        lines = ["[[instance]]", "name = " + quoted(name), "mesh = " + quoted(track["mesh"])]
        matrices = [track["matrices"].get(frame) for frame in frames]
        if any(matrix is None for matrix in matrices):
            self.left_out.add("object that comes or goes (shown in every frame)", name)
            last = next(matrix for matrix in matrices if matrix is not None)
            for i, matrix in enumerate(matrices):
                matrices[i] = last = matrix if matrix is not None else last
        self.counts["instances"] += 1
        if all(matrix == matrices[0] for matrix in matrices):
            if matrices[0] != Matrix.Identity(4):
                lines.append(
                    "matrix = " + vector([matrices[0][row][column] for row in range(4) for column in range(4)])
                )
            return lines + [""]
        parts = [matrix.decompose() for matrix in matrices]
        for matrix, (place, turn, size) in zip(matrices, parts):
            again = Matrix.LocRotScale(place, turn, size)
            if any(
                abs(again[r][c] - matrix[r][c]) > 1e-4 * max(1.0, abs(matrix[r][c])) for r in range(3) for c in range(4)
            ):
                self.left_out.add("shear of a moving object", name)
                break
        lines.append("translate = " + keyed([tuple(p[0]) for p in parts], frames))
        lines.append(
            "rotate = "
            + keyed(unwrapped([tuple(math.degrees(a) for a in p[1].to_euler("XYZ")) for p in parts]), frames)
        )
        lines.append("scale = " + keyed([tuple(p[2]) for p in parts], frames))
        return lines + [""]

    def camera_entry(self, name, by_frame, frames):
        self.counts["cameras"] += 1
        lines = ["[[camera]]", "name = " + quoted(name)]
        first = by_frame[min(by_frame)]
        at = lambda frame: by_frame.get(frame, first)
        for key in ("position", "look_at", "up", "focal_length", "orthographic_height", "shift"):
            if key in first:
                value = (
                    lambda frame: tuple(at(frame).get(key, first[key]))
                    if hasattr(first[key], "__len__")
                    else (at(frame).get(key, first[key]),)
                )
                lines.append("%s = %s" % (key, keyed([value(frame) for frame in frames], frames)))
        return lines + [""]

    def light_entry(self, name, by_frame, frames):
        self.counts["lights"] += 1
        first = by_frame[min(by_frame)]
        at = lambda frame: by_frame.get(frame, first)
        lines = ["[[light]]", "name = " + quoted(name), "kind = " + quoted(first["kind"])]
        keys = {
            "sun": ("direction", "color", "intensity"),
            "point": ("position", "color", "intensity"),
            "spot": ("position", "direction", "color", "intensity", "angle", "blend"),
        }[first["kind"]]
        for key in keys:
            value = lambda frame: tuple(at(frame)[key]) if hasattr(first[key], "__len__") else (at(frame)[key],)
            lines.append("%s = %s" % (key, keyed([value(frame) for frame in frames], frames)))
        if first["kind"] != "sun":
            lines.append("range = 1")  # falls with the square of the distance, beyond a unit
        return lines + [""]

    def write_config(self, scene, camera, name):
        render = scene.render
        if render.pixel_aspect_x != render.pixel_aspect_y:
            self.left_out.add("pixels that are not square", "%g:%g" % (render.pixel_aspect_x, render.pixel_aspect_y))
        width, height = self.picture_size()
        lines = [
            "# Renders %s. Start from here: every table may be changed or left out."
            % (quoted(camera) if camera else "the scene"),
            "version = 1",
            "",
            'scene = "scene.toml"',
        ]
        if camera:
            lines.append("camera = " + quoted(camera))
        lines += ["", "[image]", "size = [%d, %d]" % (width, height), "samples = 8"]
        if render.film_transparent:
            lines.append('background = "transparent"')
        lines += [
            "",
            "[shading]",
            'technique = "toon"',
            "",
            "[ao]",
            'technique = "toon_ssao"',
            'filter = { technique = "gaussian" }',
            "",
            "[[edges]]",
            'technique = "depth_normal"',
            "",
            "[output]",
            "path = " + quoted("%s%s.png" % (name, "_####" if self.animated else "")),
        ]
        with open(os.path.join(self.folder, name + ".toml"), "w", encoding="utf-8", newline="\n") as file:
            file.write("\n".join(lines) + "\n")


def export(context, folder, animated=False, dense=False):
    exporter = Exporter(context, folder, animated, dense)
    left_out = exporter.run()
    print(
        "limn: wrote %s: %s"
        % (
            os.path.join(folder, "scene.toml"),
            ", ".join("%d %s" % (count, what) for what, count in exporter.counts.items()),
        )
    )
    for line in left_out.lines():
        print("limn: left out:" + line)
    return left_out


class EXPORT_OT_limn(bpy.types.Operator):
    """Write a limn scene, its meshes and a render config per camera"""

    bl_idname = "export_scene.limn"
    bl_label = "Export limn scene"

    directory: bpy.props.StringProperty(subtype="DIR_PATH")
    animated: bpy.props.BoolProperty(
        name="Animation", description="Write every frame, not just the current one", default=False
    )
    dense: bpy.props.BoolProperty(
        name="Apply subdivision", description="Write dense polygons instead of cages", default=False
    )

    def invoke(self, context, event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        left_out = export(context, bpy.path.abspath(self.directory), self.animated, self.dense)
        for line in left_out.lines():
            self.report({"WARNING"}, "limn left out" + line)
        return {"FINISHED"}


def menu(self, context):
    self.layout.operator(EXPORT_OT_limn.bl_idname, text="limn (.toml)")


def register():
    bpy.utils.register_class(EXPORT_OT_limn)
    bpy.types.TOPBAR_MT_file_export.append(menu)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(menu)
    bpy.utils.unregister_class(EXPORT_OT_limn)


def main(arguments):
    flags = {a for a in arguments if a.startswith("--")}
    folders = [a for a in arguments if not a.startswith("--")]
    if len(folders) != 1 or flags - {"--frames", "--dense"}:
        sys.exit("usage: blender -b FILE.blend --python-exit-code 1 -P export.py -- OUT_DIR [--frames] [--dense]")
    export(bpy.context, os.path.abspath(folders[0]), "--frames" in flags, "--dense" in flags)


if __name__ == "__main__":
    if "--" in sys.argv:
        main(sys.argv[sys.argv.index("--") + 1 :])
    else:
        register()
