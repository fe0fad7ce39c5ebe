#!/usr/bin/env python3
"""Studies, as a person makes and reads them: python3 tests/study/study.py LIMN [--pictures FOLDER]

Studies a small scene, and checks what is left behind by readers that share nothing with limn: Chromium runs the page,
scikit-image computes the similarity of the pictures, Python reads JSON and CSV. A study that goes on measures nothing
again, and a point's config lines give its errors again to the last digit. --pictures keeps screenshots of the page.
"""

import argparse
import csv
import io
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile

SCENE = """
[[mesh]]
name = "floor"
file = "floor.obj"
[[mesh]]
name = "ball"
file = "ball.obj"
subdivision = { level = 3 }
[[camera]]
name = "front"
position = [1.5, 2, 4]
look_at = [0, 0.4, 0]
[[light]]
direction = [-1, -2, -1]
shadow = { resolution = 512 }
"""
CONFIG = """
scene = "scene.toml"
[image]
size = [96, 64]
samples = 2
[ao]
technique = "hbao"
radius = 0.8
filter = { technique = "plane_aware" }
[shading]
technique = "toon"
[[edges]]
technique = "depth_normal"
[output]
path = "picture.png"
[study]
samples = 32
rays = 256
"""
SIMILARITY = """
import sys
from skimage import io
from skimage.metrics import structural_similarity
gray = [io.imread(path)[:, :, :3] @ [0.2126 / 255, 0.7152 / 255, 0.0722 / 255] for path in sys.argv[1:]]
_, every = structural_similarity(*gray, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1,
                                 full=True)
print(every.mean())
"""


def box(low, high):
    corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    text = "".join("v %g %g %g\n" % tuple(c) for c in corners)
    faces = ((1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6))
    return text + "".join("f %d %d %d %d\n" % f for f in faces)


def write(path, text):
    with open(path, "w") as file:
        file.write(text)


def run(*command, fails=False):
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert fails or done.returncode == 0, (command, done.returncode, done.stderr)
    return done


def study(limn, config, *more):
    return run(limn, "study", config, *more)


def check_files(folder):
    report = json.load(open(folder + "/study.json"))
    points = report["points"]
    with open(folder + "/study.csv") as file:
        rows = list(csv.DictReader(io.StringIO(file.read())))
    assert len(rows) == len(points) > 20, (len(rows), len(points))
    for row, point in zip(rows, points):
        assert abs(float(row["picture_rmse"]) - point["picture"]["rmse"]) < 1e-6
        assert abs(float(row["occlusion_rmse"]) - point["occlusion"]["rmse"]) < 1e-6
        assert point["runs"] == 9 and point["low"] <= point["milliseconds"] <= point["high"], point
    kinds = {point["kind"] for point in points}
    assert kinds == {"config", "knob", "technique", "refined"}, kinds
    knobs = {point["knob"] for point in points}
    wanted = {"image.samples", "image.ao_samples", "accuracy", "ao.directions", "ao.steps", "ao.filter.passes",
              "scene.subdivision.level", "scene.shadow.resolution"}
    assert wanted <= knobs, wanted - knobs
    techniques = {point["group"].split(",")[0] for point in points}
    assert {"hbao", "gtao", "ray_traced", "visibility_bitmask"} <= techniques, techniques
    by_name = {point["name"]: point for point in points}
    for measure, front in report["fronts"].items():
        on = [by_name[name] for name in front["points"]]
        errors = [point[measure]["rmse"] for point in on]
        assert errors == sorted(errors, reverse=True), "a front falls"
        for point in points:
            assert not any(point["milliseconds"] < p["milliseconds"] and point[measure]["rmse"] < p[measure]["rmse"]
                           for p in on), "nothing beats the front"
    return report


def value_of(points, **wanted):
    for point in points:
        if all(point["settings"].get(key.replace("__", ".")) == value for key, value in wanted.items()) and \
                len(point["settings"]) == len(wanted):
            return point
    raise AssertionError(wanted)


def check_truths(report):
    """What must be true of any study."""
    points = report["points"]
    base = points[0]
    assert not base["settings"]
    coarse = value_of(points, scene__subdivision__level="-2")
    assert coarse["geometry"]["rmse"] > 2 * base["geometry"]["rmse"] > 0, "fewer levels lie farther off"
    one = value_of(points, image__samples="1")
    assert one["picture"]["rmse"] > base["picture"]["rmse"], "one sample is worse than two"
    traced = [p for p in points if p["group"].startswith("ray_traced")]
    assert min(p["occlusion"]["rmse"] for p in traced) < base["occlusion"]["rmse"], "rays come nearest to rays"
    split = [p for p in points if "split" in p]
    # What a depth buffer does not know is no part of the error of rays.
    assert split and all((p["split"]["unseen"] > 0) != p["group"].startswith("ray_traced") for p in split)
    assert report["truth_error"] < 0.02, report["truth_error"]


