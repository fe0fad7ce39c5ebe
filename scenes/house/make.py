"""Makes a house for drawings: joinery, stairs, railings, tiles, and rooms to cut through.   python3 scenes/house/make.py

Ground floor at y = 0, 12 × 8 metres, ridge along x. Solids are closed, so that sections fill them.
"""

import math
import os
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(FOLDER))
from joinery import *  # noqa: E402,F403

HEADER = """# A house. Made by make.py in this folder; metres, y up.
up = "y"

[units]
meters_per_unit = 1.0

[[camera]]
name = "street"
position = [15.5, 1.7, 19.5]
look_at = [0.6, 1.7, 0.0]
focal_length = 35
shift = [0.0, 0.08]

[[camera]]
name = "garden"
position = [-14, 7.5, 23]
look_at = [0.6, 2.9, 0]
focal_length = 38

[[camera]]
name = "south"
position = [0, 4.2, 60]
look_at = [0, 4.2, 0]
orthographic_height = 14

[[camera]]
name = "east"
position = [60, 4.2, 0]
look_at = [0, 4.2, 0]
orthographic_height = 14

[[camera]]
name = "axonometric"
position = [40, 42, 40]
look_at = [0, 2.4, 0]
orthographic_height = 19

[[camera]]
name = "plan"
position = [0, 60, 0]
look_at = [0, 0, 0]
up = [0, 0, -1]
orthographic_height = 14

[[light]]
name = "afternoon"
kind = "sun"
direction = [-0.62, -0.9, -0.55]
color = "#fff4e2"
intensity = 0.85
shadow = { resolution = 4096, softness = 1.5 }

# Cuts for drawings: through the stairs, looking north; and through the ground floor, looking down.
[[section]]
name = "A"
point = [0, 0, 1.2]
normal = [0, 0, 1]
fill = "#2b2b2b"

[[section]]
name = "plan"
point = [0, 1.2, 0]
normal = [0, 1, 0]
fill = "#f2efe8"
hatch = "1.4mm"
hatch_width = "0.13mm"
hatch_color = "#2b2b2b"
"""

scene = Scene(FOLDER, HEADER)
M = scene.material
for name, color in (("render", "#f1ece0"), ("inside", "#f6f3ec"), ("brick", "#b5694c"), ("tile", "#a5503a"), ("ridge", "#8d4231"), ("frame", "#36454d"), ("glass", "#bcd2d8"), ("timber", "#b98d5c"),
                    ("board", "#c79f6e"), ("stone", "#c9c3b6"), ("concrete", "#b9b6af"), ("grass", "#9bb07a"), ("metal", "#5a6066"), ("door", "#7a2f2a"), ("shutter", "#5d7a6a"), ("leaf", "#6f9159"),
                    ("bark", "#77583e"), ("white", "#f8f6f1"), ("cloth", "#8d5a50"), ("floor", "#d8c3a0")):
    M(name, color)

LENGTH, DEPTH, THICK = 12.0, 8.0, 0.3
FLOOR, UPPER, EAVES = 0.0, 3.0, 5.5
RISE = 3.1   # of the roof, over half the depth

# Ground, terrace, path.
scene.mesh("ground", block(34, 0.3, 26, "grass"))
scene.place("ground", (0, -0.75, 0), name="ground")
scene.mesh("foundation", block(LENGTH + 0.1, 0.45, DEPTH + 0.1, "stone"))
scene.place("foundation", (0, -0.45, 0), name="foundation")
scene.mesh("terrace", block(6.4, 0.3, 3.0, "concrete"))
scene.place("terrace", (-2.4, -0.45, DEPTH / 2 + 1.55), name="terrace")
scene.mesh("flag", block(0.78, 0.06, 0.78, "stone"))
for i in range(8):
    for j in range(2):
        scene.place("flag", (3.2 + 0.82 * j, -0.46, DEPTH / 2 + 1.5 + 0.82 * i), name="path")

