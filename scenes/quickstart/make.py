"""Makes the quickstart's scene: a breakfast table by a wall.   python3 scenes/quickstart/make.py"""

import math
import os
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(FOLDER))
from modelling import *  # noqa: E402,F403

HEADER = """# A breakfast table. Made by make.py in this folder; metres, y up.
up = "y"

[units]
meters_per_unit = 1.0

[[camera]]
name = "table"
position = [0.17, 0.56, 1.50]
look_at = [-0.03, 0.150, 0.0]
focal_length = 50

[[camera]]
name = "close"
position = [-0.34, 0.30, 0.62]
look_at = [-0.16, 0.09, 0.06]
focal_length = 50

[[light]]
name = "morning sun"
kind = "sun"
direction = [0.62, -0.85, -0.62]
color = "#fff3dc"
intensity = 0.78
shadow = { resolution = 2048, softness = 1.5 }
"""

scene = Scene(FOLDER, HEADER)
M = scene.material
M("wood", "#ffffff", "wood.png")
M("cloth", "#ffffff", "cloth.png")
M("wall", "#d9cfbc")
M("rail", "#efe8da")
M("porcelain", "#f2ede1", shininess=90, specular=0.55)
M("teal", "#2f7f86", shininess=70, specular=0.5)
M("blue", "#3a5f93", shininess=60, specular=0.35)
M("apple", "#c23b2e", shininess=50, specular=0.45)
M("pear", "#a9ad3f", shininess=30, specular=0.25)
M("orange", "#e08a2b")
M("stem", "#5a4327")
M("leaf", "#5d8a45")
M("petal", "#e9b949")
M("heart", "#8a4d24")
M("bread", "#c98b4a")
M("crumb", "#ecd3a4")
M("metal", "#b9bcc2", shininess=120, specular=0.8)
M("wax", "#f1e2b8")
M("flame", "#ffb53a")
M("jam", "#8f1f35", shininess=60, specular=0.6)
M("tea", "#8a4a1c", shininess=90, specular=0.5)
M("red_cover", "#9c3f38")
M("green_cover", "#49695a")
M("navy_cover", "#34466b")
M("paper", "#efe6d2")
M("sugar", "#f7f4ec")
M("butter", "#f0d873")

write_png(os.path.join(FOLDER, "wood.png"), 512, 512, planks("#8a5a34", "#c08a55", 5, 3))


def checks(u, v):
    """A woven check in two blues."""
    a, b = int(u * 8) % 2, int(v * 8) % 2
    weave = 0.03 * ((int(u * 256) + int(v * 256)) % 2)
    return tuple(c - weave for c in (hex_color("#f3eee2"), hex_color("#9db4c8"), hex_color("#5b7fa3"))[a + b])


write_png(os.path.join(FOLDER, "cloth.png"), 256, 256, checks)

# The table, and the wall behind it.
top = box(1.9, 0.05, 1.05, "wood", 0.012, 3, uv=0.9)
scene.mesh("table", top)
scene.place("table", (0, -0.05, 0))


def drape(u, v):
    x, z = (u - 0.5) * 1.02, (v - 0.5) * 0.74
    y = 0.0035 + 0.0012 * math.sin(9 * x + 4 * z) * math.sin(11 * z)
    edge = min(min(u, 1 - u), min(v, 1 - v))
    return (x, y - 0.0022 * max(0, 1 - edge / 0.02), -z)


cloth = Mesh()
columns, rows = 48, 36
points = [[drape(i / columns, j / rows) for i in range(columns + 1)] for j in range(rows + 1)]
cloth.grid(points, "cloth", [[(i / columns * 2.8, j / rows * 2.0) for i in range(columns + 1)] for j in range(rows + 1)])
scene.mesh("cloth", cloth)
scene.place("cloth", (0, 0, 0.03), 4)

scene.mesh("wall", box(3.0, 1.7, 0.1, "wall", 0.01, 1))
scene.place("wall", (0, -0.75, -0.75))
rail = Mesh()
profile = [(0, 0), (0.012, 0), (0.02, 0.008), (0.02, 0.02), (0.014, 0.03), (0.014, 0.042), (0.006, 0.05), (0, 0.052)]
rail.grid([[(x, y, z) for x in (-1.5, 1.5)] for z, y in profile], "rail")
scene.mesh("rail", rail)
scene.place("rail", (0, 0.30, -0.70))

