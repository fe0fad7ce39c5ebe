"""Materials: colours, textures, alpha, and names.

blender -b --factory-startup --python-exit-code 1 -P make_nodes.py     (after make_libraries.py)
"""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stationlib import *  # noqa: F401,F403 - a small language for these files

LIB_A = os.path.join(BLENDS, "lib_a.blend")


def show(s, material, **settings):
    settings["materials"] = [material]
    return s.put("plane", s.plane(**settings), turn=(0, 0, 0))


def shader_station(s, kind="ShaderNodeBsdfPrincipled"):
    """A material with one shader to its output: material, nodes, shader."""
    material, nodes, out = node_material(s.named("paint"))
    shader = nodes.new(kind)
    nodes.link(shader, 0, out, 0)
    return material, nodes, shader


def colored(s, kind, entry="Color", **values):
    """A shader whose colour is the station's."""
    material, nodes, shader = shader_station(s, kind)
    shader.inputs[entry].default_value = (*s.color, 1)
    for key, value in values.items():
        shader.inputs[key].default_value = value
    return material, nodes, shader


def fed(s, source_kind, output=0, **settings):
    """A Principled whose colour comes from a node."""
    material, nodes, shader = shader_station(s)
    source = nodes.new(source_kind, **settings)
    nodes.link(source, output, shader, "Base Color")
    show(s, material)
    return material, nodes, shader, source


# Constant colours.


def rgb_node(s):
    """RGB node into Base Color"""
    fed(s, "ShaderNodeRGB")[3].outputs[0].default_value = (*s.color, 1)


def value_node(s):
    """Value node into Base Color"""
    fed(s, "ShaderNodeValue")[3].outputs[0].default_value = 0.3


def rerouted_rgb(s):
    """RGB node through a reroute"""
    material, nodes, shader = shader_station(s)
    rgb, route = nodes.new("ShaderNodeRGB"), nodes.new("NodeReroute")
    rgb.outputs[0].default_value = (*s.color, 1)
    nodes.link(rgb, 0, route, 0)
    nodes.link(route, 0, shader, "Base Color")
    show(s, material)


def mixed_colors(s):
    """Mix of two constant colours"""
    mix = fed(s, "ShaderNodeMixRGB")[3]
    mix.inputs[0].default_value = 0.25
    mix.inputs[1].default_value, mix.inputs[2].default_value = (*s.color, 1), (0.05, 0.05, 0.6, 1)


def combined_color(s):
    """Combine Color (RGB) into Base Color"""
    combine = fed(s, "ShaderNodeCombineColor")[3]
    for entry, value in zip(combine.inputs, s.color):
        entry.default_value = value


def ramp_color(s):
    """Color Ramp at a constant"""
    ramp = fed(s, "ShaderNodeValToRGB")[3]
    ramp.inputs[0].default_value = 0.5
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.8, 0.1, 0.1, 1), (0.1, 0.1, 0.8, 1)


def gamma_color(s):
    """Gamma and Hue/Saturation of a constant"""
    material, nodes, shader, gamma = fed(s, "ShaderNodeGamma")
    gamma.inputs["Color"].default_value, gamma.inputs["Gamma"].default_value = (*s.color, 1), 2.2


def object_color(s):
    """Object Info color"""
    fed(s, "ShaderNodeObjectInfo", "Color")
    bpy.data.objects[s.named("plane")].color = (*s.color, 1)


def blackbody(s):
    """Blackbody into Base Color"""
    fed(s, "ShaderNodeBlackbody")[3].inputs[0].default_value = 3000


# Shaders.


def emission(s):
    """Emission, strength 1"""
    show(s, colored(s, "ShaderNodeEmission")[0])


def emission_strength(s):
    """Emission, strength 0.4"""
    show(s, colored(s, "ShaderNodeEmission", Strength=0.4)[0])


def emission_bright(s):
    """Emission, strength 5 (brighter than white)"""
    show(s, colored(s, "ShaderNodeEmission", Strength=5.0)[0])