# Openings of the long walls: (x from the left end, sill, width, height).
south_low = [(0.9, 0.0, 1.0, 2.25), (2.1, 0.0, 1.0, 2.25), (3.3, 0.0, 1.0, 2.25), (6.0, 0.9, 1.4, 1.35), (8.7, 0.0, 1.1, 2.25), (10.4, 0.9, 0.8, 1.35)]
south_high = [(0.9, 0.75, 1.2, 1.35), (2.7, 0.0, 2.0, 2.1), (5.6, 0.75, 1.2, 1.35), (8.0, 0.75, 1.2, 1.35), (10.0, 0.75, 1.2, 1.35)]
north_low = [(1.0, 1.0, 1.6, 1.2), (5.0, 1.0, 0.7, 1.2), (8.5, 1.0, 1.6, 1.2)]
north_high = [(1.2, 0.75, 1.2, 1.35), (5.0, 0.2, 0.9, 1.9), (9.0, 0.75, 1.2, 1.35)]
side_low = [(1.2, 0.9, 1.4, 1.35), (4.8, 0.9, 1.4, 1.35)]
side_high = [(1.4, 0.75, 1.2, 1.35), (4.8, 0.75, 1.2, 1.35)]


def put_wall(name, openings, length, height, at, turn=0, gable=0.0, paint="render"):
    scene.mesh(name, wall(length, height, THICK, paint, openings, "white", gable))
    scene.place(name, at, turn, name=name)


low, high = UPPER - 0.3 - FLOOR, EAVES - UPPER
put_wall("south_wall", south_low, LENGTH, low, (-LENGTH / 2, FLOOR, DEPTH / 2 - THICK / 2))
put_wall("south_wall_upper", south_high, LENGTH, high, (-LENGTH / 2, UPPER, DEPTH / 2 - THICK / 2))
put_wall("north_wall", north_low, LENGTH, low, (LENGTH / 2, FLOOR, -DEPTH / 2 + THICK / 2), 180)
put_wall("north_wall_upper", north_high, LENGTH, high, (LENGTH / 2, UPPER, -DEPTH / 2 + THICK / 2), 180)
inner = DEPTH - 2 * THICK
put_wall("east_wall", side_low, inner, low, (LENGTH / 2 - THICK / 2, FLOOR, inner / 2), 90)
put_wall("west_wall", side_low, inner, low, (-LENGTH / 2 + THICK / 2, FLOOR, -inner / 2), 270)
# Gables stand over the whole depth, clad with boards.
put_wall("east_gable", side_high, inner, high, (LENGTH / 2 - THICK / 2, UPPER, inner / 2), 90)
put_wall("west_gable", side_high, inner, high, (-LENGTH / 2 + THICK / 2, UPPER, -inner / 2), 270)
slope = RISE / (DEPTH / 2)
half = inner / 2
peak = prism([(-half, 0.0), (half, 0.0), (0.0, -half * slope)], THICK, "render")
upright = Mesh().add(peak, tilt=(90, 0))   # a triangle in x and y, THICK deep
scene.mesh("gable_peak", upright)
scene.place("gable_peak", (LENGTH / 2 - THICK, EAVES, 0), 90, name="east_peak")
scene.place("gable_peak", (-LENGTH / 2, EAVES, 0), 90, name="west_peak")

# Slabs: a ceiling over the ground floor, with the stair's well; and under the roof.
slab = Mesh()
for x0, x1, z0, z1 in ((-LENGTH / 2, 0.7, -DEPTH / 2, DEPTH / 2), (4.6, LENGTH / 2, -DEPTH / 2, DEPTH / 2), (0.7, 4.6, -DEPTH / 2, 0.1), (0.7, 4.6, 1.95, DEPTH / 2)):
    slab.add(block(x1 - x0, 0.3, z1 - z0, "concrete"), ((x0 + x1) / 2, 0, (z0 + z1) / 2))
scene.mesh("slab", slab)
scene.place("slab", (0, UPPER - 0.3, 0), name="slab")
scene.mesh("attic_floor", block(LENGTH - 2 * THICK, 0.2, inner, "concrete"))
scene.place("attic_floor", (0, EAVES - 0.2, 0), name="attic_floor")