# Teapot: body, lid, knob, spout, handle.
pot = Mesh()
pot.add(lathe([(0, 0.0), (0.045, 0.0), (0.052, 0.003), (0.053, 0.008)] + spline([(0.056, 0.012), (0.083, 0.045), (0.088, 0.078), (0.072, 0.112), (0.047, 0.128)], 7) + [(0.045, 0.131), (0.041, 0.131)], "teal", 56))
pot.add(lathe([(0.0455, 0.1315)] + spline([(0.045, 0.134), (0.034, 0.145), (0.014, 0.152), (0.008, 0.154)], 5) + spline([(0.008, 0.155), (0.0145, 0.163), (0.011, 0.172), (0.0, 0.175)], 5), "teal", 48))
spout = spline([(0.07, 0.045, 0), (0.108, 0.062, 0), (0.126, 0.098, 0), (0.15, 0.124, 0)], 9)
pot.add(sweep(spout, [0.022 - 0.0145 * (i / (len(spout) - 1)) ** 0.7 for i in range(len(spout))], "teal", 24))
pot.add(sweep(spline([(-0.062, 0.112, 0), (-0.105, 0.125, 0), (-0.132, 0.09, 0), (-0.112, 0.05, 0), (-0.072, 0.036, 0)], 8), 0.0078, "teal", 16))
scene.mesh("teapot", pot)
scene.place("teapot", (-0.26, 0.004, -0.10), 24)

# Cup with tea, and saucer.
cup = Mesh()
outside = [(0, 0.004), (0.02, 0.004), (0.022, 0.0), (0.025, 0.0), (0.0255, 0.006)] + spline([(0.027, 0.01), (0.040, 0.034), (0.0435, 0.062)], 8)
inside = [(0.0425, 0.0635), (0.041, 0.0625)] + [(r - 0.003, y) for r, y in reversed(spline([(0.027, 0.012), (0.040, 0.034), (0.0435, 0.062)], 8))] + [(0.018, 0.012), (0, 0.011)]
cup.add(lathe(outside + inside, "porcelain", 48))
cup.add(lathe([(0.0386, 0.0505), (0, 0.0505)], "tea", 48))
cup.add(sweep(spline([(0.0405, 0.05, 0), (0.06, 0.055, 0), (0.066, 0.036, 0), (0.052, 0.02, 0), (0.034, 0.018, 0)], 8), 0.0036, "porcelain", 14))
scene.mesh("cup", cup)
saucer = lathe([(0, 0.002), (0.026, 0.002), (0.028, 0.0), (0.031, 0.0), (0.033, 0.003)] + spline([(0.036, 0.0045), (0.058, 0.0095), (0.071, 0.0155)], 6) + [(0.0715, 0.017), (0.070, 0.0175)] + [(r, y + 0.003) for r, y in reversed(spline([(0.036, 0.0045), (0.058, 0.0095), (0.069, 0.0145)], 6))] + [(0.027, 0.006), (0, 0.006)], "porcelain", 56)
scene.mesh("saucer", saucer)
for x, z, turn in ((0.045, 0.155, -28), (-0.20, 0.21, 205)):
    scene.place("saucer", (x, 0.004, z))
    scene.place("cup", (x, 0.010, z), turn)

# Spoon.
spoon = Mesh()
spoon.add(sweep(spline([(0.018, 0.0045, 0), (0.05, 0.007, 0), (0.10, 0.0095, 0), (0.13, 0.007, 0)], 8), [0.0022 + 0.0018 * (i / 24) ** 2 for i in range(25)], "metal", 12))
spoon.add(sheet(lambda u, v: (0.02 * math.cos(2 * math.pi * u) * v, 0.006 - 0.006 * (1 - v * v), -0.0135 * math.sin(2 * math.pi * u) * v), "metal", 28, 7, 0.0012))
scene.mesh("spoon", spoon)
scene.place("spoon", (0.108, 0.0145, 0.185), (0, -62, 0))
scene.place("spoon", (-0.115, 0.006, 0.29), (0, 10, 0), 1.2, name="table spoon")

