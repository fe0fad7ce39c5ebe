"""Exports a Blender scene for limn: scene.toml, control cages as OBJ with subdivision tags, and a render config per
camera.

As a script:   blender -b FILE.blend --python-exit-code 1 -P export.py -- OUT_DIR [--frames] [--dense]
As an add-on:  install this file in Blender's preferences; then File > Export > limn (.toml)

Blender 3.4 to 4.x, Python's standard library alone. Objects are exported as they would be rendered: with render
visibility and the render levels of their modifiers. The last Subdivision Surface of an object is not applied but
written down, so that limn can draw the limit surface of the cage. What has no place in limn is named in one summary at
the end.
"""

import hashlib
import math
import os
import re
import sys
from array import array

import bpy
from mathutils import Euler, Matrix, Vector

bl_info = {
    "name": "limn scenes",
    "description": "Export scenes, subdivision cages and cameras for the limn renderer",
    "author": "limn",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "File > Export > limn (.toml)",
    "category": "Import-Export",
}

# What a person adds to an exported scene.
OWN_SCENE = "scene_own.toml"

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
    return '"' + re.sub(r"[\x00-\x1f\x7f]", lambda c: "\\u%04x" % ord(c.group()), escaped) + '"'


def one_word(name):
    """A name as OBJ can say it: without ends, tabs and line breaks that readers drop."""
    return re.sub(r"[\x00-\x1f\x7f\\]+", " ", name).strip() or "unnamed"


def identity(block):
    """What Blender itself tells data blocks apart by: names are unique within a library only."""
    return (block.library.filepath if block.library else "", block.name)


def unique(name, taken):
    """A name unlike those before."""
    result, count = name, 2
    while result in taken:
        result, count = "%s.%d" % (name, count), count + 1
    taken.add(result)
    return result


def frame_digits(frame):
    """A frame's number as limn writes it in the place of ####."""
    return "%s%04d" % ("-" if frame < 0 else "", abs(frame))


def has_keys(block, path):
    """Do keys or drivers set a property of a data block?"""
    animation = getattr(block, "animation_data", None)
    if animation is None:
        return False
    curves = list(animation.drivers) + (list(animation.action.fcurves) if animation.action else [])
    return any(curve.data_path == path for curve in curves) or len(animation.nla_tracks) > 0


def file_name(name, taken):
    """A name that every file system takes, unlike those before."""
    base = re.sub(r"[^\w.-]+", "_", name).strip("._") or "mesh"
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
        self.cages = {}  # object -> its Subdivision Surface modifier that is written down, not applied, and its level
        self.keyed = []  # modifiers that keys show and hide, or subdivide more or less

    def set(self, owner, attribute, value):
        old = getattr(owner, attribute)
        if old != value:
            self.undo.append((owner, attribute, old))
            setattr(owner, attribute, value)

    def __enter__(self):
        scene, view_layer = self.context.scene, self.context.view_layer
        if scene.render.use_simplify:
            self.set(scene.render, "simplify_subdivision", scene.render.simplify_subdivision_render)
            self.set(scene.render, "simplify_child_particles", scene.render.simplify_child_particles_render)
        for collection in bpy.data.collections:
            self.set(collection, "hide_viewport", collection.hide_render)
        self.data_as_rendered()
        # Objects of instanced and linked collections stand in no scene: all are made to look as rendered.
        for obj in bpy.data.objects:
            self.set(obj, "hide_viewport", obj.hide_render and not has_keys(obj, "hide_render"))
            self.set(obj, "show_instancer_for_viewport", obj.show_instancer_for_render)
            self.mute_screen(obj)
            if not obj.hide_render and obj.name in view_layer.objects and view_layer.objects[obj.name] == obj:
                if obj.hide_get():
                    self.undo.append((obj, "hidden", True))
                    obj.hide_set(False)
            self.modifiers_as_rendered(obj)
        view_layer.update()
        return self

    def data_as_rendered(self):
        """Curves, metaballs and particles have resolutions of their own for pictures."""
        for curve in bpy.data.curves:
            for axis in ("u", "v"):
                if getattr(curve, "render_resolution_" + axis) > 0:
                    self.set(curve, "resolution_" + axis, getattr(curve, "render_resolution_" + axis))
        for ball in bpy.data.metaballs:
            self.set(ball, "resolution", ball.render_resolution)
        for particles in bpy.data.particles:
            self.set(particles, "display_percentage", 100)
            self.set(particles, "child_nbr", particles.rendered_child_count)

    def modifiers_as_rendered(self, obj):
        simplify = self.context.scene.render
        enabled = [m for m in obj.modifiers if m.show_render]
        for modifier in obj.modifiers:
            self.set(modifier, "show_viewport", modifier.show_render)
            if any(has_keys(obj, modifier.path_from_id() + "." + path) for path in ("show_render", "render_levels")):
                self.keyed.append(modifier)
            if modifier.type in {"SUBSURF", "MULTIRES"}:
                self.set(modifier, "levels", modifier.render_levels)
            if modifier.type == "SCREW":
                self.set(modifier, "steps", modifier.render_steps)
            if modifier.type == "OCEAN":
                self.set(modifier, "viewport_resolution", modifier.resolution)
        levels = enabled[-1].render_levels if enabled and enabled[-1].type == "SUBSURF" else 0
        if simplify.use_simplify:
            levels = min(levels, simplify.simplify_subdivision_render)
        if self.keep_cages and obj.type == "MESH" and levels > 0 and enabled[-1] not in self.keyed:
            self.cages[identity(obj)] = (enabled[-1], levels)
            self.set(enabled[-1], "show_viewport", False)

    def at_frame(self):
        """Follows keys that show and hide modifiers in pictures."""
        for modifier in self.keyed:
            if modifier.show_viewport != modifier.show_render:
                modifier.show_viewport = modifier.show_render
            if modifier.type in {"SUBSURF", "MULTIRES"}:
                modifier.levels = modifier.render_levels
        if self.keyed:
            self.context.view_layer.update()

    def mute_screen(self, obj):
        """Keys of what the screen shows say nothing about pictures."""
        action = obj.animation_data.action if obj.animation_data else None
        for curve in action.fcurves if action else []:
            if curve.data_path.split(".")[-1] in {"hide_viewport", "show_viewport", "levels"}:
                self.set(curve, "mute", True)

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