def emission_stale(s):
    """Emission, with a Principled left in the tree unconnected"""
    material, nodes, _ = colored(s, "ShaderNodeEmission", Strength=0.7)
    nodes.new("ShaderNodeBsdfPrincipled").inputs["Base Color"].default_value = (0.9, 0.9, 0.1, 1)
    show(s, material)


def stale_first(s):
    """Two Principled, the first unconnected"""
    material, nodes, out = node_material(s.named("paint"))
    nodes.new("ShaderNodeBsdfPrincipled").inputs["Base Color"].default_value = (0.9, 0.9, 0.1, 1)
    shader = nodes.new("ShaderNodeBsdfPrincipled")
    shader.inputs["Base Color"].default_value = (*s.color, 1)
    nodes.link(shader, 0, out, 0)
    show(s, material)


def two_outputs(s):
    """Two outputs, the second active"""
    material, nodes, out = node_material(s.named("paint"))
    other = nodes.new("ShaderNodeBsdfPrincipled")
    other.inputs["Base Color"].default_value = (0.9, 0.9, 0.1, 1)
    nodes.link(other, 0, out, 0)
    shader, second = nodes.new("ShaderNodeBsdfPrincipled"), nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Base Color"].default_value = (*s.color, 1)
    nodes.link(shader, 0, second, 0)
    out.is_active_output, second.is_active_output = False, True
    show(s, material)


def cycles_output(s):
    """An output for EEVEE and one for Cycles"""
    material, nodes, out = node_material(s.named("paint"))
    out.target = "EEVEE"
    other = nodes.new("ShaderNodeBsdfPrincipled")
    other.inputs["Base Color"].default_value = (0.9, 0.9, 0.1, 1)
    nodes.link(other, 0, out, 0)
    shader, second = nodes.new("ShaderNodeBsdfPrincipled"), nodes.new("ShaderNodeOutputMaterial", target="CYCLES")
    shader.inputs["Base Color"].default_value = (*s.color, 1)
    nodes.link(shader, 0, second, 0)
    show(s, material)


def diffuse(s):
    """Diffuse BSDF"""
    show(s, colored(s, "ShaderNodeBsdfDiffuse")[0])


def diffuse_textured(s):
    """Diffuse BSDF with an image"""
    material, nodes, shader = shader_station(s, "ShaderNodeBsdfDiffuse")
    image = nodes.new("ShaderNodeTexImage", image=blocks_image(s.named("image")))
    nodes.link(image, 0, shader, 0)
    show(s, material)


def emission_textured(s):
    """Emission with an image"""
    material, nodes, shader = shader_station(s, "ShaderNodeEmission")
    image = nodes.new("ShaderNodeTexImage", image=blocks_image(s.named("image")))
    nodes.link(image, 0, shader, 0)
    show(s, material)


def principled_emission(s):
    """Principled, black, with emission colour and strength 0.5"""
    material, _, shader = shader_station(s)
    shader.inputs["Base Color"].default_value = (0, 0, 0, 1)
    shader.inputs["Emission"].default_value, shader.inputs["Emission Strength"].default_value = (*s.color, 1), 0.5
    show(s, material)


def mixed_shaders(s):
    """Mix Shader of two Diffuse, factor 0.25"""
    material, nodes, mix = shader_station(s, "ShaderNodeMixShader")
    mix.inputs[0].default_value = 0.25
    for entry, color in ((1, s.color), (2, (0.05, 0.05, 0.6))):
        shader = nodes.new("ShaderNodeBsdfDiffuse")
        shader.inputs[0].default_value = (*color, 1)
        nodes.link(shader, 0, mix, entry)
    show(s, material)


def added_shaders(s):
    """Add Shader of Diffuse and Emission"""
    material, nodes, add = shader_station(s, "ShaderNodeAddShader")
    for entry, kind, color in ((0, "ShaderNodeBsdfDiffuse", (0.1, 0.3, 0.0)), (1, "ShaderNodeEmission", (0.3, 0, 0.3))):
        shader = nodes.new(kind)
        shader.inputs[0].default_value = (*color, 1)
        nodes.link(shader, 0, add, entry)
    show(s, material)


