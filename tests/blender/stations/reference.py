"""Renders what limn should show, by Cycles (or EEVEE where only that knows better).

blender -b SHEET.blend --python-exit-code 1 -P reference.py -- SHEET.json OUT_DIR

Mode "flat": the colour of diffuse and emission, its alpha that of the picture. "normal": normals of the world as
colours. "beauty": the picture itself. All linear, 16 bits.
"""

import json
import os
import sys

import bpy

sheet_path, out = sys.argv[sys.argv.index("--") + 1:]
with open(sheet_path, encoding="utf-8") as file:
    sheet = json.load(file)
scene = bpy.context.scene


def use_engine():
    scene.render.engine = sheet["engine"]
    if sheet["engine"] == "CYCLES":
        cycles = scene.cycles
        cycles.samples = 64 if sheet["mode"] == "beauty" else 1
        cycles.use_denoising = cycles.use_adaptive_sampling = False
        cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 0.01
        cycles.max_bounces = 0
    else:
        scene.eevee.taa_render_samples = 8
        scene.render.filter_size = 0.01


def write_linear():
    render = scene.render
    if not sheet.get("keep_film"):
        render.film_transparent = True
    render.use_motion_blur = render.use_freestyle = False
    render.dither_intensity = 0
    scene.view_settings.view_transform, scene.view_settings.look = "Raw", "None"
    scene.view_settings.gamma, scene.view_settings.exposure = 1, 0
    render.image_settings.file_format = "PNG"
    render.image_settings.color_mode, render.image_settings.color_depth = "RGBA", "16"


def compose():
    """The picture from passes."""
    layer = bpy.context.view_layer
    layer.use_pass_diffuse_color = layer.use_pass_emit = layer.use_pass_normal = True
    scene.render.use_compositing, scene.use_nodes = True, True
    tree = scene.node_tree
    tree.nodes.clear()
    passes, target = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeComposite")
    passes.layer = layer.name
    if sheet["mode"] == "normal":
        color = tree.nodes.new("CompositorNodeMixRGB")
        color.blend_type, color.inputs[0].default_value = "MULTIPLY", 1
        color.inputs[2].default_value = (0.5, 0.5, 0.5, 1)
        half = tree.nodes.new("CompositorNodeMixRGB")
        half.blend_type, half.inputs[0].default_value = "ADD", 1
        half.inputs[2].default_value = (0.5, 0.5, 0.5, 1)
        tree.links.new(passes.outputs["Normal"], color.inputs[1])
        tree.links.new(color.outputs[0], half.inputs[1])
        color = half
    else:
        color = tree.nodes.new("CompositorNodeMixRGB")
        color.blend_type, color.inputs[0].default_value = "ADD", 1
        tree.links.new(passes.outputs["DiffCol"], color.inputs[1])
        tree.links.new(passes.outputs["Emit"], color.inputs[2])
    alpha = tree.nodes.new("CompositorNodeSetAlpha")
    alpha.mode = "REPLACE_ALPHA"
    tree.links.new(color.outputs[0], alpha.inputs[0])
    tree.links.new(passes.outputs["Alpha"], alpha.inputs[1])
    tree.links.new(alpha.outputs[0], target.inputs[0])


use_engine()
write_linear()
if sheet["mode"] != "beauty":
    compose()
if not sheet.get("markers"):
    scene.camera = scene.objects[sheet["camera"]]
for frame in sheet["frames"]:
    scene.frame_set(frame)
    scene.render.filepath = os.path.join(out, "ref_%d.png" % frame)
    bpy.ops.render.render(write_still=True)