# Rooms: a spine wall with doors on each floor, cross walls.
scene.mesh("spine", wall(LENGTH - 2 * THICK, low, 0.12, "inside", [(1.5, 0, 0.9, 2.1), (5.0, 0, 0.9, 2.1), (9.6, 0, 0.9, 2.1)]))
scene.place("spine", (-LENGTH / 2 + THICK, FLOOR, -0.2), name="spine_wall")
scene.mesh("spine_upper", wall(LENGTH - 2 * THICK, EAVES - 0.2 - UPPER, 0.12, "inside", [(1.5, 0, 0.9, 2.1), (9.6, 0, 0.9, 2.1)]))
scene.place("spine_upper", (-LENGTH / 2 + THICK, UPPER, -0.2), name="spine_wall_upper")
scene.mesh("cross", wall(DEPTH / 2 - THICK + 0.14, low, 0.12, "inside", [(1.4, 0, 0.9, 2.1)]))
scene.place("cross", (-0.4, FLOOR, DEPTH / 2 - THICK), 90, name="cross_wall")
scene.mesh("cross_upper", wall(DEPTH / 2 - THICK + 0.14, EAVES - 0.2 - UPPER, 0.12, "inside", [(1.4, 0, 0.9, 2.1)]))
scene.place("cross_upper", (-0.4, UPPER, DEPTH / 2 - THICK), 90, name="cross_wall_upper")
scene.place("cross_upper", (5.0, UPPER, DEPTH / 2 - THICK), 90, name="cross_wall_upper")


def slats(width, height):
    """A shutter: two stiles, three rails, slanting slats."""
    s = Mesh()
    for x in (0.03, width - 0.03):
        s.add(block(0.06, height, 0.04, "shutter"), (x, 0, 0))
    for y in (0, height / 2 - 0.03, height - 0.06):
        s.add(block(width - 0.12, 0.06, 0.04, "shutter"), (width / 2, y, 0))
    for half in range(2):
        bottom, top = (0.06, height / 2 - 0.03) if half == 0 else (height / 2 + 0.03, height - 0.06)
        count = 11
        for i in range(count):
            s.add(block(width - 0.12, 0.008, 0.05, "shutter"), (width / 2, bottom + (top - bottom) * (i + 0.5) / count, 0), tilt=(38, 0))
    return s


made = {}


def fit_windows(openings, origin, turn, level, shutters=False, skip=()):
    """Fills a wall's openings; `origin` and `turn` as the wall's own."""
    angle = math.radians(turn)
    place = lambda x, z: (origin[0] + x * math.cos(angle) + z * math.sin(angle), origin[2] - x * math.sin(angle) + z * math.cos(angle))
    for x, y, w, h in openings:
        if (x, y) in skip:
            continue
        key = "window_%d_%d" % (round(w * 100), round(h * 100))
        if key not in made:
            made[key] = scene.mesh(key, window(w, h, 2 if w < 1.5 else 3, 1 if h > 2 else 2 if h < 1.3 else 3, sill=h < 1.8))
        px, pz = place(x, 0.02)
        scene.place(key, (px, level + y, pz), turn, name="window")
        if shutters and h < 1.5:
            wing = "shutter_%d" % round(h * 100)
            if wing not in made:
                made[wing] = scene.mesh(wing, slats(w / 2 - 0.02, h))
            for sx in (x - w / 2 - 0.02, x + w + 0.04):
                qx, qz = place(sx, THICK / 2 + 0.035)
                scene.place(wing, (qx, level + y, qz), turn, name="shutter")


z = DEPTH / 2 - THICK / 2
fit_windows(south_low, (-LENGTH / 2, 0, z), 0, FLOOR, skip={(8.7, 0.0)})
fit_windows(south_high, (-LENGTH / 2, 0, z), 0, UPPER, shutters=True)
fit_windows(north_low, (LENGTH / 2, 0, -z), 180, FLOOR)
fit_windows(north_high, (LENGTH / 2, 0, -z), 180, UPPER, shutters=True)
fit_windows(side_low, (LENGTH / 2 - THICK / 2, 0, inner / 2), 90, FLOOR)
fit_windows(side_low, (-LENGTH / 2 + THICK / 2, 0, -inner / 2), 270, FLOOR)
fit_windows(side_high, (LENGTH / 2 - THICK / 2, 0, inner / 2), 90, UPPER, shutters=True)
fit_windows(side_high, (-LENGTH / 2 + THICK / 2, 0, -inner / 2), 270, UPPER, shutters=True)