def numbers_of(collection, attribute, width):
    """An attribute of all items of a collection, flat: bulk reads are a hundred times faster than loops."""
    values = array("f" if attribute in {"co", "normal", "uv"} else "i", bytes(4 * width * len(collection)))
    collection.foreach_get(attribute, values)
    return values


def rows(word, width, values):
    """Lines of OBJ, a word and `width` numbers each. Few take the shortest numbers. Many take nine digits, which are as
    exact: a format for many lines at once is the fastest way to write them.
    """
    if len(values) < 30000:
        for start in range(0, len(values), width):
            yield "%s %s\n" % (word, " ".join(number(value) for value in values[start : start + width]))
        return
    form, step = word + " %.9g" * width + "\n", 4096 * width
    for start in range(0, len(values), step):
        part = tuple(values[start : start + step])
        yield form * (len(part) // width) % part


def uv_map(mesh):
    """The map that pictures are rendered with, or None."""
    return next((layer for layer in mesh.uv_layers if layer.active_render), mesh.uv_layers.active)


def uv_indices(mesh, layer, corners, starts, totals):
    """Texture coordinates as OBJ lines, and the number of each corner's. UVs are one where vertex, place and the
    direction of the face in the map are the same: Blender's seams.
    """
    flat = numbers_of(layer.data, "uv", 2)
    us, vs = flat[0::2], flat[1::2]
    known, indices, places = {}, array("i", bytes(4 * len(corners))), array("f")
    for start, total in zip(starts, totals):
        winding, last = 0.0, start + total - 1
        for corner in range(start, start + total):
            winding += (us[last] - us[corner]) * (vs[last] + vs[corner])
            last = corner
        for corner in range(start, start + total):
            key = (corners[corner], us[corner], vs[corner], winding > 0)
            index = known.get(key)
            if index is None:
                index = known[key] = len(known) + 1
                places.extend((us[corner], vs[corner]))
            indices[corner] = index
    return rows("vt", 2, places), indices


def normal_indices(mesh, corners):
    """Normals as OBJ lines, and the number of each corner's."""
    smooth = [False] * len(mesh.polygons)
    mesh.polygons.foreach_get("use_smooth", smooth)
    is_split = mesh.has_custom_normals or getattr(mesh, "use_auto_smooth", False)
    if all(smooth) and not is_split:  # one for each vertex
        values = numbers_of(mesh.vertices, "normal", 3)
        return rows("vn", 3, values), array("i", [vertex + 1 for vertex in corners])
    known, indices, lines = {}, array("i", bytes(4 * len(corners))), []
    for corner, normal in enumerate(corner_normals(mesh)):
        key = (round(normal[0], 6), round(normal[1], 6), round(normal[2], 6))
        index = known.get(key)
        if index is None:
            index = known[key] = len(known) + 1
            lines.append("vn %s %s %s\n" % tuple(number(c + 0.0) for c in key))
        indices[corner] = index
    return lines, indices


def obj_text(mesh, slots, subsurf, colors=None):
    """One mesh in its own coordinates as OBJ: its points, and all that follows them. `slots`: names of materials.
    `subsurf`: the modifier to note as tags, or None to write normals instead. `colors`: of each vertex.
    """
    head, parts = ["# limn exporter\n"], []
    points = numbers_of(mesh.vertices, "co", 3)
    if colors:
        for vertex, color in enumerate(colors):
            values = tuple(points[3 * vertex : 3 * vertex + 3]) + tuple(encoded(c) for c in color)
            head.append("v " + " ".join(number(value) for value in values) + "\n")
    else:
        head += rows("v", 3, points)
    corners = numbers_of(mesh.loops, "vertex_index", 1)
    starts, totals = numbers_of(mesh.polygons, "loop_start", 1), numbers_of(mesh.polygons, "loop_total", 1)
    layer, uvs, normals = uv_map(mesh), None, None
    if layer:
        lines, uvs = uv_indices(mesh, layer, corners, starts, totals)
        parts += lines
    if subsurf is None:
        lines, normals = normal_indices(mesh, corners)
        parts += lines
    if uvs and normals:
        words = ["%d/%d/%d" % (v + 1, t, n) for v, t, n in zip(corners, uvs, normals)]
    elif uvs:
        words = ["%d/%d" % (v + 1, t) for v, t in zip(corners, uvs)]
    elif normals:
        words = ["%d//%d" % (v + 1, n) for v, n in zip(corners, normals)]
    else:
        words = ["%d" % (v + 1) for v in corners]
    material = None
    for start, total, index in zip(starts, totals, numbers_of(mesh.polygons, "material_index", 1)):
        name = slots[min(index, len(slots) - 1)]  # Blender takes the last slot for those beyond
        if name != material:
            parts.append("usemtl %s\n" % name)
            material = name
        parts.append("f %s\n" % " ".join(words[start : start + total]))
    if subsurf is not None:
        parts += tags(mesh, subsurf)
    return "".join(head), "".join(parts)


def tags(mesh, subsurf):
    """OpenSubdiv's tags of a cage, as lines of OBJ."""
    lines = [
        "t interpolateboundary 1/0/0 %d\n" % BOUNDARY.get(subsurf.boundary_smooth, 1),
        "t facevaryinginterpolateboundary 1/0/0 %d\n" % UV_BOUNDARY.get(subsurf.uv_smooth, 4),
    ]
    if not subsurf.use_creases:
        return lines
    for edge, crease in zip(mesh.edges, edge_creases(mesh)):
        if crease > 0:
            values = (edge.vertices[0], edge.vertices[1], number(sharpness(crease)))
            lines.append("t crease 2/1/0 %d %d %s\n" % values)
    for index, crease in enumerate(vertex_creases(mesh)):
        if crease > 0:
            lines.append("t corner 1/1/0 %d %s\n" % (index, number(sharpness(crease))))
    return lines


def subdivision_line(subsurf, level):
    scheme = "bilinear" if subsurf.subdivision_type == "SIMPLE" else "catmull-clark"
    return "subdivision = { scheme = %s, level = %d, limit = %s }" % (
        quoted(scheme),
        level,
        "true" if subsurf.use_limit_surface else "false",
    )


def linked(socket):
    """The node and its socket that feed a socket, groups and reroutes looked through; None, None without a link."""
    path = []
    while socket is not None and socket.is_linked:
        link = socket.links[0]
        node, source = link.from_node, link.from_socket
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.type == "GROUP" and node.node_tree:
            output = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None)
            path.append(node)
            socket = output.inputs[source.name] if output else None
        elif node.type == "GROUP_INPUT" and path:
            socket = path.pop().inputs[source.name]
            if not socket.is_linked:
                return socket, socket  # a number in the group's own socket
        else:
            return node, source
    return None, None