def camera_ray(s):
    """Mix by Light Path, Is Camera Ray: the camera sees the emission"""
    material, nodes, mix = shader_station(s, "ShaderNodeMixShader")
    path, other, shader = (nodes.new(k) for k in (
        "ShaderNodeLightPath", "ShaderNodeBsdfPrincipled", "ShaderNodeEmission"))
    shader.inputs[0].default_value = (*s.color, 1)
    other.inputs["Base Color"].default_value = (0.9, 0.9, 0.1, 1)
    nodes.link(path, "Is Camera Ray", mix, 0)
    nodes.link(other, 0, mix, 1)
    nodes.link(shader, 0, mix, 2)
    show(s, material)


def no_nodes(s):
    """Material without nodes: its viewport colour"""
    material = bpy.data.materials.new(s.named("paint"))
    material.diffuse_color = (*s.color, 1)
    show(s, material)


def muted_node(s):
    """A muted node between image and shader"""
    material, nodes, shader = shader_station(s)
    image, invert = nodes.new("ShaderNodeTexImage", image=blocks_image(s.named("image"))), nodes.new("ShaderNodeInvert")
    invert.mute = True
    nodes.link(image, 0, invert, "Color")
    nodes.link(invert, 0, shader, "Base Color")
    show(s, material)


# Groups.


def linked_color_group(s):
    """Linked group with an RGB node inside"""
    (groups,) = link_library(LIB_A, node_groups=["Lib colour"])
    material, nodes, shader = shader_station(s)
    group = nodes.new("ShaderNodeGroup", node_tree=groups[0])
    nodes.link(group, 0, shader, "Base Color")
    show(s, material)


def linked_shader_group(s):
    """Linked group with a Principled inside"""
    (groups,) = link_library(LIB_A, node_groups=["Lib shader"])
    material, nodes, out = node_material(s.named("paint"))
    nodes.link(nodes.new("ShaderNodeGroup", node_tree=groups[0]), 0, out, 0)
    show(s, material)


def group_with_input(s):
    """Group whose colour is an input, set at the node"""
    tree = bpy.data.node_groups.new(s.named("group"), "ShaderNodeTree")
    tree.inputs.new("NodeSocketColor", "Color")
    tree.outputs.new("NodeSocketShader", "Shader")
    inner = Nodes(tree)
    entry, shader, out = (inner.new(k) for k in ("NodeGroupInput", "ShaderNodeBsdfPrincipled", "NodeGroupOutput"))
    inner.link(entry, 0, shader, "Base Color")
    inner.link(shader, 0, out, 0)
    material, nodes, out = node_material(s.named("paint"))
    group = nodes.new("ShaderNodeGroup", node_tree=tree)
    group.inputs[0].default_value = (*s.color, 1)
    nodes.link(group, 0, out, 0)
    show(s, material)


def group_with_image(s):
    """Group with image and Principled inside, in another group"""
    inner_tree = bpy.data.node_groups.new(s.named("inner"), "ShaderNodeTree")
    inner_tree.outputs.new("NodeSocketShader", "Shader")
    inner = Nodes(inner_tree)
    image = inner.new("ShaderNodeTexImage", image=blocks_image(s.named("image")))
    shader, out = inner.new("ShaderNodeBsdfPrincipled"), inner.new("NodeGroupOutput")
    inner.link(image, 0, shader, "Base Color")
    inner.link(shader, 0, out, 0)
    outer_tree = bpy.data.node_groups.new(s.named("outer"), "ShaderNodeTree")
    outer_tree.outputs.new("NodeSocketShader", "Shader")
    outer = Nodes(outer_tree)
    outer.link(outer.new("ShaderNodeGroup", node_tree=inner_tree), 0, outer.new("NodeGroupOutput"), 0)
    material, nodes, out = node_material(s.named("paint"))
    nodes.link(nodes.new("ShaderNodeGroup", node_tree=outer_tree), 0, out, 0)
    show(s, material)