# The door, its steps and canopy.
door = Mesh()
for x in (0.04, 1.06):
    door.add(block(0.08, 2.25, 0.12, "frame"), (x, 0, 0))
door.add(block(0.94, 0.08, 0.12, "frame"), (0.55, 2.17, 0))
door.add(block(0.94, 2.17, 0.05, "door"), (0.55, 0, 0))
for x in (0.33, 0.77):
    for y, h in ((0.15, 0.55), (0.82, 0.75), (1.68, 0.36)):
        door.add(box(0.32, h, 0.05, "door", 0.02, 2), (x, y, 0.03))
door.add(ball(0.035, "metal", 16), (0.98, 1.0, 0.07))
scene.mesh("door", door)
scene.place("door", (-LENGTH / 2 + 8.7, FLOOR, z), name="door")
steps = Mesh()
for i in range(3):
    steps.add(block(1.9, 0.15, 0.3, "stone"), (0, -0.45 + 0.15 * i, 0.9 - 0.3 * i))
scene.mesh("door_steps", steps)
scene.place("door_steps", (-LENGTH / 2 + 9.25, 0, DEPTH / 2 + 0.2), name="door_steps")
canopy = Mesh()
canopy.add(block(2.0, 0.09, 1.25, "metal"), (0, 2.5, 0.62))
for x in (-0.9, 0.9):
    canopy.add(lathe([(0, -0.45), (0.045, -0.45), (0.045, 2.5), (0, 2.5)], "metal", 16), (x, 0, 1.15))
scene.mesh("canopy", canopy)
scene.place("canopy", (-LENGTH / 2 + 9.25, 0, DEPTH / 2 + 0.03), name="canopy")

# A balcony on brackets, before the tall window; its railing, and another along the terrace.


balcony = Mesh()
balcony.add(block(2.9, 0.16, 1.15, "concrete"), (0, -0.16, 0.575))
balcony.add(railing(2.9), (0, 0, 1.12))
for x in (-1.42, 1.42):
    balcony.add(railing(1.1), (x, 0, 0.56), 90)
for x in (-1.2, 0.0, 1.2):
    balcony.add(block(0.12, 0.16, 1.0, "timber"), (x, -0.32, 0.5))
scene.mesh("balcony", balcony)
scene.place("balcony", (-LENGTH / 2 + 3.7, UPPER, DEPTH / 2), name="balcony")

# The stairs: a straight flight of sixteen, open on one side, with a railing.
flight = Mesh()
count, going, riser = 16, 0.235, 3.0 / 16
for i in range(count - 1):
    flight.add(block(going + 0.03, 0.045, 1.0, "timber"), (going * i, riser * (i + 1) - 0.045, 0))
    flight.add(block(0.02, riser - 0.045, 0.96, "white"), (going * i - going / 2 + 0.02, riser * i, 0))
for side in (-0.5, 0.5):
    side_board = prism([(-0.12, 0.0), (0.2, 0.0), (going * count, -riser * count + 0.1), (going * count, -riser * count - 0.0), (going * count - 0.25, -riser * count - 0.0), (-0.12, -0.28)], 0.05, "timber")
    flight.add(side_board, (0, 0, side + 0.025 if side > 0 else side - 0.025), tilt=(90, 0))
for i in range(count):
    for k in (0.0, 0.5):
        x = going * (i + k)
        flight.add(block(0.025, 0.9, 0.025, "timber"), (x, riser * (i + k) + 0.12, 0.55))
rail = [(going * t, riser * t + 1.04, 0.55) for t in (0, count / 2, count)]
flight.add(sweep(rail, 0.03, "timber", 12))
scene.mesh("stairs", flight)
scene.place("stairs", (0.85, FLOOR, 1.15), name="stairs")
scene.mesh("well_railing", railing(3.8, 0.95))
scene.place("well_railing", (2.6, UPPER, 2.0), name="well_railing")

