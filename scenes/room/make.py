"""Makes the living room of the paper's figures.   python3 scenes/room/make.py"""

import math
import os
import random
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(FOLDER))
from modelling import *  # noqa: E402,F403

HEADER = """# A living room. Made by make.py in this folder; metres, y up.
up = "y"

[units]
meters_per_unit = 1.0

[[camera]]
name = "corner"
position = [2.45, 1.62, 3.55]
look_at = [-0.35, 0.86, -0.6]
focal_length = 27

[[camera]]
name = "sofa"
position = [1.2, 1.25, 1.6]
look_at = [-0.9, 0.55, -1.2]
focal_length = 35

[[light]]
name = "window sun"
kind = "sun"
direction = [0.72, -0.80, -0.42]
color = "#fff1d8"
intensity = 0.72
shadow = { resolution = 4096, softness = 1.5 }

[[light]]
name = "lamp"
kind = "point"
position = [1.52, 1.50, -1.28]
color = "#ffd9a0"
intensity = 0.38
range = 1.1
"""

scene = Scene(FOLDER, HEADER)
M = scene.material
M("planks", "#ffffff", "planks.png")
M("rug", "#ffffff", "rug.png")
M("painting", "#ffffff", "painting.png")
M("wall", "#dcd3bd")
M("side_wall", "#cfd6cb")
M("white", "#f1ece0")
M("sofa", "#4f7d84")
M("sofa_dark", "#3f666d")
M("cushion_red", "#c0563f")
M("cushion_yellow", "#dcb04c")
M("armchair", "#b5683f")
M("oak", "#a87644")
M("walnut", "#6d482c")
M("shade", "#f3dfae")
M("brass", "#c49a45", shininess=60, specular=0.6)
M("leaf", "#4f7f45")
M("leaf_light", "#6f9c52")
M("pot", "#c96f4a")
M("soil", "#4b362a")
M("curtain", "#b9502f")
M("glass", "#bcd7e2", shininess=120, specular=0.8)
M("ceramic", "#3d6b94", shininess=70, specular=0.5)
M("paper", "#efe6d2")
M("metal", "#8d9298", shininess=100, specular=0.7)
for name, color in (("book_a", "#94403a"), ("book_b", "#3b5a7c"), ("book_c", "#5b7c55"), ("book_d", "#c49a45"), ("book_e", "#5c4a6b"), ("book_f", "#d8cdb4")):
    M(name, color)

write_png(os.path.join(FOLDER, "planks.png"), 512, 512, planks("#7a5233", "#ab7b4c", 6, 9))


def rug_pattern(u, v):
    border = min(u, 1 - u, v * 0.72, (1 - v) * 0.72)
    if border < 0.035:
        return hex_color("#7c2f2a")
    if border < 0.075:
        return hex_color("#e2cfa3") if (int((u + v) * 60) % 2) else hex_color("#b5503f")
    if border < 0.09:
        return hex_color("#2f4a5e")
    a, b = (u - 0.5) * 10, (v - 0.5) * 7
    diamond = (abs(a % 2 - 1) + abs(b % 2 - 1)) % 1
    if diamond < 0.12:
        return hex_color("#e2cfa3")
    if diamond > 0.8:
        return hex_color("#2f4a5e")
    return hex_color("#a5463a")


write_png(os.path.join(FOLDER, "rug.png"), 384, 288, rug_pattern)


def landscape(u, v):
    """Hills under an evening sky."""
    far = 0.52 + 0.08 * math.sin(5 * u + 1) + 0.05 * noise(u * 6, 2)
    near = 0.34 + 0.10 * math.sin(3.3 * u + 3.4) + 0.04 * noise(u * 9, 7)
    sun = math.hypot((u - 0.68) * 1.4, v - 0.68)
    if v < near:
        return mix(hex_color("#2f5233"), hex_color("#5f8a48"), v / near)
    if v < far:
        return mix(hex_color("#5b7f78"), hex_color("#93ab8f"), (v - near) / (far - near))
    if sun < 0.085:
        return hex_color("#fbe8b0")
    return mix(hex_color("#f0b36b"), hex_color("#7fa8c4"), min(1, (v - far) / 0.4))


write_png(os.path.join(FOLDER, "painting.png"), 320, 224, landscape)