# Textures.


def textured(s, alpha=None, **settings):
    """A Principled with an image of blocks: material, nodes, image node, shader."""
    material, nodes, shader = shader_station(s)
    image = nodes.new("ShaderNodeTexImage", image=blocks_image(s.named("image"), alpha=alpha), **settings)
    nodes.link(image, 0, shader, "Base Color")
    return material, nodes, image, shader


def plain_image(s):
    """Image into Base Color (the control)"""
    show(s, textured(s)[0])


def mapped(s, coordinates="UV", vector_type="POINT", **values):
    material, nodes, image, _ = textured(s)
    source, mapping = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeMapping", vector_type=vector_type)
    nodes.link(source, coordinates, mapping, 0)
    nodes.link(mapping, 0, image, 0)
    for key, value in values.items():
        mapping.inputs[key].default_value = value
    show(s, material)
    return material, nodes, image


def mapping_scale(s):
    """Mapping: scale 2 and 0.5"""
    mapped(s, Scale=(2, 0.5, 1))


def mapping_moved(s):
    """Mapping: location (0.3, 0.1) and scale 2"""
    mapped(s, Location=(0.3, 0.1, 0), Scale=(2, 2, 1))


def mapping_turned(s):
    """Mapping: rotation by 30 degrees"""
    mapped(s, Rotation=(0, 0, 0.5235988))


def mapping_texture_type(s):
    """Mapping of type TEXTURE"""
    mapped(s, vector_type="TEXTURE", Location=(0.3, 0.1, 0), Scale=(2, 0.5, 1))


def mapping_negative(s):
    """Mapping: scale -1 (mirrored)"""
    mapped(s, Scale=(-1, 1, 1))


def uv_map_node(s):
    """UV Map node that names the second layer"""
    material, nodes, image, _ = textured(s)
    nodes.link(nodes.new("ShaderNodeUVMap", uv_map="Other"), 0, image, 0)
    show(s, material, layers=("UVMap", "Other"))


def uv_map_attribute(s):
    """Attribute node that names the second UV layer"""
    material, nodes, image, _ = textured(s)
    nodes.link(nodes.new("ShaderNodeAttribute", attribute_name="Other"), "Vector", image, 0)
    show(s, material, layers=("UVMap", "Other"))


def uv_render_layer(s):
    """UV layer for render differs from the active one"""
    mesh = show(s, textured(s)[0], layers=("UVMap", "Other")).data
    mesh.uv_layers["Other"].active_render = True
    mesh.uv_layers.active = mesh.uv_layers["UVMap"]


def uv_two_materials(s):
    """Two materials, each with its own UV layer, on one mesh"""
    materials = []
    for name in ("UVMap", "Other"):
        material, nodes, out = node_material(s.named("paint " + name))
        shader, image = nodes.new("ShaderNodeBsdfPrincipled"), nodes.new("ShaderNodeTexImage")
        image.image = blocks_image(s.named("image " + name))
        nodes.link(nodes.new("ShaderNodeUVMap", uv_map=name), 0, image, 0)
        nodes.link(image, 0, shader, "Base Color")
        nodes.link(shader, 0, out, 0)
        materials.append(material)
    mesh = s.plane(cuts=2, layers=("UVMap", "Other"), materials=materials)
    for polygon in mesh.polygons:
        polygon.material_index = polygon.index % 2
    s.put("plane", mesh, turn=(0, 0, 0))


def object_coordinates(s):
    """Object coordinates"""
    material, nodes, image, _ = textured(s)
    turn = nodes.new("ShaderNodeMapping")
    turn.inputs["Rotation"].default_value = (1.5707963, 0, 0)
    nodes.link(nodes.new("ShaderNodeTexCoord"), "Object", turn, 0)
    nodes.link(turn, 0, image, 0)
    show(s, material)