# Fruit bowl.
bowl_out = [(0, 0.0), (0.045, 0.0), (0.048, 0.004), (0.046, 0.012)] + spline([(0.05, 0.016), (0.09, 0.034), (0.118, 0.072)], 8)
bowl_in = [(0.1185, 0.0745), (0.116, 0.0745)] + [(r - 0.005, y + 0.002) for r, y in reversed(spline([(0.05, 0.018), (0.09, 0.036), (0.118, 0.072)], 8))] + [(0.03, 0.016), (0, 0.015)]
scene.mesh("bowl", lathe(bowl_out + bowl_in, "blue", 64))
scene.place("bowl", (0.27, 0.004, -0.10))
round_profile = [(0.0, 0.010), (0.008, 0.006), (0.016, 0.001), (0.024, 0.0)] + spline([(0.027, 0.001), (0.0375, 0.022), (0.0385, 0.043), (0.030, 0.061), (0.016, 0.066)], 6) + [(0.008, 0.062), (0.003, 0.055), (0, 0.053)]
apple = Mesh().add(lathe(round_profile, "apple", 40))
apple.add(sweep(spline([(0, 0.052, 0), (0.002, 0.066, 0), (0.007, 0.077, 0.002)], 5), [0.0016] * 11, "stem", 8))
scene.mesh("apple", apple)
pear = Mesh().add(lathe([(0, 0.004), (0.012, 0.0)] + spline([(0.016, 0.001), (0.036, 0.022), (0.033, 0.044), (0.020, 0.064), (0.015, 0.082), (0.007, 0.09)], 6) + [(0.0, 0.091)], "pear", 40))
pear.add(sweep(spline([(0, 0.088, 0), (0.001, 0.1, 0), (-0.006, 0.112, 0)], 5), 0.0015, "stem", 8))
scene.mesh("pear", pear)
orange = Mesh().add(ball(0.036, "orange", 40, 1.0, 0.94)).add(lathe([(0.005, 0.0668), (0.003, 0.0685), (0, 0.0688)], "stem", 10))
scene.mesh("orange", orange)
scene.place("apple", (0.228, 0.034, -0.092), (8, 30, -12))
scene.place("orange", (0.288, 0.036, -0.052), (14, 0, 10))
scene.place("pear", (0.315, 0.034, -0.125), (10, 60, -24))
scene.place("orange", (0.255, 0.040, -0.150), (-12, 0, 20))
scene.place("apple", (0.268, 0.077, -0.105), (-10, 130, 9))
scene.place("apple", (0.085, 0.004, 0.005), (0, 75, 0))
scene.place("pear", (0.395, 0.002, 0.11), (0, 20, 84))

# Vase with flowers.
vase = lathe([(0, 0.0), (0.036, 0.0), (0.039, 0.004)] + spline([(0.04, 0.006), (0.058, 0.06), (0.05, 0.115), (0.026, 0.155), (0.024, 0.178), (0.033, 0.195)], 8) + [(0.0335, 0.197), (0.031, 0.197)] + [(0.022, 0.18), (0.020, 0.16), (0.0, 0.155)], "porcelain", 56)
scene.mesh("vase", vase)
scene.place("vase", (-0.005, 0.002, -0.22))


def petal(u, v):
    width = math.sin(math.pi * min(1, v * 0.93 + 0.07)) ** 0.7
    return ((u - 0.5) * 0.030 * width, 0.006 * math.sin(math.pi * v) + 0.010 * v * v - 0.02 * (u - 0.5) ** 2, -0.012 - 0.036 * v)


flower = Mesh()
for i in range(11):
    flower.add(sheet(petal, "petal", 6, 9, 0.0006), turn=i * 360 / 11)
for i in range(9):
    flower.add(sheet(petal, "petal", 6, 9, 0.0006), turn=i * 40 + 17, scale=0.78, move=(0, 0.003, 0), tilt=(14, 0))
flower.add(ball(0.0165, "heart", 24, 1.0, 0.55), move=(0, -0.006, 0))
scene.mesh("flower", flower)


def leaf(u, v):
    width = math.sin(math.pi * (v * 0.96 + 0.02)) ** 0.8
    return ((u - 0.5) * 0.034 * width, 0.055 * v - 0.075 * v * v - 0.25 * width * 0.034 * (0.5 - abs(u - 0.5)), -0.105 * v)


