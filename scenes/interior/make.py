"""Makes an interior for drawings: a room with a gallery, stairs, beams and a wall of windows.   python3 scenes/interior/make.py"""

import math
import os
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(FOLDER))
from joinery import *  # noqa: E402,F403

HEADER = """# A room with a gallery. Made by make.py in this folder; metres, y up.
up = "y"

[units]
meters_per_unit = 1.0

[[camera]]
name = "room"
position = [3.0, 1.55, 4.7]
look_at = [-0.5, 1.55, -0.6]
focal_length = 22
shift = [0.0, 0.03]

[[camera]]
name = "one_point"
position = [0.2, 1.6, 6.4]
look_at = [0.2, 1.6, 0.0]
focal_length = 24

[[light]]
name = "sky"
kind = "sun"
direction = [0.8, -0.9, -0.35]
color = "#fff6e6"
intensity = 0.8
shadow = { resolution = 4096, softness = 2 }
"""

scene = Scene(FOLDER, HEADER)
M = scene.material
for name, color in (("wall", "#f3efe6"), ("boards", "#c9a274"), ("boards_dark", "#bb9264"), ("beam", "#8f6844"), ("white", "#faf8f3"), ("frame", "#4a5258"), ("glass", "#cfe1e6"), ("stone", "#c4bdb0"),
                    ("timber", "#b98d5c"), ("metal", "#4e5459"), ("cloth", "#7d8f8a"), ("cushion", "#c98f5a"), ("rug", "#a9554a"), ("rug_edge", "#e6d9bd"), ("door", "#8a3f34"), ("shutter", "#6a8577"),
                    ("board", "#cfab78"), ("leaf", "#6c8f58"), ("pot", "#b86f4f"), ("lamp", "#f4e3b4"), ("brick", "#b06a50"), ("soot", "#3a3431")):
    M(name, color)

WIDTH, DEPTH, HEIGHT = 7.2, 6.4, 4.4

# Floorboards, each a board.
for k, paint in enumerate(("boards", "boards_dark")):
    floor = Mesh()
    for i in range(k, 45, 2):
        for j in range(3):
            length = DEPTH / 3
            floor.add(block(0.158, 0.04, length - 0.003, paint), (-WIDTH / 2 + 0.16 * (i + 0.5), -0.04, -DEPTH / 2 + length * (j + 0.5)))
    scene.mesh("floor_" + paint, floor)
    scene.place("floor_" + paint, name="floorboards")

# Walls: windows at the left, stairs and gallery along the back, a chimney breast at the right.
openings = [(0.6 + 1.85 * i, 0.45, 1.5, 3.2) for i in range(3)]
scene.mesh("left_wall", wall(DEPTH, HEIGHT, 0.3, "wall", openings, "white"))
scene.place("left_wall", (-WIDTH / 2 - 0.15, 0, DEPTH / 2), 90, name="left_wall")
scene.mesh("tall_window", window(1.5, 3.2, 3, 5, sill=False))
scene.mesh("sill", block(1.6, 0.05, 0.3, "timber"))
for x, y, w, h in openings:
    scene.place("tall_window", (-WIDTH / 2 - 0.17, y, DEPTH / 2 - x), 90, name="window")
    scene.place("sill", (-WIDTH / 2 + 0.02, y - 0.05, DEPTH / 2 - x - w / 2), 90, name="sill")
scene.mesh("back_wall", wall(WIDTH, HEIGHT, 0.2, "wall", [(0.7, 2.65, 0.9, 1.75 - 0.3), (4.6, 0, 0.95, 2.1)], "white"))
scene.place("back_wall", (-WIDTH / 2, 0, -DEPTH / 2 - 0.1), name="back_wall")
scene.mesh("right_wall", wall(DEPTH, HEIGHT, 0.2, "wall"))
scene.place("right_wall", (WIDTH / 2 + 0.1, 0, DEPTH / 2), 90, name="right_wall")
skirting = block(1, 0.14, 0.02, "white")
scene.mesh("skirting", skirting)
scene.place("skirting", (-WIDTH / 2 + 2.3, 0, -DEPTH / 2 + 0.01), 0, (4.6, 1, 1), name="skirting")
scene.place("skirting", (WIDTH / 2 - 0.82, 0, -DEPTH / 2 + 0.01), 0, (1.64, 1, 1), name="skirting")
scene.place("skirting", (-WIDTH / 2 + 0.01, 0, 0), 90, (DEPTH, 1, 1), name="skirting")
panel = Mesh()
panel.add(block(0.95, 2.1, 0.05, "door"), (0, 0, 0))
for x in (-0.22, 0.22):
    for y, h in ((0.14, 0.6), (0.86, 0.5), (1.48, 0.48)):
        panel.add(box(0.32, h, 0.05, "door", 0.02, 2), (x, y, 0.025))
for x in (-0.53, 0.53):
    panel.add(block(0.11, 2.16, 0.08, "white"), (x, 0, 0.06))
