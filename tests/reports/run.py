#!/usr/bin/env python3
"""Small inputs after public reports, drawn and looked at: python3 tests/reports/run.py LIMN [NUMBER...]

Each stands for a kind of file that people bring. Needs the folder "reports" of LIMN_TEST_DATA; 77 without it.
"""

import glob
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "files"))
from read_back import png  # noqa: E402

REPORTS = os.path.join(os.environ.get("LIMN_TEST_DATA", ""), "reports")
LIMN = os.path.abspath(sys.argv[1])
TESTS = {}


def report(function):
    """Registers a test by its number: the digits that its name ends with."""
    TESTS[function.__name__[-2:]] = function
    return function


class Picture:
    def __init__(self, path):
        self.width, self.height, self.channels, _, self.samples = png(path)

    def at(self, x, y):
        """Red, green and blue of the pixel."""
        first = (int(y) * self.width + int(x)) * self.channels
        return tuple(self.samples[first : first + 3])

    def covered(self):
        """Rows and columns of the pixels that are no background."""
        nothing, step = self.samples[: self.channels], self.channels
        return {
            divmod(i // step, self.width)
            for i in range(0, len(self.samples), step)
            if self.samples[i : i + step] != nothing
        }

    def place(self, x, y, height=1.4, centre=(3.5, 0.5)):
        """The colour at a place in the plane that an orthographic camera looks at, in scene units."""
        scale = self.height / height
        return self.at(self.width / 2 + (x - centre[0]) * scale, self.height / 2 - (y - centre[1]) * scale)


def assert_same_place(one, other):
    """Both cover the same pixels, but for some along the outline: a scene file has rounded numbers."""
    different = one.covered() ^ other.covered()
    assert len(different) < 0.002 * len(one.covered()), "%d pixels differ" % len(different)


def folder(number):
    (found,) = glob.glob(os.path.join(REPORTS, number + "-*"))
    return found


def run(*arguments, expect=0):
    """What limn says on standard error, and its standard output."""
    done = subprocess.run([LIMN, *arguments], capture_output=True, text=True, timeout=300)
    assert done.returncode == expect, "%s ends with %d: %s" % (arguments, done.returncode, done.stderr)
    return done.stderr, done.stdout


def draw(path, *arguments):
    output = os.path.join(os.getcwd(), "out.png")
    said, _ = run("render", path, "--output", output, *arguments)
    return Picture(output), said


def close(a, b, slack=3):
    return all(abs(x - y) <= slack for x, y in zip(a, b))


def same(found, wanted, what, slack=3):
    assert close(found, wanted, slack), "%s: %s instead of %s" % (what, found, wanted)


RED, GREEN, BLUE, YELLOW = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0)


@report
def map_options_01():
    picture, said = draw(folder("01") + "/draw.toml")
    # The image: red and green above, blue and yellow below. Panes are 1.2 apart.
    for pane, u, v, colour in [
        (0, 0.25, 0.75, RED),
        (0, 0.75, 0.25, YELLOW),
        (1, 1 / 12, 11 / 12, RED),  # -s 3 3 1
        (1, 3 / 12, 11 / 12, GREEN),
        (1, 5 / 12, 7 / 12, RED),
        (1, 11 / 12, 1 / 12, YELLOW),
        (2, 0.25, 0.75, GREEN),  # -o 0.5 0 0
        (2, 0.75, 0.25, BLUE),
        (3, 0.1, 0.9, RED),  # -clamp on -s 2 2 1: beyond the image its border goes on
        (3, 0.8, 0.9, GREEN),
        (3, 0.8, 0.1, YELLOW),
        (4, 1 / 12, 11 / 12, RED),  # -s 3
        (4, 11 / 12, 1 / 12, YELLOW),
        (5, 0.2, 0.5, GREEN),  # -o 0.25 0.25 -s 2 1 1
        (5, 0.45, 0.5, RED),
        (5, 0.2, 0.9, YELLOW),
    ]:
        same(picture.place(1.2 * pane + u, v), colour, "pane %d at %g, %g" % (pane, u, v))
    assert "option -mm of map_Kd; ignored" in said and "planks.mtl:23" in said, said


