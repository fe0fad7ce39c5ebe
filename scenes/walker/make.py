"""Walker: a clay figure that walks, one subdivided cage per frame of its cycle.

blender -b --factory-startup --python-exit-code 1 -P scenes/walker/make.py

Blender's Skin modifier makes the cage around the bones; the walk is made here: legs by two-bone inverse kinematics, so
that a foot on the ground stands still while the body passes over it. z is up, the figure faces -y; metres.
"""

import math
import os

import bpy
from mathutils import Matrix, Vector

HERE = os.path.dirname(os.path.abspath(__file__))
FRAMES = 24  # of one cycle: two steps
STANCE = 0.62  # part of the cycle that a foot is on the ground
REACH = 0.24  # how far before and behind the hip a foot stands
HIP, THIGH, SHIN, ANKLE = 0.93, 0.4, 0.385, 0.09
STRIDE = 2 * REACH / STANCE  # of one cycle

# Joints at rest: place, radii of the skin. Bones join a parent to a child.
JOINTS = {
    "hips": ((0, 0, HIP), (0.13, 0.11)),
    "waist": ((0, 0, 1.1), (0.12, 0.1)),
    "chest": ((0, 0, 1.33), (0.17, 0.12)),
    "neck": ((0, 0, 1.49), (0.055, 0.055)),
    "head": ((0, -0.02, 1.63), (0.15, 0.15)),
    "crown": ((0, -0.01, 1.78), (0.14, 0.15)),
}
for side, sign in (("left", 1), ("right", -1)):
    JOINTS.update(
        {
            side + " hip": ((0.1 * sign, 0, HIP - 0.06), (0.095, 0.1)),
            side + " knee": ((0.1 * sign, -0.012, HIP - 0.06 - THIGH), (0.07, 0.075)),
            side + " ankle": ((0.1 * sign, 0, ANKLE), (0.055, 0.06)),
            side + " toe": ((0.1 * sign, -0.17, 0.055), (0.055, 0.05)),
            side + " shoulder": ((0.2 * sign, 0, 1.4), (0.07, 0.07)),
            side + " elbow": ((0.25 * sign, 0.02, 1.13), (0.05, 0.05)),
            side + " hand": ((0.27 * sign, -0.03, 0.88), (0.045, 0.05)),
        }
    )
BONES = [("hips", "waist"), ("waist", "chest"), ("chest", "neck"), ("neck", "head"), ("head", "crown")]
for side in ("left", "right"):
    BONES += [
        ("hips", side + " hip"),
        (side + " hip", side + " knee"),
        (side + " knee", side + " ankle"),
        (side + " ankle", side + " toe"),
        ("chest", side + " shoulder"),
        (side + " shoulder", side + " elbow"),
        (side + " elbow", side + " hand"),
    ]


def make_cage():
    """The skin around the bones, as vertices and faces."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    names = list(JOINTS)
    data = bpy.data.meshes.new("bones")
    data.from_pydata([JOINTS[n][0] for n in names], [(names.index(a), names.index(b)) for a, b in BONES], [])
    obj = bpy.data.objects.new("figure", data)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.modifiers.new("Skin", "SKIN")
    for vertex, name in zip(data.skin_vertices[0].data, names):
        vertex.radius = JOINTS[name][1]
    data.skin_vertices[0].data[0].use_root = True
    made = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return [Vector(v.co) for v in made.vertices], [list(p.vertices) for p in made.polygons]


def distance(point, bone):
    """To a bone's surface at rest: the thick bones of the trunk must not leave their skin to the arms."""
    (a, (ra, _)), (b, (rb, _)) = JOINTS[bone[0]], JOINTS[bone[1]]
    a, b = Vector(a), Vector(b)
    along = b - a
    t = max(0.0, min(1.0, (point - a).dot(along) / along.length_squared))
    return max(0.004, (point - a - along * t).length - 0.8 * (ra + (rb - ra) * t))


def weights_of(point):
    """How much each bone moves a vertex: the nearest ones, smoothly. Feet are stiff."""
    near = sorted((distance(point, bone), bone) for bone in BONES)
    foot = near[0][1][1].endswith("toe") and point.z < ANKLE + 0.02
    if foot:
        return [(1.0, near[0][1])]
    kept = [(1 / d**3, bone) for d, bone in near[:3] if d < 4 * near[0][0] + 0.02]
    total = sum(w for w, _ in kept)
    return [(w / total, bone) for w, bone in kept]


def turned(place, about, axis, angle):
    return Matrix.Translation(about) @ Matrix.Rotation(angle, 4, axis) @ Matrix.Translation(-about) @ place


def foot_at(phase):
    """Of a foot at a phase of its cycle, from the hip's place on the ground: how far ahead, how high, how much the toes
    point up (radians). It touches the ground at 0."""
    if phase < STANCE:
        return REACH - 2 * REACH * phase / STANCE, 0.0, 0.0
    t = (phase - STANCE) / (1 - STANCE)
    # Hermite's cubic from behind to ahead, which leaves and meets the ground as fast as that passes.
    slope = -2 * REACH / STANCE * (1 - STANCE)
    ahead = (
        (2 * t**3 - 3 * t**2 + 1) * -REACH
        + (t**3 - 2 * t**2 + t) * slope
        + (3 * t**2 - 2 * t**3) * REACH
        + (t**3 - t**2) * slope
    )
    return ahead, 0.13 * math.sin(math.pi * t) ** 2, 0.5 * math.sin(2 * math.pi * t) * -1