scene.mesh("leaf", sheet(leaf, "leaf", 8, 16, 0.0007))
heads = [((-0.085, 0.335, -0.20), (38, 25, 22)), ((0.005, 0.385, -0.235), (24, 0, -4)), ((0.082, 0.330, -0.215), (36, -20, -24)), ((-0.035, 0.285, -0.165), (58, 10, 8)), ((0.045, 0.270, -0.165), (60, -15, -12))]
stems = Mesh()
for (x, y, z), turn in heads:
    stems.add(sweep(spline([(-0.005 + (x + 0.005) * 0.08, 0.17, -0.22), (-0.005 + (x + 0.005) * 0.35, 0.24, -0.22 + (z + 0.22) * 0.4), (x, y - 0.004, z)], 8), 0.0026, "stem", 10))
    scene.place("flower", (x, y, z), turn)
scene.mesh("stems", stems)
scene.place("stems", material="leaf")
for (x, y, z), turn in [((-0.02, 0.20, -0.21), (8, 60, 0)), ((0.01, 0.20, -0.21), (4, -75, 0)), ((0.0, 0.215, -0.20), (-14, 160, 0)), ((-0.01, 0.21, -0.23), (-25, 12, 0)), ((0.0, 0.20, -0.2), (12, -130, 0))]:
    scene.place("leaf", (x, y, z), turn)


# Books.
def book(width, height, depth, cover):
    mesh = Mesh()
    mesh.add(box(width, 0.003, depth, cover, 0.0012, 2)).add(box(width, 0.003, depth, cover, 0.0012, 2), (0, height - 0.003, 0))
    spine = sweep([(-width / 2 + 0.0015, 0.0015 + (height - 0.003) * i / 6, 0) for i in range(7)], 0.001, cover, 6)
    mesh.add(spine)
    mesh.grid([[(-width / 2 - 0.0035 * math.sin(math.pi * j / 8), height * j / 8, z) for z in (-depth / 2, depth / 2)] for j in range(9)], cover)
    mesh.add(box(width - 0.008, height - 0.006, depth - 0.008, "paper", 0.001, 1), (-0.002, 0.003, 0))
    return mesh


for name, size, cover, y, turn in (("book_large", (0.21, 0.028, 0.145), "red_cover", 0.0, 8), ("book_middle", (0.19, 0.022, 0.13), "navy_cover", 0.028, -9), ("book_small", (0.165, 0.018, 0.112), "green_cover", 0.050, 14)):
    scene.mesh(name, book(*size, cover))
    scene.place(name, (-0.505, y, -0.07), turn)

# Candle in its holder, on the books.
holder = lathe([(0, 0), (0.038, 0), (0.040, 0.003)] + spline([(0.040, 0.005), (0.030, 0.009), (0.012, 0.012), (0.011, 0.03), (0.016, 0.036)], 5) + [(0.0165, 0.05), (0.0135, 0.05), (0.0135, 0.042), (0, 0.042)], "metal", 40)
scene.mesh("holder", holder)
candle = Mesh().add(lathe([(0, 0), (0.0125, 0), (0.0125, 0.118), (0.0115, 0.121), (0.008, 0.1195), (0, 0.119)], "wax", 32)).add(sweep([(0, 0.119, 0), (0.0005, 0.125, 0), (0.002, 0.131, 0)], 0.0011, "stem", 8))
candle.add(lathe(spline([(0, 0.128), (0.0062, 0.139), (0.0042, 0.152), (0, 0.166)], 6), "flame", 24))
scene.mesh("candle", candle)
scene.place("holder", (-0.515, 0.068, -0.075))
scene.place("candle", (-0.515, 0.110, -0.075))