panel.add(block(1.17, 0.11, 0.08, "white"), (0, 2.16, 0.06))
panel.add(ball(0.032, "metal", 16), (0.38, 1.0, 0.05))
scene.mesh("door", panel)
scene.place("door", (-WIDTH / 2 + 4.6 + 0.475, 0, -DEPTH / 2 - 0.02), name="door")

# The gallery over the back, on a beam and joists; its railing.
GALLERY, OUT = 2.5, 1.7
scene.mesh("gallery", block(WIDTH - 1.2, 0.06, OUT, "boards"))
scene.place("gallery", (-0.6, GALLERY, -DEPTH / 2 + OUT / 2), name="gallery")
joists = Mesh()
for i in range(13):
    joists.add(block(0.08, 0.18, OUT - 0.14, "beam"), (-WIDTH / 2 + 0.2 + 0.46 * i, 0, 0))
scene.mesh("joists", joists)
scene.place("joists", (0, GALLERY - 0.18, -DEPTH / 2 + OUT / 2 - 0.07), name="joist")
scene.mesh("trimmer", block(WIDTH - 1.2, 0.24, 0.14, "beam"))
scene.place("trimmer", (-0.6, GALLERY - 0.24, -DEPTH / 2 + OUT - 0.07), name="trimmer")
scene.mesh("post", box(0.16, GALLERY - 0.24, 0.16, "beam", 0.012, 1))
for x in (-1.6, 2.3):
    scene.place("post", (x, 0, -DEPTH / 2 + OUT - 0.08), name="post")
scene.mesh("gallery_rail", railing(WIDTH - 1.2, 1.0, 0.1))
scene.place("gallery_rail", (-0.6, GALLERY + 0.06, -DEPTH / 2 + OUT - 0.06), name="railing")

# Stairs along the right wall, up to the gallery.
flight = Mesh()
count = 14
going, riser = 0.25, (GALLERY + 0.06) / count
for i in range(count - 1):
    flight.add(block(0.9, 0.045, going + 0.03, "timber"), (0, riser * (i + 1) - 0.045, -going * i))
    flight.add(block(0.86, riser - 0.045, 0.02, "white"), (0, riser * i, -going * i + going / 2 - 0.02))
for side in (-0.46, 0.46):
    flight.add(prism([(-0.16, 0.0), (0.12, 0.0), (going * count, -riser * count + 0.12), (going * count, -riser * count - 0.02), (going * count - 0.3, -riser * count - 0.02), (-0.16, -0.3)], 0.05, "timber"), (side - 0.025, 0, 0), turn=90, tilt=(90, 0))
for i in range(count):
    for k in (0.0, 0.5):
        t = i + k
        flight.add(lathe([(0, 0), (0.016, 0), (0.011, 0.3), (0.018, 0.45), (0.011, 0.6), (0.014, 0.9), (0, 0.9)], "metal", 10), (-0.46, riser * t + 0.1, -going * t))
flight.add(sweep([(-0.46, riser * t + 1.02, -going * t) for t in (0, count / 2, count)], 0.028, "timber", 14))
scene.mesh("stairs", flight)
scene.place("stairs", (WIDTH / 2 - 0.62, 0, -DEPTH / 2 + going * count + 0.35), name="stairs")

# Ceiling beams and boards.
scene.mesh("ceiling", block(WIDTH, 0.04, DEPTH, "white"))
scene.place("ceiling", (0, HEIGHT, 0), name="ceiling")
scene.mesh("ceiling_beam", box(0.16, 0.22, DEPTH, "beam", 0.012, 1))
for i in range(6):
    scene.place("ceiling_beam", (-WIDTH / 2 + 0.7 + 1.16 * i, HEIGHT - 0.22, 0), name="beam")

# Furniture.
table = Mesh()
table.add(box(2.2, 0.045, 0.95, "timber", 0.008, 1), (0, 0.71, 0))
for x in (-0.98, 0.98):
    for z in (-0.38, 0.38):
        table.add(lathe([(0, 0), (0.028, 0), (0.04, 0.71), (0, 0.71)], "timber", 16), (x, 0, z))
bowl = lathe([(0, 0.0), (0.09, 0.0), (0.1, 0.02), (0.19, 0.11), (0.18, 0.115), (0.09, 0.03), (0, 0.025)], "stone", 32)
table.add(bowl, (0.2, 0.755, 0))
for x, z in ((0.15, 0.03), (0.25, -0.04), (0.22, 0.07)):
    table.add(ball(0.042, "cushion", 20), (x, 0.80, z))
scene.mesh("table", table)
scene.mesh("chair", chair())
scene.place("table", (-1.25, 0, 0.6), name="table")
for i, x in enumerate((-1.95, -1.25, -0.55)):
    scene.place("chair", (x, 0, 0.02 + 0.03 * (i % 2)), 3 * (i - 1), name="chair")
    scene.place("chair", (x, 0, 1.2 - 0.04 * (i % 2)), 180 + 4 * (1 - i), name="chair")
