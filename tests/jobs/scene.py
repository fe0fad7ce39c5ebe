"""A small animation for tests of whole runs: a box that turns and rests, with lines, several AOVs and formats."""

import os

BOX = """v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""

SCENE = """up = "y"
[animation]
frames = "1-{last}"
[[camera]]
name = "c"
position = [3, 2, 4]
look_at = [0, 0, 0]
fov = 45
[[mesh]]
name = "box"
file = "box.obj"
[[instance]]
mesh = "box"
rotate = {{ keys = [[1, [0, 0, 0]], [{rest}, [0, 80, 10]], [{last}, [0, 80, 10]]] }}
"""

CONFIG = """scene = "scene.toml"
[image]
size = [{width}, {height}]
samples = 2
[shading]
technique = "toon"
[ao]
technique = "gtao"
[[edges]]
technique = "depth_normal"
[output]
path = "out/box_####.{kind}"
aovs = {aovs}
"""


def make(folder, frames=6, kind="png", aovs='["beauty"]', width=96, height=64):
    """Writes it, and returns its config's path. The last third of the frames shows the same."""
    os.makedirs(folder, exist_ok=True)
    for name, text in [
        ("box.obj", BOX),
        ("scene.toml", SCENE.format(last=frames, rest=max(2, frames * 2 // 3))),
        ("config.toml", CONFIG.format(kind=kind, aovs=aovs, width=width, height=height)),
    ]:
        with open(os.path.join(folder, name), "w") as file:
            file.write(text)
    return os.path.join(folder, "config.toml")