# The shell: floor, back wall with a window opening, side wall, skirting, ceiling rail.
scene.mesh("floor", box(5.2, 0.1, 4.6, "planks", 0.004, 1, uv=0.55))
scene.place("floor", (0, -0.1, 0.2))
# One surface around the window opening: joints between boxes would draw lines of their own.
back = Mesh()
xs, ys = (-2.6, -0.45, 0.95, 2.6), (0.0, 0.85, 2.25, 2.7)
for i in range(3):
    for j in range(3):
        if (i, j) != (1, 1):
            back.grid([[(x, y, 0.06) for x in xs[i : i + 2]] for y in ys[j : j + 2]], "wall")
reveal = [(xs[1], ys[1]), (xs[2], ys[1]), (xs[2], ys[2]), (xs[1], ys[2]), (xs[1], ys[1])]
back.grid([[(x, y, z) for x, y in reveal] for z in (0.06, -0.06)], "white")
scene.mesh("back_wall", back)
scene.place("back_wall", (0, 0, -2.0))
scene.mesh("left_wall", box(0.12, 2.7, 4.0, "side_wall", 0.003, 1))
scene.place("left_wall", (-2.6, 0, -0.06))
skirting_profile = [(0, 0), (0.018, 0), (0.018, 0.075), (0.012, 0.085), (0.009, 0.1), (0, 0.105)]
skirting = Mesh().grid([[(x, y, z) for x in (-2.54, 2.6)] for z, y in skirting_profile], "white")
scene.mesh("skirting", skirting)
scene.place("skirting", (0, 0, -1.94))
scene.place("skirting", (-2.54, 0, -0.06), (0, 90, 0), (0.73, 1, 1), name="side skirting")
scene.mesh("cornice", Mesh().grid([[(x, y, z) for x in (-2.54, 2.6)] for z, y in [(0, 0), (0.02, 0.0), (0.03, 0.02), (0.06, 0.05), (0.08, 0.09), (0.08, 0.11), (0, 0.11)]], "white"))
scene.place("cornice", (0, 2.58, -1.94))

# Window: frame, mullions, sill, glass behind, curtains on a rod.
window = Mesh()
window.add(box(0.07, 1.4, 0.10, "white", 0.008, 2), (-0.415, 0, 0)).add(box(0.07, 1.4, 0.10, "white", 0.008, 2), (0.915, 0, 0))
window.add(box(1.38, 0.07, 0.10, "white", 0.008, 2), (0.25, 0, 0)).add(box(1.38, 0.07, 0.10, "white", 0.008, 2), (0.25, 1.33, 0))
window.add(box(0.05, 1.3, 0.07, "white", 0.008, 2), (0.25, 0.05, 0))
for y in (0.50, 0.93):
    window.add(box(1.3, 0.032, 0.05, "white", 0.006, 2), (0.25, y, 0))
window.add(box(1.6, 0.045, 0.24, "white", 0.012, 3), (0.25, -0.045, 0.06))
scene.mesh("window", window)
scene.place("window", (0, 0.85, -1.98))
scene.mesh("pane", box(1.36, 1.38, 0.01, "glass", 0.002, 1))
scene.place("pane", (0.25, 0.86, -2.03))


def curtain(u, v):
    fold = 0.035 * math.sin(u * 2 * math.pi * 5.0) * (0.55 + 0.45 * (1 - v))
    return ((u - 0.5) * (0.50 + 0.05 * (1 - v)), 0.012 + v * 2.03, fold)


scene.mesh("curtain", sheet(curtain, "curtain", 80, 10, 0.0))
scene.place("curtain", (-0.72, 0.12, -1.83))
scene.place("curtain", (1.22, 0.12, -1.83), (0, 180, 0))
rod = Mesh().add(sweep([(-1.15, 0, 0), (0, 0, 0), (1.15, 0, 0)], 0.014, "brass", 16)).add(ball(0.032, "brass", 24), (-1.16, -0.032, 0)).add(ball(0.032, "brass", 24), (1.16, -0.032, 0))
scene.mesh("rod", rod)
scene.place("rod", (0.25, 2.17, -1.83))

# Sofa against the left part of the back wall.
sofa = Mesh()
sofa.add(box(2.0, 0.20, 0.86, "sofa_dark", 0.04, 4), (0, 0.12, 0)).add(box(2.0, 0.62, 0.24, "sofa", 0.09, 5), (0, 0.20, -0.34))
for x in (-0.93, 0.93):
    sofa.add(box(0.24, 0.48, 0.88, "sofa", 0.09, 5), (x, 0.14, 0.01))