def check_similarity(limn, config, folder, report):
    """The study's similarity beside scikit-image's, of the same pictures."""
    picture = folder + "/again.png"
    run(limn, "render", config, "--output", picture)
    # Debian's Python has Debian's packages, whichever Python runs this.
    done = run("/usr/bin/python3", "-c", SIMILARITY, picture, folder + "/pictures/truth.png", fails=True)
    if "No module named 'skimage'" in done.stderr:
        return "SSIM not compared: scikit-image is missing"
    theirs, ours = float(done.stdout), report["points"][0]["picture"]["ssim"]
    # Theirs come from pictures of 8 bits, whose rounding takes a little likeness from flat places.
    assert abs(theirs - ours) < 0.002, (theirs, ours)
    return "SSIM %.5f, scikit-image %.5f" % (ours, theirs)


def check_going_on(limn, config, folder):
    before = json.load(open(folder + "/study.json"))
    done = study(limn, config, "--output", folder, "--budget", "1")
    assert "goes on after" in done.stderr, done.stderr
    after = json.load(open(folder + "/study.json"))
    assert after["points"][: len(before["points"])] == before["points"], "known points stay as they are"


def check_lines(limn, folder, report):
    """A config with a point's lines has that point's errors."""
    front = report["fronts"]["occlusion"]["points"]
    named = {p["name"]: p for p in report["points"]}
    # What belongs into the scene cannot be pasted into a config.
    point = [named[name] for name in front if not any(key.startswith("scene.") for key in named[name]["settings"])
             and named[name]["settings"]][-1]
    top, _, image = point["lines"].partition("[image]\n")
    assert top, point
    config = CONFIG
    for line in filter(None, top.splitlines()):
        table = line.split(" ")[0]
        config = re.sub(r"(?ms)^\[\[?%s\]\]?\n.*?(?=^\[)" % table, "", config)
        config = line + "\n" + config
    for line in image.splitlines():
        key = line.split(" ")[0]
        config = re.sub(r"(?m)^%s = .*\n" % key, "", config)
        config = config.replace("[image]\n", "[image]\n%s\n" % line)
    write(folder + "/pasted.toml", config)
    study(limn, folder + "/pasted.toml", "--output", folder + "/pasted", "--budget", "1")
    again = json.load(open(folder + "/pasted/study.json"))["points"][0]
    for measure in ("picture", "occlusion", "geometry"):
        assert again[measure] == point[measure], (measure, again[measure], point[measure])


def browse(page, size, *more):
    return run("chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
               "--virtual-time-budget=4000", "--window-size=%d,%d" % size, *more, page).stdout


def check_page(folder, report, pictures):
    if not shutil.which("chromium"):
        return "page not opened: Chromium is missing"
    page = "file://" + os.path.abspath(folder) + "/index.html"
    text = open(folder + "/index.html").read()
    assert not re.search(r"(src|href)=\"https?:", text), "the page needs nothing else"
    front = report["fronts"]["picture"]["points"]
    wanted = "#a=%s&b=truth&measure=picture&view=beauty" % front[0]
    # A script drives the page as a person would, and says what it saw.
    driven = text.replace("</body>", """<script>
      const key = (k, shift) => document.body.dispatchEvent(
        new KeyboardEvent("keydown", { key: k, shiftKey: shift, bubbles: true }));
      const said = [location.hash, chart.data.datasets.length];
      key("ArrowRight"); said.push(points[a].name);
      key("ArrowRight", true); said.push(points[b].name);
      document.querySelector("#rows tr").dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
      said.push(points[a].milliseconds === Math.min(...points.map((p) => p.milliseconds)));
      byId("slider").value = 25; byId("slider").oninput(); said.push(byId("over").style.clipPath);
      said.push(byId("imageA").naturalWidth, byId("imageB").naturalWidth);
      said.push(document.documentElement.scrollWidth <= innerWidth);
      document.title = "SAID " + JSON.stringify(said) + " END";
    </script></body>""")
    write(folder + "/driven.html", driven)
    for size in ((1400, 1000), (500, 900)):  # no window is narrower in Chromium
        seen = browse(page.replace("index", "driven") + wanted, size, "--dump-dom")
        said = json.loads(re.search(r"SAID (.*) END", seen).group(1).replace("&amp;", "&"))
        assert "a=" + front[0] in said[0] and said[1] > 3, said
        assert said[2] == front[min(1, len(front) - 1)], (said, front)
        assert said[3] in front and said[4] is True and "25%" in said[5], said
        assert said[6] == 96 and said[7] == 96, said
        assert said[8] is True, "nothing is wider than the page: %s" % said
    if pictures:
        os.makedirs(pictures, exist_ok=True)
        for name, size, dark in (("desktop", (1400, 1900), False), ("phone", (500, 2600), False),
                                 ("dark", (1400, 1900), True)):
            more = ["--force-dark-mode", "--enable-features=WebContentsForceDark:inversion_method/none"] if dark else []
            browse(page + wanted, size, "--screenshot=%s/%s.png" % (os.path.abspath(pictures), name), *more)
    return "page driven in Chromium at two widths"