class Surface:
    """What a material's nodes come to: a colour, from a socket, a factor on it, and the socket of its alpha."""

    def __init__(self, material):
        self.color = self.alpha = None
        self.factor, self.kind, self.transparent = 1.0, None, False
        self.added = (0.0, 0.0, 0.0)  # light of its own
        tree = material.node_tree if material is not None and material.use_nodes else None
        if tree is None:
            return
        output = tree.get_output_node("ALL")
        self.follow(output.inputs["Surface"] if output else None)

    def follow(self, socket):
        node, _ = linked(socket)
        self.kind = node.type if node is not None and hasattr(node, "inputs") else None
        if self.kind == "BSDF_PRINCIPLED":
            self.color, self.alpha = node.inputs["Base Color"], node.inputs["Alpha"]
            glow = node.inputs.get("Emission") or node.inputs.get("Emission Color")
            strength = node.inputs.get("Emission Strength")
            if glow is not None and strength is not None and not glow.is_linked and not strength.is_linked:
                self.added = tuple(c * strength.default_value for c in tuple(glow.default_value)[:3])
        elif self.kind in {"BSDF_DIFFUSE", "BSDF_TOON", "BSDF_GLOSSY", "BSDF_VELVET"}:
            self.color = node.inputs["Color"]
        elif self.kind == "EMISSION":
            self.color = node.inputs["Color"]
            self.factor = 1.0 if node.inputs["Strength"].is_linked else node.inputs["Strength"].default_value
        elif self.kind == "MIX_SHADER":
            self.mix(node)

    def mix(self, node):
        """A shader mixed with transparency: the factor is its alpha."""
        kinds = [linked(socket)[0] for socket in node.inputs[1:3]]
        clear = [getattr(n, "type", None) == "BSDF_TRANSPARENT" for n in kinds]
        if clear.count(True) == 1:
            self.follow(node.inputs[1 + clear.index(False)])
            # Factor 0 is the first shader, 1 the second.
            self.alpha, self.transparent = node.inputs[0], clear[1]


def color_attribute(material):
    """The name of the mesh's colour attribute that its colour comes from, "" for the active one, or None."""
    source, _ = linked(Surface(material).color)
    if source is None or getattr(source, "type", None) not in {"VERTEX_COLOR", "ATTRIBUTE"}:
        return None
    return source.layer_name if source.type == "VERTEX_COLOR" else source.attribute_name