def generated_coordinates(s):
    """Generated coordinates"""
    material, nodes, image, _ = textured(s)
    turn = nodes.new("ShaderNodeMapping")
    turn.inputs["Rotation"].default_value = (1.5707963, 0, 0)
    nodes.link(nodes.new("ShaderNodeTexCoord"), "Generated", turn, 0)
    nodes.link(turn, 0, image, 0)
    show(s, material)


def box_projection(s):
    """Image projected as a box by object coordinates"""
    material, nodes, image, _ = textured(s, projection="BOX")
    nodes.link(nodes.new("ShaderNodeTexCoord"), "Object", image, 0)
    show(s, material)


def extension(s, kind):
    material, nodes, image = mapped(s, Scale=(2, 2, 1), Location=(-0.5, -0.5, 0))
    image.extension = kind


def extension_clip(s):
    """Extension CLIP (black beyond the image)"""
    extension(s, "CLIP")


def extension_clip_alpha(s):
    """Extension CLIP with the image's alpha: nothing beyond the image"""
    material, nodes, image = mapped(s, Scale=(2, 2, 1), Location=(-0.5, -0.5, 0))
    image.extension = "CLIP"
    nodes.link(image, "Alpha", material.node_tree.nodes["Principled BSDF"], "Alpha")
    material.blend_method = "CLIP"


def extension_extend(s):
    """Extension EXTEND"""
    extension(s, "EXTEND")


def interpolation_closest(s):
    """A small image (8 x 8), interpolated linearly"""
    material, nodes, shader = shader_station(s)
    image = nodes.new("ShaderNodeTexImage", image=blocks_image(s.named("image"), size=4))
    nodes.link(image, 0, shader, "Base Color")
    show(s, material)


def non_color(s):
    """Image taken as Non-Color"""
    material, _, image, _ = textured(s)
    image.image.colorspace_settings.name = "Non-Color"
    show(s, material)


def multiplied_image(s):
    """Image multiplied by a constant colour"""
    material, nodes, image, shader = textured(s)
    mix = nodes.new("ShaderNodeMixRGB", blend_type="MULTIPLY")
    mix.inputs[0].default_value, mix.inputs[2].default_value = 1, (0.5, 0.25, 1, 1)
    nodes.link(image, 0, mix, 1)
    nodes.link(mix, 0, shader, "Base Color")
    show(s, material)


def no_uv(s):
    """Image on a mesh without UVs"""
    mesh = show(s, textured(s)[0]).data
    mesh.uv_layers.remove(mesh.uv_layers[0])


def missing_uv(s):
    """UV Map node that names a layer that is not there"""
    material, nodes, image, _ = textured(s)
    nodes.link(nodes.new("ShaderNodeUVMap", uv_map="Nowhere"), 0, image, 0)
    show(s, material)


def procedural(s):
    """Checker texture (no image)"""
    material, nodes, shader = shader_station(s)
    checker = nodes.new("ShaderNodeTexChecker")
    nodes.link(nodes.new("ShaderNodeTexCoord"), "UV", checker, 0)
    nodes.link(checker, 0, shader, "Base Color")
    show(s, material)


def corner_colors(s):
    """Colour attribute by corners, sharp between faces"""
    material, nodes, shader = shader_station(s)
    nodes.link(nodes.new("ShaderNodeVertexColor", layer_name="Col"), 0, shader, "Base Color")
    mesh = show(s, material, cuts=2).data
    layer = mesh.color_attributes.new("Col", "FLOAT_COLOR", "CORNER")
    for polygon in mesh.polygons:
        for corner in polygon.loop_indices:
            layer.data[corner].color = (*hue(polygon.index), 1)


# Alpha.


def hole(u, v):
    return 0.0 if (u - 0.5) ** 2 + (v - 0.5) ** 2 < 0.1 else 1.0