@report
def transparency_02():
    picture, said = draw(folder("02") + "/draw.toml")
    for name in ("glass_d", "glass_tr", "scan_tr1", "dn_halo"):
        assert said.count("material '%s' is see-through" % name) == 1, said
    assert "(d 0); not drawn" in said, said
    pane, post = picture.place(0.5, 0.8), picture.place(1.1, 0.5)
    for i in range(5):
        same(picture.place(1.2 * i + 0.5, 0.8), pane, "pane %d" % i)
    same(picture.place(6.5, 0.5), post, "what is behind the pane that is not there")
    same(picture.place(6.5, 0.8), (255, 255, 255), "nothing where d is 0")


@report
def leaves_03():
    picture, said = draw(folder("03") + "/draw.toml")
    for leaf in range(7):
        x = 77 + 154.3 * leaf
        same(picture.at(x, 90), (71, 151, 50), "the middle of leaf %d" % leaf, 12)
        same(picture.at(x - 48, 60), (255, 255, 255), "beside leaf %d" % leaf)
    assert "map_Tr" in said, said


@report
def keywords_05():
    picture, said = draw(folder("05") + "/draw.toml")
    same(picture.at(668, 80), RED, "kd")
    same(picture.at(814, 80), BLUE, "KD under NEWMTL")
    for x in (40, 186, 478):
        assert picture.at(x, 40) != picture.at(x + 30, 40) != (255, 255, 255), "map_kd, map_KD, tabs"
    assert "map_Ka" in said, said


@report
def unknown_material_07():
    _, said = draw(folder("07") + "/draw.toml")
    assert "material 'm1' is in no library" in said and "the_object_name" in said, said


@report
def damaged_images_21():
    picture, said = draw(folder("21") + "/good.toml")
    assert said.count("warning") == 0, said
    assert picture.at(80, 60) != (255, 255, 255)
    said, _ = run("check", folder("21") + "/bad.toml", expect=65)
    for name in ("not_an_image.png", "empty.png", "cut.jpg"):
        assert said.count("/%s: the image cannot be read" % name) == 1, said


@report
def paths_23():
    (config,) = glob.glob(folder("23") + "/*/Bild*.toml")
    _, said = draw(config)
    assert said.count("warning") == 2, said
    assert "Materialien.mtl:9: texture 'textures/brick.jpg' is found as 'Textures/Brick.JPG'" in said, said
    assert "Materialien.mtl:12: texture 'C:\\Users\\someone\\Desktop\\Haus\\木材.png' is found as '木材.png'" in said, said


@report
def no_tint_32():
    picture, _ = draw(folder("32") + "/draw.toml")
    for left in (15, 163):
        same(picture.at(left + 15, 40), (250, 240, 220), "a light square")
        same(picture.at(left + 46, 40), (220, 60, 40), "a dark square")


@report
def long_image_35():
    _, said = draw(folder("35") + "/t16000x64.obj")
    assert "drawn with 8000×32" in said, said
    assert "larger than" not in said, said


@report
def far_from_the_origin_16():
    model = folder("16") + "/kiosk.obj"
    direct, _ = draw(model)
    run("init", model, "--output", "kiosk")
    begun, _ = draw("kiosk/kiosk.toml")
    assert_same_place(direct, begun)
    rows, columns = zip(*direct.covered())
    # 85 % of the picture's height, in the middle.
    found = min(rows), max(rows) + 1, min(columns), max(columns) + 1
    assert abs(found[1] - found[0] - 0.85 * direct.height) < 3, found
    assert abs(found[0] + found[1] - direct.height) < 3 and abs(found[2] + found[3] - direct.width) < 3, found
    _, said = run("mesh", model)
    low, high = said.split("box")[1].split("\n")[0].split(" to ")
    low, high = [[float(n) for n in part.split("[")[1].split("]")[0].split(",")] for part in (low, high)]
    assert all(abs(b - a - 2.4) < 1e-6 for a, b in zip(low, high)), said