def cutout_image(material, left_out):
    """The image whose alpha cuts holes into the material, or None."""
    surface = Surface(material)
    if surface.alpha is None:
        return None
    source, socket = linked(surface.alpha)
    is_image = source is not None and source.type == "TEX_IMAGE" and source.image and socket.name == "Alpha"
    if is_image and material.blend_method != "OPAQUE" and not surface.transparent:
        if material.blend_method in {"BLEND", "HASHED"}:
            left_out.add("soft transparency (cut out where alpha is below one half)", material.name)
        elif abs(material.alpha_threshold - 0.5) > 0.01:
            left_out.add("alpha threshold other than one half", material.name)
        return source.image
    value = getattr(surface.alpha, "default_value", 1.0)
    if source is not None or (value > 0 if surface.transparent else value < 1):
        left_out.add("transparency (drawn solid)", material.name)
    return None


def image_look(node, lines, left_out, name):
    """Lines of a material for how its image lies on its surface."""
    if node.extension in {"EXTEND", "CLIP"}:
        lines.append("texture_repeats = false")
    if node.extension == "CLIP":
        left_out.add("image clipped at its border (its border goes on)", name)
    lines.append('texture_filter = "%s"' % ("nearest" if node.interpolation == "Closest" else "linear"))
    if node.image.colorspace_settings.name not in {"sRGB", "Linear"}:
        left_out.add("image of a colour space other than sRGB", name)
    if node.image.source in {"SEQUENCE", "MOVIE"}:
        left_out.add("image sequence or film as a texture (one image of it)", name)
    if node.projection != "FLAT":
        left_out.add("image projected by other than texture coordinates", name)
    source, socket = linked(node.inputs["Vector"])
    if getattr(source, "type", None) == "MAPPING":
        place, turn, size = (source.inputs[k] for k in ("Location", "Rotation", "Scale"))
        if any(s.is_linked for s in (place, turn, size)) or source.vector_type != "POINT" or any(turn.default_value):
            left_out.add("mapping that turns, or is computed (left out)", name)
        else:
            lines.append("texture_scale = " + vector(size.default_value[:2]))
            lines.append("texture_offset = " + vector(place.default_value[:2]))
        source, socket = linked(source.inputs["Vector"])
    if getattr(source, "type", None) == "UVMAP" and not source.uv_map:
        return
    if source is not None and not (source.type == "TEX_COORD" and socket.name == "UV"):
        left_out.add("texture coordinates other than the rendered UV map (that is used)", name)


def base_color(material, left_out):
    """Linear colour of a material, and the node of its image or None."""
    if color_attribute(material) is not None:
        return (1.0, 1.0, 1.0), None
    if not material.use_nodes or not material.node_tree:
        return tuple(material.diffuse_color)[:3], None
    surface = Surface(material)
    if surface.color is None:
        left_out.add("material without a shader that has one colour (the viewport colour is used)", material.name)
        return tuple(material.diffuse_color)[:3], None
    source, _ = linked(surface.color)
    factor = surface.factor
    plain = None
    if source is None:
        plain = surface.color.default_value
    elif source.type == "RGB":
        plain = source.outputs[0].default_value
    elif source.type == "RGBA":  # the socket of a group
        plain = source.default_value
    if plain is not None:
        return tuple(c * factor + own for c, own in zip(tuple(plain), surface.added)), None
    if any(surface.added):
        left_out.add("emission beside an image", material.name)
    if source.type == "TEX_IMAGE" and source.image:
        return (factor,) * 3, source
    left_out.add("colour from nodes other than an image (the viewport colour is used)", material.name)
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
    result["shift"] = [c / (pixel * longer) for c in centre]
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


BEYOND = {"REPEAT": "repeat", "REPEAT_OFFSET": "offset", "MIRROR": "mirror"}


def curve_text(curve, scale=1.0):
    """An F-curve as limn's keys, or None where limn has none such. `scale` is of its values."""
    points = sorted(curve.keyframe_points, key=lambda k: k.co[0])
    kinds = {k.interpolation for k in points[:-1]} or {"CONSTANT"}
    beyond = {"CONSTANT": "hold", "LINEAR": "linear"}[curve.extrapolation]
    active = [m for m in curve.modifiers if not m.mute]
    if len(active) == 1 and active[0].type == "CYCLES" and not active[0].use_restricted_range:
        cycles = active[0]
        if cycles.mode_before != cycles.mode_after or cycles.cycles_before or cycles.cycles_after:
            return None
        beyond = BEYOND.get(cycles.mode_after)
    elif active:
        return None
    if len(kinds) > 1 or not kinds <= {"BEZIER", "LINEAR", "CONSTANT"} or beyond is None or not points:
        return None
    (kind,) = kinds
    pair = lambda co: "[%.9g, %s]" % (co[0], number(co[1] * scale))
    if kind == "BEZIER":
        keys = [
            "[%.9g, %s, %s, %s]"
            % (
                k.co[0],
                number(k.co[1] * scale),
                pair((min(k.handle_left[0], k.co[0]), k.handle_left[1])),
                pair((max(k.handle_right[0], k.co[0]), k.handle_right[1])),
            )
            for k in points
        ]
    else:
        keys = [pair(k.co) for k in points]
    ends = "" if beyond == "hold" else ', beyond = "%s"' % beyond
    return '{ keys = [%s], interpolation = "%s"%s }' % (", ".join(keys), kind.lower(), ends)


