"""Blender's own ambient occlusion:   blender -b -P eevee_ao.py -- MESH.obj "X,Y,Z" "X,Y,Z" DISTANCE SAMPLES OUT.png

Position of the camera and what it looks at (y up), 60 degrees from top to bottom at 640x360. Draws EEVEE's ambient
occlusion pass, 16 bits, linear, and prints RENDER_S: seconds of the second render, start-up excluded.
"""

import sys
import time

import bpy
from mathutils import Vector

mesh, position, target, distance, samples, output = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=mesh, forward_axis="NEGATIVE_Z", up_axis="Y")
for thing in bpy.context.scene.objects:
    thing.rotation_euler = (0, 0, 0)  # y stays up, as in the file


def point(text):
    return Vector([float(x) for x in text.split(",")])


camera = bpy.data.cameras.new("camera")
camera.sensor_fit = "VERTICAL"
camera.angle = 3.14159265358979 / 3
camera.clip_start, camera.clip_end = 0.05 * float(distance), 1000 * float(distance)
holder = bpy.data.objects.new("camera", camera)
bpy.context.collection.objects.link(holder)
back = (point(position) - point(target)).normalized()
right = Vector((0, 1, 0)).cross(back).normalized()
up = back.cross(right)
for row in range(3):
    for column, axis in enumerate((right, up, back, point(position))):
        holder.matrix_world[row][column] = axis[row]
scene = bpy.context.scene
scene.camera = holder
scene.render.engine = "BLENDER_EEVEE"
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 640, 360, 100
scene.eevee.taa_render_samples = int(samples)
scene.eevee.use_gtao = True
scene.eevee.gtao_distance = float(distance)
scene.eevee.gtao_factor = 1
scene.view_layers[0].use_pass_ambient_occlusion = True
scene.view_settings.view_transform = "Raw"
scene.use_nodes = True
nodes, links = scene.node_tree.nodes, scene.node_tree.links
layers = next(node for node in nodes if node.type == "R_LAYERS")
result = next(node for node in nodes if node.type == "COMPOSITE")
links.new(layers.outputs["AO"], result.inputs["Image"])
scene.render.image_settings.file_format = "PNG"
scene.render.image_settings.color_depth = "16"
scene.render.image_settings.color_mode = "BW"
scene.render.filepath = output
bpy.ops.render.render(write_still=True)
begin = time.time()
bpy.ops.render.render(write_still=True)
print("RENDER_S", round(time.time() - begin, 4))