@report
def one_plane_09():
    here = folder("09")
    # Each has two objects in one plane; where they overlap there is one colour, and no line inside.
    for name in ("wall", "double", "twosided_same_order", "twosided_turned"):
        picture, _ = draw(here + "/%s.toml" % name)
        front, _ = draw(here + "/%s.toml" % name, "--set", "edges.0.objects=0")
        assert picture.samples == front.samples, name + ": lines between objects"
    slab, _ = draw(here + "/draw.toml")
    alone, _ = draw(here + "/draw.toml", "--set", "edges.0.objects=0", "--set", "edges.0.creases=0")
    inside = [(x, y) for x in range(300, 600, 3) for y in range(200, 300, 3)]
    assert {slab.at(x, y) for x, y in inside} == {slab.at(300, 150)}, "the slab's top has one colour"
    assert alone.covered() == slab.covered()
    for name in ("wall", "twosided_turned"):  # of double.obj they share their vertices, and are dropped
        _, facts = run("mesh", here + "/%s.obj" % name)
        assert ", 0 triangles that lie on others" not in facts, facts


@report
def smooth_balls_12():
    picture, _ = draw(folder("12") + "/draw.toml")
    # The first three are smooth: nothing as dark as a line well inside them.
    for left in (0, 1, 2):
        middle = 108 + 221 * left
        inside = [(x, y) for x in range(-75, 76) for y in range(-75, 76) if x * x + y * y < 75 * 75]
        darkest = min(min(picture.at(middle + x, 125 + y)) for x, y in inside)
        assert darkest > 100, "a line in ball %d" % left


@report
def split_seams_26():
    picture, said = draw(folder("26") + "/draw.toml")
    assert said.count("split.obj: vertex in the place of another one on the rim; joined") == 1, said
    covered = picture.covered()
    welded = {(y, x) for y, x in covered if y < 230 and x < 220}
    # Beside it, 244 pixels further, with the same ball's outline; the camera looks at both at other angles.
    split = {(y, x) for y, x in covered if y < 230 and 240 < x < 450}
    assert abs(len(welded) - len(split)) < 0.02 * len(welded), (len(welded), len(split))
    _, facts = run("mesh", folder("26") + "/bowtie.obj")
    assert "1 non-manifold vertices" in facts, facts


@report
def scan_normals_33():
    picture, said = draw(folder("33") + "/draw.toml")
    assert said.count("vertex normal that points against its faces; turned around") == 1, said
    # Lit from the upper right: the same light on each of the nine.
    for ball in range(9):
        middle = 95 + 163.7 * ball
        light, shade = picture.at(middle + 25, 65), picture.at(middle - 35, 125)
        assert min(light) > max(shade) + 30, "ball %d: %s and %s" % (ball, light, shade)


@report
def polylines_13():
    picture, said = draw(folder("13") + "/draw.toml")
    assert "point element; not drawn" in said and "line element" not in said, said
    rope = [sum(picture.at(x, y)) < 400 for x in range(130, 240) for y in range(325, 347)]
    assert sum(rope) > 100, "the rope in front of the hut"
    lines, _ = draw(folder("13") + "/plan_lines_only.obj")
    covered = lines.covered()
    assert len(covered) > 1500, "a file of lines alone is a picture"
    assert max(x for _, x in covered) - min(x for _, x in covered) > 0.8 * lines.width, "and fills it"


@report
def odd_structure_28():
    for path in sorted(glob.glob(folder("28") + "/*.[oO][bB][jJ]")):
        name = os.path.basename(path)
        what = {
            "commas.obj": "decimal commas",
            "empty.obj": "the file is empty",
            "gitlfs.obj": "git lfs pull",
            "html.obj": "a web page",
            "zip.obj": "ZIP",
        }.get(name)
        if what:
            said, _ = run("render", path, "--output", "out.png", expect=65)
            assert what in said and "export the model with faces" not in said, said
        else:
            picture, _ = draw(path, "--set", "image.size=[64,48]", "--set", "image.samples=1")
            assert picture.at(32, 24) != picture.at(0, 0), name + " is not drawn"