# Plate with bread, butter, knife.
plate = lathe([(0, 0.003), (0.05, 0.003), (0.053, 0.0), (0.058, 0.0), (0.061, 0.004)] + spline([(0.066, 0.006), (0.095, 0.011), (0.118, 0.018)], 6) + [(0.1185, 0.0195), (0.117, 0.020)] + [(r, y + 0.003) for r, y in reversed(spline([(0.066, 0.006), (0.095, 0.011), (0.116, 0.0175)], 6))] + [(0.05, 0.0065), (0, 0.0065)], "porcelain", 64)
scene.mesh("plate", plate)
scene.place("plate", (0.245, 0.004, 0.185))
crescent = Mesh()
path = [(0.062 * math.cos(math.radians(20 + 200 * i / 72)), 0.020, 0.062 * math.sin(math.radians(20 + 200 * i / 72))) for i in range(73)]
swell = [(0.004 + 0.021 * math.sin(math.pi * i / 72) ** 0.8) * (1 + 0.07 * abs(math.sin(math.pi * i / 9))) for i in range(73)]
crescent.add(sweep(path, swell, "bread", 28))
scene.mesh("croissant", crescent)
scene.place("croissant", (0.258, 0.009, 0.205), (0, 205, 0))
slice_ = box(0.075, 0.014, 0.07, "crumb", 0.006, 3)
scene.mesh("toast", slice_)
scene.place("toast", (0.205, 0.0115, 0.160), (0, 28, 0))
scene.place("toast", (0.196, 0.0255, 0.152), (4, 44, 3))
scene.mesh("butter", box(0.032, 0.007, 0.026, "butter", 0.002, 3))
scene.place("butter", (0.195, 0.040, 0.150), (4, 60, 3))
knife = Mesh().add(box(0.085, 0.0085, 0.010, "stem", 0.003, 3), (0.055, 0, 0)).add(box(0.115, 0.0016, 0.0165, "metal", 0.0007, 2), (-0.043, 0.003, 0))
scene.mesh("knife", knife)
scene.place("knife", (0.385, 0.004, 0.21), (0, 78, 0))

# Jam jar, egg, sugar, milk jug.
jar = Mesh().add(lathe([(0, 0), (0.030, 0)] + arc(0.029, 0.005, 0.005, -90, 0, 4) + [(0.034, 0.055)] + arc(0.029, 0.055, 0.005, 0, 60, 4) + [(0.029, 0.064)], "jam", 44))
jar.add(lathe([(0.0312, 0.062), (0.0318, 0.063), (0.0318, 0.077), (0.0305, 0.079), (0, 0.0795)], "metal", 44))
jar.add(lathe([(0.0343, 0.016), (0.0346, 0.0165), (0.0346, 0.046), (0.0343, 0.0465)], "paper", 44))
scene.mesh("jar", jar)
scene.place("jar", (0.435, 0.0, -0.045), 20)
egg_cup = lathe([(0, 0.0), (0.021, 0.0), (0.0225, 0.002), (0.012, 0.008), (0.009, 0.016)] + spline([(0.010, 0.02), (0.022, 0.030), (0.0255, 0.044)], 6) + [(0.0245, 0.0455), (0.023, 0.044), (0.018, 0.032), (0, 0.026)], "blue", 40)
scene.mesh("egg_cup", egg_cup)
egg = lathe([(0, 0.0)] + spline([(0.004, 0.0004), (0.0185, 0.014), (0.021, 0.027), (0.0155, 0.045), (0.005, 0.0548)], 7) + [(0, 0.0555)], "sugar", 40)
scene.mesh("egg", egg)
scene.place("egg_cup", (-0.075, 0.004, 0.105))
scene.place("egg", (-0.075, 0.030, 0.105))
scene.mesh("sugar", box(0.016, 0.013, 0.016, "sugar", 0.0018, 2))
for x, y, z, turn in ((-0.355, 0.0, 0.135, 12), (-0.335, 0.0, 0.142, 50), (-0.347, 0.013, 0.136, 33), (-0.372, 0.0, 0.155, -20)):
    scene.place("sugar", (x, y + 0.003, z), turn)
jug = Mesh().add(lathe([(0, 0.0), (0.026, 0.0), (0.028, 0.003)] + spline([(0.029, 0.006), (0.040, 0.03), (0.036, 0.058), (0.028, 0.078), (0.032, 0.094)], 7) + [(0.0315, 0.0955), (0.0295, 0.094), (0.026, 0.078), (0.030, 0.058), (0, 0.05)], "porcelain", 48))
jug.add(sweep(spline([(-0.028, 0.085, 0), (-0.056, 0.083, 0), (-0.06, 0.052, 0), (-0.038, 0.026, 0)], 8), 0.0042, "porcelain", 14))
scene.mesh("jug", jug)
scene.place("jug", (-0.405, 0.002, 0.085), 150)

scene.write()
