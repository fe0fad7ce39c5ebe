"""Two libraries that other sheets link from, with the same names for different things.

blender -b --factory-startup --python-exit-code 1 -P make_libraries.py
"""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stationlib import *  # noqa: F401,F403 - a small language for these files


def add(name, data, at=(0, 0, 0), turn=TURN, into=None):
    obj = bpy.data.objects.new(name, data)
    obj.location, obj.rotation_euler = at, turn
    (into or bpy.context.scene.collection).objects.link(obj)
    return obj


def settings():
    """What linked objects must be rendered with."""
    paint = painted("Lib paint", (0.1, 0.5, 0.7))
    subsurf(add("Lib rounded", cube_mesh("Lib rounded", materials=[paint])), 0, 3)
    modifier(add("Lib arrayed", cube_mesh("Lib arrayed", 0.6, [paint])), "ARRAY", count=3, show_viewport=False)
    group = bpy.data.collections.new("Lib settings")
    bpy.context.scene.collection.children.link(group)
    subsurf(add("Lib group rounded", cube_mesh("Lib group rounded", 0.8, [paint]), (-0.7, 0, 0.6), into=group), 0, 3)
    add("Lib group hidden", cube_mesh("Lib group hidden", 0.7, [paint]), (0.7, 0, 0.6), into=group).hide_render = True
    screen = add("Lib group screen", cube_mesh("Lib group screen", 0.7, [paint]), (0.7, 0, -0.6), into=group)
    screen.hide_viewport = True
    arrayed = add("Lib group arrayed", cube_mesh("Lib group arrayed", 0.4, [paint]), (-0.9, 0, -0.6), into=group)
    modifier(arrayed, "ARRAY", count=2, show_viewport=False)


def groups(color):
    """A group of shader nodes with an RGB inside, and one with a whole shader."""
    tree = bpy.data.node_groups.new("Lib colour", "ShaderNodeTree")
    tree.outputs.new("NodeSocketColor", "Color")
    nodes = Nodes(tree)
    out, rgb = nodes.new("NodeGroupOutput"), nodes.new("ShaderNodeRGB")
    rgb.outputs[0].default_value = (*color, 1)
    nodes.link(rgb, 0, out, 0)
    tree = bpy.data.node_groups.new("Lib shader", "ShaderNodeTree")
    tree.outputs.new("NodeSocketShader", "Shader")
    nodes = Nodes(tree)
    out, shader = nodes.new("NodeGroupOutput"), nodes.new("ShaderNodeBsdfPrincipled")
    shader.inputs["Base Color"].default_value = (*color, 1)
    nodes.link(shader, 0, out, 0)
    for tree in bpy.data.node_groups:
        tree.use_fake_user = True


def twins(color, shape):
    """Things whose names both libraries and the file share."""
    paint = painted("Twin paint", color)
    paint.use_fake_user = True
    add("Twin", shape("Twin mesh", materials=[paint]))
    modifier(add("Twin modified", shape("Twin modified mesh", materials=[paint])), "TRIANGULATE")
    add("Twin plain", cube_mesh("Twin plain mesh %s" % shape.__name__, 0.8, [paint]))


def library(name, color, shape):
    reset()
    settings()
    groups(color)
    twins(color, shape)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(BLENDS, name + ".blend"))


os.makedirs(BLENDS, exist_ok=True)
library("lib_a", (0.1, 0.6, 0.1), lambda name, materials: sphere_mesh(name, 0.6, materials))
library("lib_b", (0.1, 0.1, 0.8), lambda name, materials: cone_mesh(name, 0.6, 1.2, materials))