for x in (-0.9, 0.9):
    for z in (-0.35, 0.36):
        sofa.add(lathe([(0, 0), (0.016, 0), (0.026, 0.12), (0, 0.12)], "walnut", 20), (x, 0, z))
scene.mesh("sofa", sofa)
scene.mesh("seat", box(0.80, 0.17, 0.66, "sofa", 0.05, 4, bulge=0.018))
scene.mesh("rest", box(0.78, 0.40, 0.17, "sofa", 0.06, 4, bulge=0.02))
scene.place("sofa", (-1.15, 0, -1.40))
for x in (-0.41, 0.41):
    scene.place("seat", (-1.15 + x, 0.31, -1.31))
    scene.place("rest", (-1.15 + x, 0.44, -1.53), (-12, 0, 0))
scene.mesh("pillow", box(0.42, 0.42, 0.08, "cushion_red", 0.035, 4, bulge=0.05))
scene.place("pillow", (-1.80, 0.475, -1.28), (-22, 24, 6))
scene.place("pillow", (-0.50, 0.475, -1.28), (-24, -20, -5), material="cushion_yellow")
scene.place("pillow", (-0.72, 0.47, -1.16), (-34, -8, 4), 0.86)

# Armchair.
chair = Mesh()
chair.add(box(0.74, 0.18, 0.74, "armchair", 0.05, 4), (0, 0.16, 0)).add(box(0.72, 0.62, 0.17, "armchair", 0.075, 5, bulge=0.02), (0, 0.28, -0.30), tilt=(-10, 0))
for x in (-0.36, 0.36):
    chair.add(box(0.15, 0.40, 0.72, "armchair", 0.07, 5), (x, 0.20, 0))
    for z in (-0.28, 0.28):
        chair.add(lathe([(0, 0), (0.014, 0), (0.022, 0.16), (0, 0.16)], "walnut", 18), (x * 0.86, 0, z))
chair.add(box(0.56, 0.13, 0.60, "armchair", 0.045, 4, bulge=0.02), (0, 0.33, 0.04))
scene.mesh("armchair", chair)
scene.place("armchair", (1.10, 0, 0.30), -112)

# Coffee table on the rug.
scene.mesh("rug", Mesh().grid([[(x, 0.012, -z) for x in (-1.15, 1.15)] for z in (-0.85, 0.85)], "rug").add(box(2.3, 0.011, 1.7, "walnut", 0.004, 1)))
scene.place("rug", (-0.70, 0.001, -0.02), 3)
table = Mesh().add(box(1.05, 0.035, 0.56, "oak", 0.012, 3), (0, 0.385, 0)).add(box(0.92, 0.02, 0.44, "oak", 0.006, 2), (0, 0.16, 0))
for x in (-0.46, 0.46):
    for z in (-0.22, 0.22):
        table.add(lathe([(0, 0), (0.015, 0), (0.019, 0.02), (0.026, 0.385), (0, 0.385)], "walnut", 20), (x, 0, z))
scene.mesh("coffee_table", table)
scene.place("coffee_table", (-0.78, 0.013, -0.22), 3)
mug = lathe([(0, 0.004), (0.030, 0.0), (0.036, 0.004), (0.037, 0.088), (0.0355, 0.09), (0.033, 0.088), (0.032, 0.012), (0, 0.010)], "ceramic", 36).add(sweep(spline([(0.035, 0.075, 0), (0.062, 0.07, 0), (0.062, 0.03, 0), (0.035, 0.02, 0)], 7), 0.005, "ceramic", 12))
scene.mesh("mug", mug)
scene.place("mug", (-0.52, 0.433, -0.12), 40)
scene.place("mug", (-0.62, 0.433, -0.35), -70, material="white")
bowl = lathe([(0, 0.004), (0.05, 0.0), (0.055, 0.004)] + spline([(0.06, 0.008), (0.11, 0.03), (0.14, 0.068)], 7) + [(0.137, 0.071)] + [(r - 0.005, y + 0.003) for r, y in reversed(spline([(0.06, 0.008), (0.11, 0.03), (0.137, 0.066)], 7))] + [(0, 0.012)], "white", 48)
scene.mesh("bowl", bowl)
scene.place("bowl", (-0.98, 0.433, -0.20))
scene.mesh("fruit", ball(0.042, "cushion_yellow", 28, 1.0, 0.92))
for x, y, z, m in ((-1.02, 0.455, -0.22, None), (-0.945, 0.455, -0.225, "book_a"), (-0.98, 0.46, -0.16, "leaf_light")):
    scene.place("fruit", (x, y, z), material=m)


