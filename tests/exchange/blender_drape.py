"""A drape that kesf solved (glTF or USD), imported by Blender: the size of each mesh in the scene, and what is said beside it."""

import json
import sys

import bpy
from mathutils import Vector

bpy.ops.wm.read_factory_settings(use_empty=True)
if sys.argv[1].endswith(".usda"):
    bpy.ops.wm.usd_import(filepath=sys.argv[1])
else:
    bpy.ops.import_scene.gltf(filepath=sys.argv[1])
boxes, said = {}, {}
for body in bpy.data.objects:
    said.update({key: body[key] for key in body.keys() if isinstance(body[key], (int, float, str))})
    if body.type == "MESH":
        points = [body.matrix_world @ Vector(v.co) for v in body.data.vertices]
        boxes[body.name] = [[min(p[k] for p in points) for k in range(3)], [max(p[k] for p in points) for k in range(3)]]
print("\n" + json.dumps({"boxes": boxes, "said": said}))