# The roof: rafters, boards, rows of pantiles, ridge, gutters, chimney.
over, side_over = 0.55, 0.45
run = DEPTH / 2 + over
length_up = math.hypot(run, run * slope)
pitch = math.degrees(math.atan(slope))
deck = block(LENGTH + 2 * side_over, 0.14, length_up, "board")
scene.mesh("roof_deck", deck)
for sign in (1, -1):
    scene.place("roof_deck", (0, EAVES + (DEPTH / 2) * slope - run * slope / 2 + 0.02, sign * run / 2), (pitch if sign > 0 else -pitch, 0, 0), name="roof_deck")


def pantile(width, length):
    """A wave and its turned-down edge, two-sided."""
    wave = lambda u: 0.035 * math.sin(2 * math.pi * (u - 0.05)) * (1.15 if 0.05 < u < 0.55 else 0.55)
    surface = lambda u, v: ((u - 0.5) * width, wave(u) + 0.055 * v, (0.5 - v) * length)
    return sheet(lambda u, v: (surface(u, 1 - v)[0], surface(u, 1 - v)[1], surface(u, 1 - v)[2]), "tile", 10, 3, 0.014)


TILES, ROWS = 44, 16
tile_width, exposure = (LENGTH + 2 * side_over) / TILES, length_up / ROWS
one = pantile(tile_width * 1.12, exposure * 1.25)
row = Mesh()
for i in range(TILES):
    row.add(one, (-(LENGTH + 2 * side_over) / 2 + tile_width * (i + 0.5), 0, 0))
scene.mesh("tile_row", row)
for sign in (1, -1):
    for j in range(ROWS):
        along = exposure * (j + 0.5)   # up from the eaves
        back = run - along * math.cos(math.radians(pitch))
        y = EAVES + (DEPTH / 2 - run) * slope + along * math.sin(math.radians(pitch)) + 0.14
        turn = (pitch, 0, 0) if sign > 0 else (pitch, 180, 0)
        scene.place("tile_row", (0, y + 0.02, sign * (back + 0.03)), turn, name="tiles")
cap = sheet(lambda u, v: (v * 0.42, 0.13 * math.sin(math.pi * u), 0.15 * math.cos(math.pi * u)), "ridge", 12, 2, 0.018)
ridge = Mesh()
for i in range(32):
    ridge.add(cap, (-(LENGTH + 2 * side_over) / 2 + 0.4 * i, 0.012 * (i % 2), 0))
scene.mesh("ridge", ridge)
scene.place("ridge", (0, EAVES + DEPTH / 2 * slope + 0.21, 0), name="ridge")
gutter = sheet(lambda u, v: ((v - 0.5) * (LENGTH + 2 * side_over), -0.07 * math.sin(math.pi * u), -0.075 * math.cos(math.pi * u)), "metal", 14, 2, 0.006)
scene.mesh("gutter", gutter)
pipe = sweep([(0, 0, 0), (0, -0.18, 0), (0, -0.42, -0.42), (0, -0.6, -0.5), (0, -5.5, -0.5)], 0.045, "metal", 14)
scene.mesh("downpipe", pipe)
edge_y = EAVES + (DEPTH / 2 - run) * slope + 0.03
for sign in (1, -1):
    scene.place("gutter", (0, edge_y, sign * (run + 0.09)), 0, name="gutter")
    for x in (-LENGTH / 2 + 0.15, LENGTH / 2 - 0.15):
        scene.place("downpipe", (x, edge_y - 0.05, sign * (run + 0.09)), 0 if sign > 0 else 180, name="downpipe")
rafter = block(0.1, 0.16, length_up - 0.05, "timber")
scene.mesh("rafter", rafter)
for sign in (1, -1):
    for i in range(21):
        x = -(LENGTH + 2 * side_over) / 2 + 0.1 + (LENGTH + 2 * side_over - 0.2) * i / 20
        scene.place("rafter", (x, EAVES + DEPTH / 2 * slope - run * slope / 2 - 0.17, sign * run / 2), (pitch if sign > 0 else -pitch, 0, 0), name="rafter")
chimney = Mesh()
chimney.add(block(0.9, 2.9, 0.7, "brick"), (0, 0, 0))
chimney.add(block(1.06, 0.12, 0.86, "stone"), (0, 2.9, 0))
for x in (-0.22, 0.22):
    chimney.add(lathe([(0, 0), (0.15, 0), (0.12, 0.42), (0.14, 0.42), (0.14, 0.5), (0.09, 0.5), (0.09, 0.05), (0, 0.05)], "ridge", 24), (x, 3.02, 0))