lampshade = Mesh()
lampshade.add(lathe([(0.2, 0.0), (0.19, 0.04), (0.06, 0.2), (0.03, 0.24), (0.02, 0.24), (0.05, 0.19), (0.18, 0.04), (0.19, 0.0)], "metal", 40))
lampshade.add(ball(0.055, "lamp", 20), (0, 0.03, 0))
lampshade.add(lathe([(0.0, 0.24), (0.006, 0.24), (0.006, 2.6), (0.0, 2.6)], "metal", 8))
scene.mesh("pendant", lampshade)
for x in (-1.95, -1.25, -0.55):
    scene.place("pendant", (x, HEIGHT - 2.6, 0.6), name="pendant")
sofa = Mesh()
sofa.add(box(2.1, 0.32, 0.9, "cloth", 0.05, 3), (0, 0.1, 0))
sofa.add(box(2.1, 0.5, 0.22, "cloth", 0.07, 3), (0, 0.38, -0.36))
for x in (-0.96, 0.96):
    sofa.add(box(0.2, 0.3, 0.88, "cloth", 0.07, 3), (x, 0.36, 0))
for x in (-0.44, 0.44):
    sofa.add(box(0.84, 0.15, 0.68, "cloth", 0.05, 3, bulge=0.03), (x, 0.42, 0.08))
for x, turn in ((-0.62, 20), (0.66, -14)):
    sofa.add(box(0.42, 0.4, 0.14, "cushion", 0.06, 3, bulge=0.03), (x, 0.58, -0.14), turn, tilt=(-18, 0))
for x in (-0.95, 0.95):
    for z in (-0.36, 0.36):
        sofa.add(block(0.06, 0.1, 0.06, "timber"), (x, 0, z))
scene.mesh("sofa", sofa)
scene.place("sofa", (-2.35, 0, -1.0), 0, name="sofa")
rug = Mesh()
rug.add(block(2.6, 0.012, 1.6, "rug_edge"), (0, 0, 0))
rug.add(block(2.4, 0.004, 1.4, "rug"), (0, 0.012, 0))
scene.mesh("rug", rug)
scene.place("rug", (-1.25, 0, 0.6), name="rug")
low = Mesh()
low.add(box(0.9, 0.04, 0.5, "timber", 0.008, 1), (0, 0.36, 0))
for x in (-0.38, 0.38):
    low.add(block(0.04, 0.36, 0.44, "timber"), (x, 0, 0))
scene.mesh("low_table", low)
scene.mesh("shelf", bookshelf())
scene.place("shelf", (-0.15, 0, -DEPTH / 2 + 0.18), name="shelf")
scene.place("shelf", (-1.45, GALLERY + 0.06, -DEPTH / 2 + 0.18), name="shelf")
scene.place("shelf", (0.3, GALLERY + 0.06, -DEPTH / 2 + 0.18), name="shelf")

# A stove before a chimney breast of brick.
stove = Mesh()
stove.add(box(0.52, 0.6, 0.42, "metal", 0.015, 2), (0, 0.16, 0))
stove.add(block(0.36, 0.34, 0.02, "soot"), (0, 0.3, 0.215))
for x in (-0.2, 0.2):
    for z in (-0.15, 0.15):
        stove.add(block(0.04, 0.16, 0.04, "metal"), (x, 0, z))
stove.add(lathe([(0, 0.76), (0.075, 0.76), (0.075, HEIGHT), (0, HEIGHT)], "metal", 24))
scene.mesh("stove", stove)
scene.place("stove", (-WIDTH / 2 + 0.55, 0, -DEPTH / 2 + OUT + 0.35), 35, name="stove")
hearth = prism([(-0.6, 0.6), (0.6, 0.6), (0.6, -0.6), (-0.6, -0.6)], 0.03, "stone")
scene.mesh("hearth", hearth)
scene.place("hearth", (-WIDTH / 2 + 0.6, 0, -DEPTH / 2 + OUT + 0.35), name="hearth")

# A plant.
plant = Mesh()
plant.add(lathe([(0, 0), (0.13, 0), (0.17, 0.3), (0.19, 0.3), (0.19, 0.34), (0.16, 0.34), (0.15, 0.28), (0, 0.28)], "pot", 32))
for i in range(17):
    turn = i * 137.5
    reach, height = 0.34 + 0.05 * (i % 4), 0.45 + 0.06 * (i % 6)
    leaf = sheet(lambda u, v, r=reach, h=height: (r * v + 0.02, 0.3 + h * math.sin(1.9 * v), (u - 0.5) * 0.14 * math.sin(math.pi * min(1.0, v + 0.06)) ), "leaf", 4, 12)
    plant.add(leaf, (0, 0, 0), turn)
scene.mesh("plant", plant)
scene.place("plant", (-WIDTH / 2 + 0.45, 0, 2.3), name="plant")
scene.place("plant", (2.4, GALLERY + 0.06, -DEPTH / 2 + 0.5), 60, 0.8, name="plant")

scene.write()