def own_curves(obj, frames, matrices):
    """The lines of an object that moves by its own F-curves alone, or None: then what they give has to be sampled."""
    animation = obj.animation_data
    if (
        obj.library
        or obj.parent
        or obj.constraints
        or obj.rigid_body
        or obj.rotation_mode != "XYZ"
        or animation is None
        or animation.action is None
        or animation.drivers
        or animation.nla_tracks
        or any(obj.delta_location)
        or any(obj.delta_rotation_euler)
        or tuple(obj.delta_scale) != (1.0, 1.0, 1.0)
    ):
        return None
    values = {"location": obj.location, "rotation_euler": obj.rotation_euler, "scale": obj.scale}
    curves = {}
    for curve in animation.action.fcurves:
        if curve.data_path in values and not curve.mute:
            curves[curve.data_path, curve.array_index] = curve
        elif curve.data_path.startswith("rotation") or curve.data_path.startswith("delta"):
            return None
    evaluate = lambda path, i, frame: curves[path, i].evaluate(frame) if (path, i) in curves else values[path][i]
    # What the curves say must be what stands in the scene: nothing else moves the object.
    for frame, matrix in zip(frames, matrices):
        place, turn, size = (Vector([evaluate(path, i, frame) for i in range(3)]) for path in values)
        again = Matrix.LocRotScale(place, Euler(turn, "XYZ"), size)
        places = [(r, c) for r in range(3) for c in range(4)]
        if any(abs(again[r][c] - matrix[r][c]) > 1e-5 * max(1.0, abs(matrix[r][c])) for r, c in places):
            return None
    lines = []
    for path, key, scale in (
        ("location", "translate", 1.0),
        ("rotation_euler", "rotate", 180.0 / math.pi),
        ("scale", "scale", 1.0),
    ):
        parts = []
        for i, letter in enumerate("xyz"):
            curve = curves.get((path, i))
            text = curve_text(curve, scale) if curve else number(values[path][i] * scale)
            if text is None:
                return None
            parts.append("%s = %s" % (letter, text))
        if any((path, i) in curves for i in range(3)):
            lines.append("%s = { %s }" % (key, ", ".join(parts)))
        elif tuple(values[path]) != ((1.0,) * 3 if path == "scale" else (0.0,) * 3):
            lines.append("%s = %s" % (key, vector([v * scale for v in values[path]])))
    return lines