def check_refusals(limn, folder):
    for lines, code, said in (("[study]\nrepat = 3\n", 64, "repeat"), ("[study]\ncameras = ['x']\n", None, "camera"),
                              ("[study]\nrays = 3\n", 64, "rays")):
        write(folder + "/bad.toml", CONFIG.split("[study]")[0] + lines)
        done = run(limn, "study", folder + "/bad.toml", "--budget", "1", fails=True)
        assert done.returncode not in (0, 70) and said in done.stderr, (lines, done.returncode, done.stderr)
        assert code is None or done.returncode == code, (lines, done.returncode)


def metadata(path):
    """Texts of a PNG."""
    data, at, texts = open(path, "rb").read(), 8, {}
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        at += 12 + length
        if kind == b"tEXt":
            key, _, value = body.partition(b"\0")
            texts[key.decode()] = value.decode("latin-1")
        elif kind == b"iTXt":
            key, _, rest = body.partition(b"\0")
            texts[key.decode()] = rest.split(b"\0")[-1].decode()
    return texts


def check_promises(limn, folder):
    """What a promise chooses is kept beside the picture, and does what its lines say."""
    config = folder + "/promise.toml"
    plain = CONFIG.split("[study]")[0]
    write(config, plain.replace("[image]", "quality = { error = 0.05 }\n[image]", 1))
    picture, kept = folder + "/kept.png", folder + "/kept.promise.quality.toml"
    first = run(limn, "render", config, "--output", picture, "--stats", folder + "/stats.json")
    assert "looks for settings" in first.stderr and "error 0.05 promised" in first.stderr, first.stderr
    said = metadata(picture)["limn.quality"]
    assert said.startswith("error 0.05 promised, 0.0"), said
    assert json.load(open(folder + "/stats.json"))["quality"] == [said]
    bytes_of = lambda path: open(path, "rb").read()
    drawn = bytes_of(picture)
    again = run(limn, "render", config, "--output", picture, "--threads", "1", "--set", "image.tile=0")
    # Another --set is another config; the same one again is not chosen again.
    again = run(limn, "render", config, "--output", picture, "--threads", "1")
    assert "looks for settings" in again.stderr, "another config was drawn in between"
    again = run(limn, "render", config, "--output", picture, "--threads", "1")
    assert "looks for settings" not in again.stderr and bytes_of(picture) == drawn, again.stderr
    resumed = run(limn, "render", config, "--output", picture, "--resume")
    assert "Kept:" in resumed.stderr, resumed.stderr
    os.remove(kept)
    run(limn, "render", config, "--output", picture, "--threads", "1")
    assert bytes_of(picture) == drawn, "chosen anew, the same is chosen"

    lines = re.findall(r"(?m)^#     (.*)$", open(kept).read())
    assert lines and lines[0].startswith("ao = "), lines
    pasted = re.sub(r"(?ms)^\[ao\]\n.*?(?=^\[)", "", plain)
    write(folder + "/lines.toml", "\n".join(lines) + "\n" + pasted + "[study]\nrays = 1024\ntechniques = false\n")
    study(limn, folder + "/lines.toml", "--output", folder + "/lines", "--budget", "1")
    got = json.load(open(folder + "/lines/study.json"))["points"][0]["occlusion"]
    # The study's truth is smoothed over pixels: what is inside of surfaces does not depend on that.
    assert got["inside"] <= 0.05, got

    for quality, part in (("{ error = 0.00002 }", "cannot be promised"), ("{ seconds = 0.001 }", "cannot be kept"),
                          ("{ error = 0.1, seconds = 1 }", "one of"), ("{ }", "one of"),
                          ("{ error = 2 }", "1e-05 to 1")):
        write(config, plain.replace("[image]", "quality = %s\n[image]" % quality, 1))
        done = run(limn, "render", config, "--output", folder + "/never.png", fails=True)
        assert done.returncode == 64 and part in done.stderr, (quality, done.returncode, done.stderr)
        assert not os.path.exists(folder + "/never.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("limn")
    parser.add_argument("--pictures", default="")
    options = parser.parse_args()
    limn = os.path.abspath(options.limn)
    with tempfile.TemporaryDirectory() as folder:
        write(folder + "/floor.obj", box((-3, -0.2, -3), (3, 0, 3)))
        write(folder + "/ball.obj", box((-0.6, 0.05, -0.6), (0.6, 1.25, 0.6)))
        write(folder + "/scene.toml", SCENE)
        config = folder + "/config.toml"
        write(config, CONFIG)
        output = folder + "/out"
        study(limn, config, "--output", output, "--budget", "25")
        report = check_files(output)
        check_truths(report)
        plain = folder + "/plain.toml"
        write(plain, CONFIG.split("[study]")[0])
        said = [check_similarity(limn, plain, output, report), check_page(output, report, options.pictures)]
        check_lines(limn, folder, report)
        check_going_on(limn, config, output)
        check_refusals(limn, folder)
        check_promises(limn, folder)
        print("%d settings studied; %s" % (len(report["points"]), "; ".join(said)))


if __name__ == "__main__":
    sys.exit(main())
