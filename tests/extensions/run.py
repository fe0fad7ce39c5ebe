#!/usr/bin/env python3
"""Adds one thing of each kind to a copy of the sources, builds it once, and draws with what was added:

    python3 tests/extensions/run.py FOLDER

Each folder beside this script is one extension: files to add, and in change.patch what must be edited. The effect of
the tutorial in src/README.md is taken from that page. Prints how many files each touches; more than here is a defect of
the sources' layout.
"""

import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(TOP, "tests", "bench"))
import compare_builds  # noqa: E402

# Files added and files changed.
TOUCHED = {
    "ao_technique": (2, 0),
    "aov": (0, 2),
    "filter_of_two_shaders": (3, 0),
    "geometry": (3, 0),
    "image_format": (1, 0),
    "line_source": (0, 2),
    "scene_format": (1, 0),
    "slot": (2, 1),
    "tutorial": (2, 0),
}


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    if done.returncode:
        sys.exit("%s\n%s%s" % (" ".join(command), done.stdout[-4000:], done.stderr[-4000:]))
    return done.stdout


def copy_sources(target):
    listed = run(["git", "ls-files", "-co", "--exclude-standard"], cwd=TOP).split("\n")
    for name in filter(None, listed):
        if name.startswith(("scenes/", "render_configs/", "tests/")) or not os.path.isfile(os.path.join(TOP, name)):
            continue
        os.makedirs(os.path.dirname(os.path.join(target, name)), exist_ok=True)
        shutil.copy2(os.path.join(TOP, name), os.path.join(target, name))


def put(target, name, text):
    path = os.path.join(target, name)
    if os.path.exists(path):
        sys.exit(name + " is there already")
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as f:
        f.write(text)


def tutorial(target):
    """The fenced blocks of the page, by the file that the text before each names."""
    page = open(os.path.join(TOP, "src", "README.md")).read()
    page = page[page.index("## Your first effect") :]
    for language, path in (("cpp", "src/effects/filter/levels.cpp"), ("glsl", "shaders/effects/filter/levels.comp")):
        if "`%s`" % path not in page:
            sys.exit("the tutorial does not name " + path)
        put(target, path, page.split("```%s\n" % language)[1].split("```")[0])
    return page.split("```toml\n")[1].split("```")[0]


def extend(target):
    """Applies every extension; returns what each touches, and the tutorial's config."""
    touched = {"tutorial": (2, 0)}
    config = tutorial(target)
    for name in sorted(os.listdir(HERE)):
        folder = os.path.join(HERE, name)
        if not os.path.isdir(folder) or name.startswith("__"):
            continue
        added = changed = 0
        for root, _, files in os.walk(folder):
            for file in files:
                path = os.path.relpath(os.path.join(root, file), folder)
                if path == "change.patch":
                    patch = open(os.path.join(folder, path)).read()
                    changed = patch.count("\n+++ ")
                    run(["patch", "-p1", "--no-backup-if-mismatch", "-i", os.path.join(folder, path)], cwd=target)
                else:
                    added += 1
                    put(target, path, open(os.path.join(folder, path)).read())
        touched[name] = (added, changed)
    return touched, config


def build(target):
    run(["cmake", "--preset", "ci", "-DLIMN_TESTS=OFF"], cwd=target)
    run(["ninja", "-C", os.path.join(target, "build", "ci"), "limn", "limn_oiio"])
    return os.path.join(target, "build", "ci", "limn")