scene.mesh("chimney", chimney)
scene.place("chimney", (-3.4, EAVES + 1.0, -1.1), name="chimney")

# Furniture for the sections.
table = Mesh()
table.add(block(1.8, 0.04, 0.9, "timber"), (0, 0.71, 0))
for x in (-0.82, 0.82):
    for tz in (-0.38, 0.38):
        table.add(block(0.07, 0.71, 0.07, "timber"), (x, 0, tz))
scene.mesh("table", table)
scene.mesh("chair", chair())
scene.place("table", (-3.3, FLOOR, 1.0), name="table")
for x in (-4.0, -3.3, -2.6):
    scene.place("chair", (x, FLOOR, 0.35), 0, name="chair")
    scene.place("chair", (x, FLOOR, 1.65), 180, name="chair")
bed = Mesh()
bed.add(block(1.7, 0.28, 2.05, "timber"), (0, 0.05, 0))
bed.add(box(1.64, 0.24, 1.98, "white", 0.06, 3), (0, 0.33, 0))
bed.add(box(1.66, 0.1, 1.3, "cloth", 0.04, 3), (0, 0.5, 0.36))
for x in (-0.4, 0.4):
    bed.add(box(0.66, 0.16, 0.42, "white", 0.07, 3), (x, 0.55, -0.72))
bed.add(block(1.8, 1.0, 0.06, "timber"), (0, 0, -1.05))
scene.mesh("bed", bed)
scene.place("bed", (-3.6, UPPER, 0.95), 0, name="bed")
scene.mesh("shelf", bookshelf())
scene.place("shelf", (-1.4, FLOOR, 0.05), name="shelf")
scene.place("shelf", (2.0, UPPER, 0.05), name="shelf")
kitchen = Mesh()
kitchen.add(block(3.0, 0.86, 0.6, "white"), (0, 0, 0))
kitchen.add(block(3.04, 0.04, 0.64, "stone"), (0, 0.86, 0.01))
for i in range(5):
    kitchen.add(block(0.57, 0.72, 0.02, "board"), (-1.2 + 0.6 * i, 0.1, 0.31))
    kitchen.add(block(0.3, 0.012, 0.02, "metal"), (-1.2 + 0.6 * i, 0.76, 0.33))
kitchen.add(block(3.0, 0.7, 0.34, "white"), (0, 1.45, -0.13))
scene.mesh("kitchen", kitchen)
scene.place("kitchen", (-4.0, FLOOR, -DEPTH / 2 + THICK + 0.32), name="kitchen")

# Trees: a trunk and clouds of leaves.
tree = Mesh()
tree.add(sweep([(0, 0, 0), (0.05, 1.0, 0.02), (-0.02, 2.1, 0.0), (0.02, 3.0, 0.04)], [0.17, 0.13, 0.11, 0.06], "bark", 14))
for x, y, tz, r in ((0, 2.3, 0, 1.05), (0.75, 2.1, 0.25, 0.72), (-0.7, 2.2, 0.3, 0.78), (0.1, 3.2, -0.1, 0.8), (-0.2, 2.4, -0.75, 0.75), (0.3, 2.8, 0.6, 0.62)):
    tree.add(ball(r, "leaf", 36), (x, y - r * 0.6, tz))
scene.mesh("tree", tree)
for x, tz, s, turn in ((-9.6, 5.2, 1.25, 0), (9.2, -4.5, 1.5, 70), (-8.2, -6.5, 1.7, 140), (12.2, 5.2, 0.95, 210)):
    scene.place("tree", (x, -0.45, tz), turn, s, name="tree")
shrub = Mesh()
for x, r in ((-0.45, 0.34), (0, 0.42), (0.48, 0.36)):
    shrub.add(ball(r, "leaf", 28, height=0.85), (x, -0.05, 0))
scene.mesh("shrub", shrub)
for x in (0.2, 1.8, 5.2):
    scene.place("shrub", (x, -0.45, DEPTH / 2 + 0.6), name="shrub")

scene.write()