def leg(side, phase, pelvis):
    """The matrices of a leg's bones: by the law of cosines, the knee bends forward."""
    ahead, height, toes = foot_at(phase)
    rest = {part: Vector(JOINTS[side + " " + part][0]) for part in ("hip", "knee", "ankle")}
    hip = pelvis @ rest["hip"]
    ankle = Vector((rest["ankle"].x, -ahead, ANKLE + height))
    reach = ankle - hip
    length = min(reach.length, THIGH + SHIN - 1e-4)
    knee_angle = math.acos((THIGH**2 + length**2 - SHIN**2) / (2 * THIGH * length))
    down = math.atan2(-reach.y, -reach.z)  # 0: straight down; ahead is positive
    thigh_turn = down + knee_angle
    knee = hip + Vector((0, -math.sin(thigh_turn), -math.cos(thigh_turn))) * THIGH
    shin = ankle - knee
    shin_turn = math.atan2(-shin.y, -shin.z)

    def moved(start, target, turn, rest_turn):
        return Matrix.Translation(target) @ Matrix.Rotation(-(turn - rest_turn), 4, "X") @ Matrix.Translation(-start)

    def rest_turn(a, b):
        return math.atan2(-(b - a).y, -(b - a).z)

    return {
        (side + " hip", side + " knee"): moved(rest["hip"], hip, thigh_turn, rest_turn(rest["hip"], rest["knee"])),
        (side + " knee", side + " ankle"): moved(rest["knee"], knee, shin_turn, rest_turn(rest["knee"], rest["ankle"])),
        (side + " ankle", side + " toe"): moved(rest["ankle"], ankle, toes, 0),
    }


def pose(cycle):
    """The matrix of every bone at a place of the cycle, 0 to 1."""
    swing = math.sin(2 * math.pi * (cycle + 0.25))  # the left leg is ahead at 0
    bob = -0.022 - 0.018 * math.cos(4 * math.pi * (cycle - 0.06))
    pelvis = turned(Matrix.Translation((0.012 * math.sin(2 * math.pi * cycle), 0, bob)), Vector((0, 0, HIP)), "Z", -0.1 * swing)
    trunk = turned(pelvis, pelvis @ Vector((0, 0, 1.1)), "Z", 0.22 * swing)
    trunk = turned(trunk, trunk @ Vector((0, 0, 1.1)), "X", 0.05)
    head = turned(trunk, trunk @ Vector((0, 0, 1.5)), "Z", -0.12 * swing)
    bones = {("hips", "waist"): pelvis, ("waist", "chest"): trunk, ("chest", "neck"): trunk}
    bones.update({("neck", "head"): head, ("head", "crown"): head})
    for side, sign in (("left", 1), ("right", -1)):
        bones.update(leg(side, (cycle + (0 if sign > 0 else 0.5)) % 1, pelvis))
        bones[("hips", side + " hip")] = pelvis
        bones[("chest", side + " shoulder")] = trunk
        arm = turned(trunk, trunk @ Vector(JOINTS[side + " shoulder"][0]), "X", 0.5 * swing * sign)
        bones[(side + " shoulder", side + " elbow")] = arm
        bend = -0.35 - 0.25 * swing * -sign
        bones[(side + " elbow", side + " hand")] = turned(arm, arm @ Vector(JOINTS[side + " elbow"][0]), "X", bend)
    return bones


def write(path, points, faces):
    with open(path, "w") as file:
        file.write("# A frame of scenes/walker/make.py\no walker\n")
        file.writelines("v %.6f %.6f %.6f\n" % tuple(p) for p in points)
        file.writelines("f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces)


def write_tiles(path, side=0.4):
    """Slabs on the ground, each a part of its own: lines are drawn where they meet."""
    lines, count = [], 0
    for row in range(-16, 9):
        for column in range(-9, 10):
            x, y = column * side + (side / 2 if row % 2 else 0), row * side
            half = side / 2
            corners = ((-half, -half), (half, -half), (half, half), (-half, half))
            lines.append("o slab_%d_%d" % (row + 16, column + 9))
            lines += ["v %.4f %.4f 0" % (x + dx, y + dy) for dx, dy in corners]
            lines.append("f %d %d %d %d" % tuple(count + i for i in (1, 2, 3, 4)))
            count += 4
    with open(path, "w") as file:
        file.write("# Made by scenes/walker/make.py\n" + "\n".join(lines) + "\n")


def main():
    points, faces = make_cage()
    weights = [weights_of(p) for p in points]
    os.makedirs(os.path.join(HERE, "meshes"), exist_ok=True)
    for frame in range(FRAMES):
        bones = pose(frame / FRAMES)
        placed = []
        for point, shares in zip(points, weights):
            placed.append(sum((w * (bones[bone] @ point) for w, bone in shares), Vector((0, 0, 0))))
        write(os.path.join(HERE, "meshes", "walker_%02d.obj" % (frame + 1)), placed, faces)
    write_tiles(os.path.join(HERE, "meshes", "tiles.obj"))
    print("%d vertices, %d faces; a cycle goes %.6f ahead" % (len(points), len(faces), STRIDE))


main()