BOX = (
    "".join("v %g %g %g\n" % (x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
    + "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
)

SCENE = """
[[mesh]]
name = "box"
file = "box.obj"
[[material]]
name = "red"
color = [0.75, 0.125, 0.125]
[[material]]
name = "green"
color = [0.125, 0.75, 0.125]
[[instance]]
mesh = "box"
material = "red"
[[instance]]
mesh = "box"
material = "green"
translate = [1, 0, 0]
[[camera]]
position = [1, 0.5, 8]
look_at = [1, 0.5, 0]
orthographic_height = 2
"""

# Boxes side by side on a third: hollows in plain view.
CORNER = (
    SCENE.split("[[camera]]")[0]
    + """
[[instance]]
mesh = "box"
translate = [-1, -1, 0]
scale = [4, 1, 4]
[[camera]]
position = [3, 3, 6]
look_at = [1, 0, 1]
"""
)

IMAGE = "[image]\nsize = [96, 64]\nsamples = 1\n"


class Drawing:
    """Draws configs in a folder of its own."""

    def __init__(self, limn, folder):
        self.limn, self.folder = limn, folder
        os.makedirs(folder, exist_ok=True)
        self.write("box.obj", BOX)
        self.write("scene.toml", SCENE)

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w") as f:
            f.write(text)

    def draw(self, config, output="picture.exr"):
        self.write("config.toml", config if "scene =" in config else 'scene = "scene.toml"\n' + config)
        run([self.limn, "--quiet", "render", "config.toml", "--output", output], cwd=self.folder)
        return open(os.path.join(self.folder, output), "rb").read()

    def channels(self, config):
        """Numbers of each channel."""
        return {
            name: compare_builds.numbers(*data) for name, data in compare_builds.exr_channels(self.draw(config)).items()
        }


def expect(condition, what):
    if not condition:
        sys.exit("wrong: " + what)


def rounded(values):
    return {round(v, 5) for v in values}


def check(drawing, tutorial_config):
    occlusion = "[output]\naovs = ['ambient_occlusion', 'object_id']\n"
    half = drawing.channels(IMAGE + "[ao]\ntechnique = 'half_open'\nopen = 0.25\n" + occlusion)
    open_ = [v for v, i in zip(half["ambient_occlusion.Y"], half["object_id.id"]) if i]
    expect(rounded(open_) == {0.25} and rounded(half["ambient_occlusion.Y"]) == {0.25, 1}, "half_open")

    plus = drawing.channels(IMAGE + "[ao]\ntechnique = 'half_open'\nfilter = 'plus'\n" + occlusion)
    expect(rounded(plus["ambient_occlusion.Y"]) == {0.5, 0.75, 0.875, 1}, "plus: 0.875 at the corners of 0.5 in 1")

    corner = Drawing(drawing.limn, os.path.join(drawing.folder, "corner"))
    corner.write("scene.toml", CORNER)
    levels = corner.channels(tutorial_config + IMAGE.replace("96, 64", "192, 128"))
    expect(rounded(levels["ambient_occlusion.Y"]) <= {0, 0.33333, 0.66667, 1}, "the tutorial's three levels")
    expect(len(rounded(levels["ambient_occlusion.Y"])) > 1, "the tutorial's picture has more than one of them")

    aovs = IMAGE + "[output]\naovs = ['object_id', 'depth']\n"
    plain, fast = drawing.channels("accuracy = 'plain'\n" + aovs), drawing.channels("accuracy = 'fast'\n" + aovs)
    expect(plain == fast and max(plain["object_id.id"]) == 2, "geometry plain is geometry fast")

    flat = IMAGE + "background = '#000000'\n[output]\naovs = ['beauty']\n"
    positive, negative = drawing.channels(flat), drawing.channels("grade = 'invert'\n" + flat)
    for name in "RGB":
        expect(all(abs(p + n - 1) < 1e-3 for p, n in zip(positive[name], negative[name])), "the negative")

    clay = drawing.channels(IMAGE + "[shading]\ntechnique = 'clay'\n[output]\naovs = ['beauty', 'clay_light']\n")
    expect(rounded(clay["clay_light.Y"]) == {0, 1}, "the AOV clay_light")

    lines = (
        IMAGE + "[[edges]]\ntechnique = 'depth_normal'\nsilhouettes = 0\ncreases = 0\n%s[output]\naovs = ['edges']\n"
    )
    drawn = drawing.channels(lines % "albedos = 1\n")["edges.A"]
    columns = {i % 96 for i, a in enumerate(drawn) if a > 0.5}
    expect(columns and columns <= {47, 48}, "a line where red meets green: columns %s" % columns)

    ppm = drawing.draw(flat, "picture.ppm")
    png = compare_builds.png_pixels(drawing.draw(flat, "picture.png"))[""]
    rows = png[13:]
    expect(ppm.startswith(b"P6\n96 64\n255\n"), "a PPM's head")
    unfiltered = b"".join(rows[y * (96 * 3 + 1) + 1 : (y + 1) * (96 * 3 + 1)] for y in range(64))
    expect(all(rows[y * (96 * 3 + 1)] == 0 for y in range(64)), "PNGs of colours are unfiltered")
    expect(ppm[len(b"P6\n96 64\n255\n") :] == unfiltered, "PPM and PNG show the same")

    drawing.write("second.obj", BOX.replace("v ", "o second\nv ", 1))
    drawing.write("two.list", "box.obj\nsecond.obj\n")
    listed = drawing.channels("scene = 'two.list'\n" + aovs)
    expect(max(listed["object_id.id"]) >= 1, "a scene that is a list")


def main():
    target = os.path.abspath(sys.argv[1])
    # What was built stays, so that the next run builds only what has changed.
    for name in ("src", "shaders"):
        shutil.rmtree(os.path.join(target, name), ignore_errors=True)
    copy_sources(target)
    touched, config = extend(target)
    for name, counts in sorted(touched.items()):
        print("%-24s %d files added, %d changed" % (name, *counts))
    expect(touched == TOUCHED, "how many files an extension touches: %s" % TOUCHED)
    check(Drawing(build(target), os.path.join(target, "pictures")), config)
    print("all of them draw what they should")


if __name__ == "__main__":
    main()