def book(width, height, depth, cover):
    mesh = Mesh()
    mesh.add(box(width * 0.12, height, depth, cover, width * 0.04, 2), (-width * 0.44, 0, 0)).add(box(width * 0.12, height, depth, cover, width * 0.04, 2), (width * 0.44, 0, 0))
    mesh.add(box(width, height, 0.006, cover, 0.0025, 2), (0, 0, depth / 2 - 0.003)).add(box(width * 0.8, height - 0.008, depth - 0.01, "paper", 0.001, 1), (0, 0.004, -0.004))
    return mesh


# Bookshelf with rows of books, between window and corner.
shelf = Mesh()
for x in (-0.48, 0.48):
    shelf.add(box(0.03, 1.9, 0.30, "walnut", 0.005, 2), (x, 0, 0))
for y in (0.06, 0.42, 0.79, 1.16, 1.53, 1.87):
    shelf.add(box(0.94, 0.025, 0.29, "walnut", 0.004, 2), (0, y, 0))
shelf.add(box(0.96, 1.88, 0.012, "oak", 0.002, 1), (0, 0.01, -0.142))
scene.mesh("bookshelf", shelf)
scene.place("bookshelf", (2.05, 0, -1.77))
random.seed(5)
covers = ["book_a", "book_b", "book_c", "book_d", "book_e", "book_f"]
sizes = [(0.026, 0.23, 0.17), (0.038, 0.26, 0.19), (0.020, 0.21, 0.15), (0.046, 0.28, 0.20)]
for i, size in enumerate(sizes):
    scene.mesh("book%d" % (i + 1), book(*size, "book_a"))
for y in (0.085, 0.445, 0.815, 1.185, 1.555):
    x = -0.455
    stop = random.uniform(0.15, 0.44)
    while x < stop:
        i = random.randrange(4)
        width = sizes[i][0]
        lean = 0
        scene.place("book%d" % (i + 1), (2.05 + x + width / 2, y, -1.77 + 0.02), (0, 0, lean), material=None if False else random.choice(covers))
        x += width + 0.0015
    if stop < 0.3:
        for k in range(random.randrange(1, 4)):
            scene.place("book1", (2.05 + 0.42, y + 0.0135 + 0.028 * k, -1.76), (0, 0, 90), material=covers[(k + 2) % 6])

# Floor lamp, side table with a plant, pictures, clock, big plant, ceiling lamp, basket.
lamp = Mesh().add(lathe([(0, 0), (0.14, 0), (0.145, 0.008), (0.13, 0.02), (0.02, 0.03), (0, 0.03)], "brass", 40)).add(sweep([(0, 0.02, 0), (0, 0.8, 0), (0, 1.62, 0)], 0.011, "brass", 14))
lamp.add(lathe([(0.235, 1.36), (0.145, 1.68), (0.142, 1.68), (0.231, 1.362), (0.235, 1.36)], "shade", 56)).add(ball(0.045, "white", 24), (0, 1.46, 0))
scene.mesh("floor_lamp", lamp)
scene.place("floor_lamp", (1.40, 0, -1.20))
side = Mesh().add(lathe([(0, 0.50), (0.225, 0.50), (0.235, 0.508), (0.235, 0.522), (0.228, 0.53), (0, 0.53)], "oak", 48)).add(lathe([(0, 0), (0.16, 0), (0.165, 0.01), (0.03, 0.035), (0.022, 0.06), (0.022, 0.5), (0, 0.5)], "walnut", 36))
scene.mesh("side_table", side)
scene.place("side_table", (0.15, 0, -1.50))


def blade(u, v):
    width = math.sin(math.pi * (v * 0.94 + 0.04)) ** 0.75
    return ((u - 0.5) * 0.11 * width, 0.34 * v - 0.30 * v * v - 0.06 * width * (0.5 - abs(u - 0.5)), -0.42 * v)


plant = Mesh()
plant.add(lathe([(0, 0), (0.10, 0), (0.105, 0.006), (0.145, 0.22), (0.155, 0.222), (0.155, 0.26), (0.140, 0.262), (0.136, 0.23), (0, 0.225)], "pot", 44)).add(lathe([(0.137, 0.232), (0, 0.238)], "soil", 32))
for i in range(15):
    plant.add(sheet(blade, "leaf" if i % 3 else "leaf_light", 8, 14, 0.002), (0.02 * math.cos(i), 0.235, 0.02 * math.sin(i)), turn=i * 137.5, scale=0.75 + 0.4 * ((i * 7) % 5) / 5, tilt=(34 * ((i * 3) % 4) / 4, 0))
