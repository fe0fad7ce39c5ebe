"""What the scripts that test the exporter share: Blender emptied, the exporter as a module, and where to write.

blender -b -P SCRIPT -- EXPORTER OUT_DIR
"""

import importlib.util
import sys

import bpy

exporter_path, out = sys.argv[sys.argv.index("--") + 1 :]
spec = importlib.util.spec_from_file_location("limn_export", exporter_path)
exporter = importlib.util.module_from_spec(spec)
spec.loader.exec_module(exporter)

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