@report
def walls_in_section_30():
    here = folder("30")
    view, _ = draw(here + "/view.toml")
    joint = [view.at(x, y) for x in range(505, 520) for y in range(120, 310)]
    assert max(sum(abs(a - b) for a, b in zip(p, joint[0])) for p in joint) <= 6, "dots along a joint of equal walls"
    cut, said = draw(here + "/plan.toml", "--set", "edges.0.materials=1")
    assert "drawn as lines" in said, said
    dark = lambda x, y: sum(cut.at(x, y)) < 250
    # 100 pixels a unit, the origin at (50, 370). Brick meets insulation at y = 0.3, the column at x = 7 and 7.3.
    for x in (100, 200, 600, 900):
        assert any(dark(x, 370 + offset - 30) for offset in (-1, 0, 1)), "between brick and insulation at %d" % x
    for x in (750, 780):
        assert any(dark(x + offset, 357) for offset in (-1, 0, 1)), "beside the column"
    for x in (350, 550):
        lines = [sum(cut.at(x + offset, y)) for offset in range(-3, 4) for y in range(346, 367)]
        assert min(lines) > 350, "no line between equal walls at %d: %d" % (x, min(lines))
    sheet = [any(dark(x, y) for y in range(208, 213)) for x in range(372, 468)]
    assert all(sheet), "the sheet leaves its line"


@report
def z_up_38():
    house = folder("38") + "/house.obj"
    lying, said = draw(house)
    assert said.count("--up z") == 1, said
    standing, said = draw(house, "--up", "z")
    assert "--up" not in said, said
    run("init", house, "--up", "z", "--output", "house")
    begun, _ = draw("house/house.toml")
    assert_same_place(standing, begun)
    assert len(standing.covered() ^ lying.covered()) > 0.05 * len(lying.covered())


def from_the_mesh(number, *settings):
    """The report's scene, its lines taken from the mesh."""
    picture, _ = draw(folder(number) + "/draw.toml" if number == "29" else folder(number) + "/s1.toml",
                      "--set", "edges=mesh_lines", *settings)
    return picture


@report
def hidden_dashed_29():
    # As an SVG: hidden lines in layers of their own, each dash a part of its path.
    run("render", folder("29") + "/draw.toml", "--set", "edges=mesh_lines", "--set", "edges.hidden=3", "--output",
        "out.svg")
    svg = open("out.svg", encoding="utf-8").read()
    layers = set(re.findall(r'inkscape:label="([^"]*)"', svg))
    assert {"contours", "creases", "hidden-contours"} <= layers, layers
    hidden = svg[svg.index('<g id="hidden-contours"') : svg.index("</g>", svg.index('<g id="hidden-contours"'))]
    paths = re.findall(r' d="([^"]*)"', hidden)
    # Of a brick the three edges at its far lower corner are hidden: dashed, since each is much longer than a dash.
    assert sum(path.count("M") for path in paths) > 24, paths


@report
def thin_wires_34():
    picture = from_the_mesh("34", "--set", "edges.width=1px")
    # The cable hangs before nothing and the wall, from (94, 40) to (879, 5): ink in every column, and no gap.
    dark = {x for x in range(96, 878) for y in range(picture.height // 3) if picture.at(x, y)[0] < 200}
    assert dark == set(range(96, 878)), "the cable has gaps at %s" % sorted(set(range(96, 878)) - dark)[:9]


def main():
    if not os.path.isdir(REPORTS):
        print("LIMN_TEST_DATA names no folder with reports")
        return 77
    wanted = sys.argv[2:] or sorted(TESTS)
    failed = []
    with tempfile.TemporaryDirectory() as place:
        os.chdir(place)
        for number in wanted:
            try:
                TESTS[number]()
            except (AssertionError, subprocess.TimeoutExpired) as problem:
                failed.append(number)
                print("%s: %s" % (number, problem))
    print("%d of %d reports hold" % (len(wanted) - len(failed), len(wanted)))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