def alpha_principled(s):
    """Alpha of the image into Principled (the control)"""
    material, nodes, image, shader = textured(s, alpha=hole)
    nodes.link(image, "Alpha", shader, "Alpha")
    material.blend_method = "CLIP"
    show(s, material)


def alpha_opaque(s):
    """Alpha of the image, blend_method OPAQUE (which Cycles does not heed)"""
    material, nodes, image, shader = textured(s, alpha=hole)
    nodes.link(image, "Alpha", shader, "Alpha")
    material.blend_method = "OPAQUE"
    show(s, material)


def transparent_mix(s, invert):
    material, nodes, mix = shader_station(s, "ShaderNodeMixShader")
    image = nodes.new("ShaderNodeTexImage", image=blocks_image(s.named("image"), alpha=hole))
    clear, shader = nodes.new("ShaderNodeBsdfTransparent"), nodes.new("ShaderNodeBsdfPrincipled")
    nodes.link(image, 0, shader, "Base Color")
    source = image, "Alpha"
    if invert:
        flip = nodes.new("ShaderNodeMath", operation="SUBTRACT")
        flip.inputs[0].default_value = 1
        nodes.link(image, "Alpha", flip, 1)
        source = flip, 0
    nodes.link(*source, mix, 0)
    nodes.link(shader if invert else clear, 0, mix, 1)
    nodes.link(clear if invert else shader, 0, mix, 2)
    material.blend_method = "CLIP"
    show(s, material)


def alpha_mix(s):
    """Alpha by a mix with Transparent"""
    transparent_mix(s, False)


def alpha_mix_inverted(s):
    """Alpha by a mix with Transparent, the other way round (1 - alpha)"""
    transparent_mix(s, True)


def alpha_mask_image(s):
    """Alpha from the brightness of another image"""
    material, nodes, image, shader = textured(s)
    mask = bpy.data.images.new(s.named("mask"), 128, 128)
    mask.pixels = [c for y in range(128) for x in range(128)
                   for c in (hole((x + 0.5) / 128, (y + 0.5) / 128),) * 3 + (1,)]
    mask.pack()
    mask.colorspace_settings.name = "Non-Color"
    nodes.link(nodes.new("ShaderNodeTexImage", image=mask), 0, shader, "Alpha")
    material.blend_method = "CLIP"
    show(s, material)


def alpha_zero(s):
    """Principled alpha 0: nothing"""
    material, _, shader = shader_station(s)
    shader.inputs["Alpha"].default_value = 0
    material.blend_method = "CLIP"
    show(s, material)
    s.extra["empty"] = True


def transparent_only(s):
    """Transparent BSDF alone: nothing"""
    show(s, shader_station(s, "ShaderNodeBsdfTransparent")[0])
    s.extra["empty"] = True


def no_output(s):
    """Nothing connected to the output"""
    material, _, _ = node_material(s.named("paint"))
    show(s, material)


def empty_slot(s):
    """An empty material slot"""
    mesh = show(s, s.paint()).data
    mesh.materials[0] = None


def no_slot(s):
    """No material slot at all"""
    mesh = show(s, s.paint()).data
    mesh.materials.clear()


def index_beyond(s):
    """Face whose material index lies beyond the slots"""
    mesh = show(s, s.paint(), cuts=2).data
    for polygon in mesh.polygons:
        polygon.material_index = 7


NODES = [
    rgb_node, value_node, rerouted_rgb, mixed_colors, combined_color, ramp_color, gamma_color, object_color, blackbody,
    emission, emission_strength, emission_bright, emission_stale, stale_first, two_outputs, cycles_output, diffuse,
    diffuse_textured, emission_textured, principled_emission, mixed_shaders, added_shaders, camera_ray, no_nodes,
    muted_node, linked_color_group, linked_shader_group, group_with_input, group_with_image, plain_image, mapping_scale,
    mapping_moved, mapping_turned, mapping_texture_type, mapping_negative, uv_map_node, uv_map_attribute,
    uv_render_layer, uv_two_materials, object_coordinates, generated_coordinates, box_projection, extension_clip,
    extension_clip_alpha, extension_extend, interpolation_closest, non_color, multiplied_image, no_uv, missing_uv,
    procedural, corner_colors, alpha_principled, alpha_opaque, alpha_mix, alpha_mix_inverted, alpha_mask_image,
    alpha_zero, transparent_only, no_output, empty_slot, no_slot, index_beyond,
]