scene.mesh("plant", plant)
scene.place("plant", (-2.18, 0, 0.78), 20, 1.25)
scene.place("plant", (0.15, 0.53, -1.52), 70, 0.48)


def frame(width, height, content):
    mesh = Mesh()
    for x in (-1, 1):
        mesh.add(box(0.045, height, 0.03, "walnut", 0.009, 3), (x * (width / 2 - 0.0225), 0, 0))
    for y in (0, height - 0.045):
        mesh.add(box(width - 0.02, 0.045, 0.03, "walnut", 0.009, 3), (0, y, 0))
    mesh.add(box(width - 0.06, height - 0.06, 0.012, "paper", 0.002, 1), (0, 0.03, -0.004))
    inset = 0.10
    mesh.grid([[(x, y, 0.0035) for x in (-width / 2 + inset, width / 2 - inset)] for y in (inset, height - inset)], content)
    return mesh


scene.mesh("landscape", frame(0.95, 0.70, "painting"))
scene.place("landscape", (-1.72, 1.28, -1.92))
scene.mesh("portrait", frame(0.42, 0.52, "cushion_red"))
scene.place("portrait", (-2.52, 1.35, -0.55), (0, 90, 0))
scene.place("portrait", (-2.52, 1.35, 0.08), (0, 90, 0), material=None, name="second portrait")
clock = Mesh().add(lathe([(0, 0.0), (0.15, 0.0), (0.156, 0.01), (0.150, 0.03), (0.138, 0.034), (0.134, 0.022), (0, 0.022)], "walnut", 56)).add(lathe([(0.134, 0.0225), (0, 0.0226)], "white", 56))
clock.add(box(0.008, 0.003, 0.09, "metal", 0.001, 1), (0, 0.024, -0.04)).add(box(0.010, 0.003, 0.06, "metal", 0.001, 1), (0.022, 0.027, 0.012), turn=62)
scene.mesh("clock", clock)
scene.place("clock", (-2.54, 2.05, -0.24), (0, 0, -90))
pendant = Mesh().add(sweep([(0, 0.30, 0), (0, 0.6, 0), (0, 0.95, 0)], 0.006, "metal", 10)).add(lathe(spline([(0.26, 0.0), (0.24, 0.08), (0.14, 0.22), (0.03, 0.28), (0.0, 0.30)], 8) + [(0.0, 0.292)] + list(reversed(spline([(0.25, 0.002), (0.23, 0.08), (0.13, 0.215), (0.03, 0.275)], 8))), "ceramic", 56))
scene.mesh("pendant", pendant)
scene.place("pendant", (-0.70, 1.95, 0.0))
basket = lathe([(0, 0.0), (0.15, 0.0)] + [(0.155 + 0.03 * math.sin(math.pi * y / 0.3) + (0.006 if k % 2 else 0), y) for k, y in enumerate([0.3 * i / 16 for i in range(17)])] + [(0.145, 0.30), (0.15, 0.02), (0, 0.015)], "oak", 40)
scene.mesh("basket", basket)
scene.place("basket", (1.95, 0, -0.95))
scene.mesh("stool", Mesh().add(box(0.46, 0.20, 0.46, "cushion_yellow", 0.07, 5, bulge=0.03), (0, 0.18, 0)).add(box(0.36, 0.05, 0.36, "walnut", 0.01, 2), (0, 0.13, 0)).add(lathe([(0, 0), (0.02, 0), (0.03, 0.14), (0, 0.14)], "walnut", 18), (-0.15, 0, -0.15)).add(lathe([(0, 0), (0.02, 0), (0.03, 0.14), (0, 0.14)], "walnut", 18), (0.15, 0, -0.15)).add(lathe([(0, 0), (0.02, 0), (0.03, 0.14), (0, 0.14)], "walnut", 18), (-0.15, 0, 0.15)).add(lathe([(0, 0), (0.02, 0), (0.03, 0.14), (0, 0.14)], "walnut", 18), (0.15, 0, 0.15)))
scene.place("stool", (0.15, 0, 0.75), 24)

scene.write()