def visible_line(shown, frames):
    """The line that says when an object is there, or nothing where it always is."""
    if all(shown):
        return []
    kept = [i for i in range(len(shown)) if i == 0 or shown[i] != shown[i - 1]]
    return ["visible = { keys = [%s] }" % ", ".join("[%d, %s]" % (frames[i], str(shown[i]).lower()) for i in kept)]


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
        self.by_look = {}  # (hash of the OBJ without points, colours, subdivision) -> those that look so
        self.taken, self.taken_textures = set(), set()
        self.materials = {}  # identity of Blender's -> (name in the scene, lines)
        self.moving_materials = {}  # identity -> (Blender's, its colour at each frame)
        self.taken_materials = set()
        self.plain = set()  # names of those that take no colours of vertices
        self.colored = False  # some mesh has them
        self.kept = []  # configs that were there
        self.frames = []
        self.counts = {"meshes": 0, "instances": 0, "cameras": 0, "lights": 0}

    def run(self):
        scene = self.context.scene
        os.makedirs(os.path.join(self.folder, "meshes"), exist_ok=True)
        # All frames of the range, whatever its step: limn's scenes declare ranges.
        frames = list(range(scene.frame_start, scene.frame_end + 1)) if self.animated else [scene.frame_current]
        self.frames, start = frames, scene.frame_current
        with RenderSettings(self.context, keep_cages=not self.dense) as render:
            tracks, cameras, lights = {}, {}, {}
            for frame in frames:
                if self.animated:
                    scene.frame_set(frame)
                    render.at_frame()
                depsgraph = self.context.evaluated_depsgraph_get()
                self.look(depsgraph, render.cages, frame, frames, tracks, cameras, lights)
            if self.animated:
                scene.frame_set(start)
            self.write(scene, frames, tracks, cameras, lights)
        return self.left_out

    # What stands in the scene at a frame.
    def look(self, depsgraph, cages, frame, frames, tracks, cameras, lights):
        width, height = self.picture_size()
        seen, corners = {}, []
        for instance in depsgraph.object_instances:
            obj = instance.object
            original = obj.original
            carrier = instance.parent.original if instance.is_instance else original
            # What nodes make instances of may be hidden itself.
            by_nodes = instance.is_instance and carrier.instance_type != "COLLECTION"
            if not instance.show_self or carrier.hide_render or (original.hide_render and not by_nodes):
                continue
            if obj.type in GEOMETRY and not self.is_for_cameras(instance, original):
                continue
            if obj.type in GEOMETRY:
                name = (
                    original.name
                    if not instance.is_instance
                    else "%s/%s" % (instance.parent.original.name, original.name)
                )
                if original.library:
                    name += " (%s)" % os.path.basename(original.library.filepath)
                seen[name] = seen.get(name, 0) + 1
                key = name if seen[name] == 1 else "%s #%d" % (name, seen[name])
                mesh = self.mesh_of(obj, cages, frame, frames, instance.is_instance)
                if mesh:
                    world = instance.matrix_world.copy()
                    own = None if instance.is_instance else original
                    tracks.setdefault(key, {"mesh": mesh, "object": own, "matrices": {}})["matrices"][frame] = world
                    corners += [world @ Vector(corner) for corner in obj.bound_box]
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
        for material, colors in self.moving_materials.values():
            colors[frame] = tuple(max(0.0, c) for c in base_color(material, LeftOut())[0])
        self.name_clipped(depsgraph, corners)

    def move_materials(self, frames):
        """Gives materials the keys of their colours. What else moves in them is said."""
        for key, (material, by_frame) in self.moving_materials.items():
            name, lines = self.materials[key]
            first = by_frame[min(by_frame)]
            colors = [by_frame.get(frame, first) for frame in frames]
            has_image = any(line.startswith("texture = ") for line in lines)
            if all(color == first for color in colors) or has_image:
                self.left_out.add("keyed values of a material (the first frame's)", material.name)
            else:
                lines[2] = "color = " + keyed(colors, frames)

    def name_clipped(self, depsgraph, corners):
        """Cameras of Blender cut off what is nearer or farther than their clip distances."""
        for instance in depsgraph.object_instances:
            obj = instance.object
            if obj.type != "CAMERA" or instance.is_instance:
                continue
            into = obj.matrix_world.normalized().inverted()
            depths = [-(into @ corner).z for corner in corners]
            before = [depth for depth in depths if depth > 0]
            if before and (max(before) > obj.data.clip_end or min(before) < obj.data.clip_start):
                self.left_out.add("clip distances (nothing is cut off)", obj.original.name)

    def is_for_cameras(self, instance, original):
        """Do cameras see it? Names what they do not see, or see as a hole."""
        carrier = instance.parent.original if instance.is_instance else original
        for obj in {original, carrier}:
            if not obj.visible_camera:
                self.left_out.add("object that cameras do not see (and its shadow)", obj.name)
                return False
            if not instance.is_instance:
                if obj.indirect_only_get(view_layer=self.context.view_layer):
                    self.left_out.add("object of an indirect only collection (and its shadow)", obj.name)
                    return False
                if obj.holdout_get(view_layer=self.context.view_layer):
                    self.left_out.add("holdout", obj.name)
        return True

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
        numbers["shadow"] = light.use_shadow
        return numbers

    def deforms(self, obj):
        """May the mesh change its shape over frames? Whether it does is seen when every frame has been written."""
        original = obj.original
        data = original.data
        return (
            original.type != "MESH"  # families of metaballs, bevel objects: others move their shape
            or original.parent_type in {"ARMATURE", "LATTICE"}
            or bool(original.modifiers)
            or getattr(data, "shape_keys", None) is not None
            or getattr(data, "animation_data", None) is not None
        )

    def slots_of(self, obj, mesh):
        """The materials of a mesh's slots, after modifiers and with those of the object's own slots."""
        slots = [material.original if material else None for material in mesh.materials]
        for i, slot in enumerate(obj.original.material_slots):
            if slot.link == "OBJECT" and i < max(1, len(slots)):
                slots[i : i + 1] = [slot.material]
        return slots

    def mesh_of(self, obj, cages, frame, frames, is_instance):
        """Writes the object's mesh unless that has been done; returns its name in the scene file, or None without
        faces.
        """
        original = obj.original
        cage = cages.get(identity(original))
        subsurf = cage[0] if cage else None
        by_object = any(slot.link == "OBJECT" for slot in original.material_slots)
        # Geometry nodes make instances of bare meshes, which belong to no object.
        is_bare = is_instance and original.type == "MESH" and obj.data.original not in {original.data, obj.data}
        if is_bare:
            key = ("bare", identity(original), identity(obj.data.original))
        elif is_instance and any(m.type == "NODES" for m in original.modifiers):
            key = ("shown", identity(original), obj.data.name, len(obj.data.vertices), len(obj.data.polygons))
        elif (
            original.modifiers
            or by_object
            or original.type != "MESH"
            or original.show_only_shape_key
            or original.parent_type in {"ARMATURE", "LATTICE"}
        ):
            key = ("object", identity(original))
        else:
            key = ("data", identity(original.data))
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
            materials = self.slots_of(obj, mesh)
            slots = [self.material(material) for material in materials or [None]]
            wanted = {color_attribute(material) for material in materials} - {None}
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
            if not mesh.uv_layers and any("texture = " in line for m in materials for line in self.lines_of(m)):
                self.left_out.add("image on a mesh without a UV map", original.name)
            self.colored = self.colored or colors is not None
            if differ:
                self.left_out.add("colours that differ between the faces at a vertex (averaged)", original.name)
            points, rest = obj_text(mesh, slots, subsurf, colors)
            shape = numbers_of(mesh.vertices, "co", 3)
            look = (
                hashlib.sha256(rest.encode()).digest(),
                tuple(colors or ()),
                subdivision_line(*cage) if cage else "",
            )
            if not known and not moving:
                largest = max(map(abs, shape))
                for other in self.by_look.get(look, []):
                    if same_but_for_rounding(shape, other["shape"], largest):
                        self.meshes[key] = other  # the same under another name: once is enough
                        return other["name"]
            if not known:
                name = original.data.name if key[0] == "data" else obj.data.name if key[0] == "bare" else original.name
                name = file_name(name, self.taken)
                known = self.meshes[key] = {
                    "name": name,
                    "frames": {},
                    "cage": cage,
                    "shape": None,
                    "moves": False,
                    "deforms": moving,
                }
                self.counts["meshes"] += 1
                self.note(original, mesh, subsurf)
            if known["shape"] is None:
                known["shape"] = shape
            elif shape != known["shape"]:
                known["moves"] = True
            digits = "_" + frame_digits(frame) if moving else ""
            path = os.path.join(self.folder, "meshes", known["name"] + digits + ".obj")
            with open(path, "w", encoding="utf-8", newline="\n") as file:
                file.write(points)
                file.write(rest)
            if not moving:
                self.by_look.setdefault(look, []).append(known)
            known["frames"][frame] = path
            return known["name"]
        finally:
            obj.to_mesh_clear()

    def note(self, original, mesh, subsurf):
        if getattr(original, "is_shadow_catcher", False):
            self.left_out.add("shadow catcher (drawn as it is)", original.name)
        for modifier in original.modifiers:
            group = modifier.node_group if modifier.type == "NODES" else None
            if group and any(node.type == "IS_VIEWPORT" for node in group.nodes):
                self.left_out.add("geometry nodes that ask for the viewport (as on the screen)", original.name)
            if (
                modifier.type == "SUBSURF"
                and modifier.show_render
                and modifier != subsurf
                and modifier.render_levels > 0
            ):
                self.left_out.add("subdivision before other modifiers (written as polygons)", original.name)
        if any(getattr(edge, "use_freestyle_mark", False) for edge in mesh.edges):
            self.left_out.add("Freestyle mark", original.name)
        if any(getattr(face, "use_freestyle_mark", False) for face in mesh.polygons):
            self.left_out.add("Freestyle mark of faces", original.name)
        if subsurf is not None and not any(face.use_smooth for face in mesh.polygons):
            self.left_out.add("flat shading of a subdivided surface (drawn smooth)", original.name)
        if original.particle_systems:
            self.left_out.add("hair or particles", original.name)

    def lines_of(self, material):
        return self.materials[identity(material) if material else None][1]

    def material(self, material):
        if material is None:
            if None not in self.materials:  # as Blender draws what has no material
                name = unique("Default", self.taken_materials)
                self.materials[None] = (name, ["[[material]]", "name = " + quoted(name), "color = [0.8, 0.8, 0.8]"])
                self.plain.add(name)
            return self.materials[None][0]
        known = self.materials.get(identity(material))
        if known:
            return known[0]
        name = unique(one_word(material.name), self.taken_materials)
        color, node = base_color(material, self.left_out)
        image = node.image if node else None
        lines = ["[[material]]", "name = " + quoted(name), "color = " + vector([max(0.0, c) for c in color])]
        path = texture_path(image, self.folder, self.taken_textures, self.left_out) if image else None
        if path:
            lines.append("texture = " + quoted(path))
            image_look(node, lines, self.left_out, material.name)
        holes = cutout_image(material, self.left_out)
        if holes:
            same = image == holes and path
            path = path if same else texture_path(holes, self.folder, self.taken_textures, self.left_out)
            if path:
                lines.append("cutout = " + quoted(path))
        # Blender's own default is a transparent black: whoever wants black lines gives them some opacity.
        if tuple(material.line_color) != (0.0, 0.0, 0.0, 0.0):
            lines.append("line_color = " + vector([max(0.0, c) for c in tuple(material.line_color)[:3]]))
        animated = [material.animation_data] + ([material.node_tree.animation_data] if material.node_tree else [])
        if self.animated and any(animated):
            self.moving_materials[identity(material)] = (material.original, {})
        self.materials[identity(material)] = (name, lines)
        if color_attribute(material) is None:
            self.plain.add(name)
        return name

    # The files.
    def write(self, scene, frames, tracks, cameras, lights):
        self.move_materials(frames)
        lines = [
            "# Written by limn's Blender exporter from %s: written anew by the next export."
            % quoted(os.path.basename(bpy.data.filepath) or "an unsaved file"),
            'include = ["%s"]   # what you add to the scene; exports leave it alone' % OWN_SCENE,
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
        for name, material in self.materials.values():
            lines += material + (["vertex_colors = false"] if self.colored and name in self.plain else []) + [""]
        for name, track in tracks.items():
            lines += self.instance_entry(name, track, frames)
        for name, by_frame in cameras.items():
            lines += self.camera_entry(name, by_frame, frames)
        for name, by_frame in lights.items():
            lines += self.light_entry(name, by_frame, frames)
        with open(os.path.join(self.folder, "scene.toml"), "w", encoding="utf-8", newline="\n") as file:
            file.write("\n".join(lines).rstrip() + "\n")
        own = os.path.join(self.folder, OWN_SCENE)
        if not os.path.exists(own):
            with open(own, "w", encoding="utf-8", newline="\n") as file:
                file.write("# Lights, cameras, sections: what you add to scene.toml. Exports leave this file alone.\n")
        taken = {"scene", os.path.splitext(OWN_SCENE)[0]}
        for name in cameras or [""]:
            self.write_config(scene, name, file_name(name or "picture", taken))
        self.name_the_rest(scene)
        if not tracks:
            self.left_out.add("anything to draw", "the scene has no surfaces")

    def mesh_entry(self, known):
        self.fill_frames(known)
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
        if known["cage"] is not None:
            lines.append(subdivision_line(*known["cage"]))
        return lines + [""]

    def fill_frames(self, known):
        """A mesh that is not there at some frames is empty there: limn wants a file for each."""
        if not known["deforms"]:
            return
        for frame in self.frames:
            if frame not in known["frames"]:
                path = os.path.join(self.folder, "meshes", "%s_%s.obj" % (known["name"], frame_digits(frame)))
                with open(path, "w", encoding="utf-8", newline="\n") as file:
                    file.write("# nothing in this frame\n")
                known["frames"][frame], known["moves"] = path, True

    def name_the_rest(self, scene):
        """What belongs to the whole picture and has no place in limn's files."""
        render = scene.render
        if render.use_border:
            width, height = self.picture_size()
            x0, x1 = round(render.border_min_x * width), round(render.border_max_x * width)
            y0, y1 = round(render.border_min_y * height), round(render.border_max_y * height)
            crop = "%d,%d,%d,%d" % (x0, height - y1, x1 - x0, y1 - y0)
            self.left_out.add("render border", "draw with --crop " + crop)
        if self.animated and scene.frame_step > 1:
            spec = "%d-%dx%d" % (scene.frame_start, scene.frame_end, scene.frame_step)
            self.left_out.add("frame step (all frames are there)", "draw with --frames " + spec)
        if any(marker.camera for marker in scene.timeline_markers):
            self.left_out.add(
                "cameras bound to markers (each camera has a config of its own)",
                ", ".join("%s at %d" % (m.camera.name, m.frame) for m in scene.timeline_markers if m.camera),
            )

    def background(self, scene):
        """The world's colour as a config says it, or None."""
        world = scene.world
        if scene.render.film_transparent:
            return "transparent"
        if world is None:
            return None
        color = tuple(world.color)
        if world.use_nodes and world.node_tree:
            output = world.node_tree.get_output_node("ALL")
            node, _ = linked(output.inputs["Surface"] if output else None)
            if getattr(node, "type", None) != "BACKGROUND" or linked(node.inputs["Color"])[0] is not None:
                self.left_out.add("world other than one colour", world.name)
                return None
            color = tuple(c * node.inputs["Strength"].default_value for c in tuple(node.inputs["Color"].default_value))
        return "#%02x%02x%02x" % tuple(round(255 * encoded(c)) for c in color[:3])

    def instance_entry(self, name, track, frames):
        lines = ["[[instance]]", "name = " + quoted(name), "mesh = " + quoted(track["mesh"])]
        matrices = [track["matrices"].get(frame) for frame in frames]
        shown = [matrix is not None for matrix in matrices]
        last = next(matrix for matrix in matrices if matrix is not None)
        for i, matrix in enumerate(matrices):
            matrices[i] = last = matrix if matrix is not None else last
        self.counts["instances"] += 1
        lines += visible_line(shown, frames)
        if all(matrix == matrices[0] for matrix in matrices):
            if matrices[0] != Matrix.Identity(4):
                lines.append(
                    "matrix = " + vector([matrices[0][row][column] for row in range(4) for column in range(4)])
                )
            return lines + [""]
        curves = own_curves(track["object"], frames, matrices) if track["object"] and all(shown) else None
        if curves is not None:
            return lines + curves + [""]
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
        if len({"focal_length" in numbers for numbers in by_frame.values()}) > 1:
            self.left_out.add("camera that turns from perspective to orthographic (as at first)", name)
        for key in ("position", "look_at", "up", "focal_length", "orthographic_height", "shift"):
            shifts = key != "shift" or any(abs(c) > 1e-7 for numbers in by_frame.values() for c in numbers["shift"])
            if key in first and shifts:
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
        if first["shadow"]:
            lines.append("shadow = { resolution = 2048 }")
        if first["kind"] != "sun":
            lines.append("range = 1")  # falls with the square of the distance, beyond a unit
        return lines + [""]

    def write_config(self, scene, camera, name):
        render = scene.render
        if render.pixel_aspect_x != render.pixel_aspect_y:
            self.left_out.add("pixels that are not square", "%g:%g" % (render.pixel_aspect_x, render.pixel_aspect_y))
        path = os.path.join(self.folder, name + ".toml")
        if os.path.exists(path):
            self.kept.append(name + ".toml")
            return
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
        background = self.background(scene)
        if background:
            lines.append("background = " + quoted(background))
        lines += [
            "",
            "[shading]",
            'technique = "toon"',
            "",
            "[ao]",
            'technique = "toon_ssao"',
            'filter = { technique = "plane_aware", passes = 4 }',
            "",
            "[[edges]]",
            'technique = "depth_normal"',
            "",
            "[output]",
            "path = " + quoted("%s%s.png" % (name, "_####" if self.animated else "")),
        ]
        with open(path, "w", encoding="utf-8", newline="\n") as file:
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
    if exporter.kept:
        print("limn: kept as they were: " + ", ".join(exporter.kept))
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