# Alpha thresholds: Cycles does not know them, EEVEE does.


def ramp_alpha(u, v):
    return u


def threshold(s, value, method="CLIP"):
    material, nodes, image, shader = textured(s, alpha=ramp_alpha)
    image.image.colorspace_settings.name = "sRGB"
    nodes.link(image, "Alpha", shader, "Alpha")
    material.blend_method, material.alpha_threshold = method, value
    show(s, material)


def threshold_low(s):
    """alpha_threshold 0.2"""
    threshold(s, 0.2)


def threshold_half(s):
    """alpha_threshold 0.5 (the control)"""
    threshold(s, 0.5)


def threshold_high(s):
    """alpha_threshold 0.8"""
    threshold(s, 0.8)


def threshold_constant(s):
    """Constant alpha 0.6 under a threshold of 0.8: nothing"""
    material, _, shader = shader_station(s)
    shader.inputs["Alpha"].default_value = 0.6
    material.blend_method, material.alpha_threshold = "CLIP", 0.8
    show(s, material)
    s.extra["empty"] = True


# Names of materials.


def name_station(text, title):
    def build(s):
        obj = show(s, s.paint())
        obj.data.materials[0].name = text % s.code
    build.__doc__ = title
    return build


def spaces_apart(s):
    """Two names that differ in a space at the end"""
    materials = [painted(s.code + " paint", s.color), painted(s.code + " paint ", (0.1, 0.1, 0.8))]
    materials[1].name = s.code + " paint "
    mesh = s.plane(cuts=2, materials=materials)
    for polygon in mesh.polygons:
        polygon.material_index = polygon.index % 2
    s.put("plane", mesh, turn=(0, 0, 0))


def name_none(s):
    """A material called none beside an empty slot"""
    materials = [painted("none", s.color), None]
    mesh = s.plane(cuts=2, materials=materials)
    for polygon in mesh.polygons:
        polygon.material_index = polygon.index % 2
    s.put("plane", mesh, turn=(0, 0, 0))


NAMES = [
    name_station("%s trailing ", "Name with a space at its end"),
    name_station("  %s leading", "Name with spaces in front"),
    name_station("%s a\tb", "Name with a tab"),
    name_station("%s a\\b", "Name with a backslash"),
    name_station("%s a#b # c", "Name with #"),
    name_station('%s "quoted"', "Name with quotes"),
    name_station("%s größe 木", "Name beyond ASCII"),
    name_station("%s a  b", "Name with two spaces"),
    name_station("%s a\rb", "Name with a carriage return"),
    name_station("%s a\x01b", "Name with a control character"),
    name_station("%s a\u00a0b\u2028c", "Name with a no-break space and a line separator"),
    name_station("%s\u00a0", "Name that ends in a no-break space"),
    spaces_apart, name_none,
]

BACKSLASH = name_station("%s a\\", "Name that ends in a backslash")
NEWLINE = name_station("%s a\nb", "Name with a newline")

if __name__ == "__main__":
    sheet_of("nodes", "N", NODES, columns=9, tile=80).save()
    # EEVEE takes one threshold for all materials whose nodes are alike: a sheet each.
    for number, build in enumerate((threshold_low, threshold_half, threshold_high, threshold_constant)):
        sheet_of("threshold_%d" % number, "T%d" % number, [build], engine="BLENDER_EEVEE").save(mask_only=True)
    sheet_of("names", "NN", NAMES, columns=8).save()
    sheet_of("name_backslash", "NB", [BACKSLASH]).save()
    sheet_of("name_newline", "NL", [NEWLINE]).save()
