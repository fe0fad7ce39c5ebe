"""Compares what limn draws of Blender files with what Blender itself renders, station by station.

python3 compare.py LIMN FOLDER [SHEET...]

Builds the sheets of stations in FOLDER by the make_*.py beside this. For each: exports it, runs `limn check` and `limn
render`, renders the same frames in Blender, and says of each station: right, named (wrong, but the exporter's summary
says so), SILENT (wrong without a word), or which step FAILS. Results also go to FOLDER/results.json. The exit code is 1
where a station is wrong that known.tsv does not list, and where one that it lists has become right.
"""

import argparse
import glob
import json
import os
import re
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
import png  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
EXPORTER = os.path.join(HERE, "..", "..", "..", "src", "blender", "export.py")
REACH = 2  # pixels that outlines may differ by
COLOR_ROOM = 0.035  # of a display-encoded channel
HARMLESS = ("subdivision before other modifiers",)  # words in summaries that do not say that a picture is wrong


def run(command, seconds=300):
    """A command's exit code and everything that it said."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=seconds)
        return done.returncode, done.stdout.decode("utf-8", "replace")
    except subprocess.TimeoutExpired:
        return -1, "took longer than %d s" % seconds


class Tools:
    """The exporter and limn as a person would call them."""

    def __init__(self, limn, work):
        self.limn, self.work = limn, work
        self.exporter = os.path.join(work, "export.py")
        with open(EXPORTER, encoding="utf-8") as file:
            text = file.read()
        # The summary names five things of a kind; here all of them are wanted.
        with open(self.exporter, "w", encoding="utf-8") as file:
            file.write(text.replace("names[:5]", "names[:999]").replace("len(names) > 5", "len(names) > 999"))

    def export(self, blend, out, arguments):
        return run(["blender", "-b", blend, "--python-exit-code", "1", "-P", self.exporter, "--", out, *arguments])

    def check(self, config):
        return run([self.limn, "check", config])

    def render(self, config, target, *more):
        return run([self.limn, "render", config, "--set", "image.samples=1", "--set", "output.bits=16",
                    "--set", 'output.aovs=["beauty","albedo"]', "--set", "image.background=transparent",
                    "--output", target, *more])

    def reference(self, sheet_path, blend, out):
        return run(["blender", "-b", blend, "--python-exit-code", "1", "-P", os.path.join(HERE, "reference.py"), "--",
                    sheet_path, out])


# Pictures.


def encoded(linear):
    linear = min(max(linear, 0.0), 1.0)
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055


def mask_of(picture, rect):
    """Pixels of a station, from its upper left corner."""
    left, top, right, bottom = rect
    return {(x - left, y - top) for y in range(top, min(bottom, picture.height))
            for x in range(left, min(right, picture.width)) if picture.rows[y][x][3] > 0.5}


def strangers(mask, other):
    """How many pixels of a mask have none of the other within reach."""
    near = range(-REACH, REACH + 1)
    return sum(1 for x, y in mask - other if not any((x + i, y + j) in other for i in near for j in near))


def bounds(mask):
    xs, ys = [x for x, _ in mask], [y for _, y in mask]
    return min(xs), min(ys), max(xs), max(ys)


def compare_masks(theirs, ours):
    """Whether two sets of pixels are the same to within the reach, and a few words."""
    if not theirs and not ours:
        return True, "empty"
    if not theirs or not ours:
        return False, "drawn, should be empty" if ours else "not drawn"
    union = len(theirs | ours)
    apart = strangers(theirs, ours) + strangers(ours, theirs)
    (ax, ay), (bx, by) = (tuple(sum(v) / len(m) for v in zip(*m)) for m in (theirs, ours))
    shift = max(abs(a - b) for a, b in zip(bounds(theirs), bounds(ours)))
    words = "IoU %.2f, centroid %.1f px, bounds %d px" % (
        len(theirs & ours) / union, ((ax - bx) ** 2 + (ay - by) ** 2) ** 0.5, shift)
    same = apart <= max(3, union // 150) and shift <= REACH + 1 and len(theirs & ours) >= 0.95 * union
    return same, words


def even_pixels(picture, rect, common, decode):
    """Pixels around which the colour stays the same; all if these are few."""
    left, top = rect[:2]
    colors = {(x, y): decode(picture.rows[top + y][left + x]) for x, y in common}
    near = [(i, j) for i in (-REACH, 0, REACH) for j in (-REACH, 0, REACH)]
    even = {(x, y) for x, y in common
            if all(max(abs(a - b) for a, b in zip(colors[x, y], colors.get((x + i, y + j), colors[x, y])))
                   < COLOR_ROOM for i, j in near)}
    return even if len(even) > len(common) // 5 else common


def compare_colors(theirs, ours, rect, common, decode):
    """Share of the common pixels whose colour is none of those around the same place, and an example."""
    left, top = rect[:2]
    wrong, example = 0, ""
    common = even_pixels(theirs, rect, common, decode)
    for x, y in common:
        color = ours.rows[top + y][left + x][:3]
        best = min(max(abs(a - b) for a, b in zip(color, decode(theirs.rows[top + y + j][left + x + i])))
                   for i in (-1, 0, 1) for j in (-1, 0, 1) if (x + i, y + j) in common)
        if best > COLOR_ROOM:
            wrong += 1
            if wrong == 1 + len(common) // 40:
                wanted = decode(theirs.rows[top + y][left + x])
                example = "(%.2f %.2f %.2f) instead of (%.2f %.2f %.2f)" % (*color, *wanted)
    return wrong / max(1, len(common)), example


def compare_station(theirs, ours, rect, mask_only=False):
    if (theirs.width, theirs.height) != (ours.width, ours.height):
        return False, "picture %dx%d instead of %dx%d" % (ours.width, ours.height, theirs.width, theirs.height)
    a, b = mask_of(theirs, rect), mask_of(ours, rect)
    same, words = compare_masks(a, b)
    if mask_only:
        return same, words
    share, example = compare_colors(theirs, ours, rect, a & b, lambda p: tuple(encoded(c) for c in p[:3]))
    if share > 0.03:
        return False, words + ", colour wrong in %.0f %%: %s" % (100 * share, example)
    return same, words


# Sheets.


def config_of(out, camera):
    """The config that the exporter wrote for a camera."""
    for path in sorted(glob.glob(os.path.join(glob.escape(out), "*.toml"))):
        with open(path, encoding="utf-8") as file:
            text = file.read()
        if os.path.basename(path) != "scene.toml" and 'camera = "%s"' % camera in text:
            return path
    return None


def summary_about(code, said, pattern=None):
    """What the exporter's summary says about a station."""
    lines = [line.split("left out:", 1)[1].strip() for line in said.splitlines() if "left out:" in line]
    wanted = pattern or r"\b%s\b" % re.escape(code)
    return "; ".join(line.split(":")[0] for line in lines
                     if re.search(wanted, line) and not line.startswith(HARMLESS))


def picture_at(folder, stem, frame, still, kind=""):
    names = [stem + kind + ".png"] if still else []
    number = "%04d" % frame if frame >= 0 else "-%04d" % -frame
    names += ["%s_%s%s.png" % (stem, number, kind), "%s%s_%s.png" % (stem, kind, number)]
    for name in names:
        if os.path.exists(os.path.join(folder, name)):
            return os.path.join(folder, name)
    return None


def failure(text):
    """The lines of a program's output that say why it failed."""
    quiet = ("warning", "Saved", "Blender")
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith(quiet)]
    telling = [line for line in lines if re.search(r"error|Error|missing|not|cannot", line)]
    return " / ".join((telling or lines)[-2:])[:260]


def produce(sheet, sheet_path, blend, folder, tools):
    """Runs everything on one sheet; returns (the step that failed or None, why, the exporter's words, config)."""
    out = os.path.join(folder, "out")
    code, said = tools.export(blend, out, sheet["arguments"])
    with open(os.path.join(folder, "export.log"), "w", encoding="utf-8") as file:
        file.write(said)
    if code:
        return "EXPORT FAILS", failure(said), said, None
    config = config_of(out, sheet["camera"])
    if config is None:
        return "NO CONFIG", "no config for camera " + sheet["camera"], said, None
    code, checked = tools.check(config)
    if code:
        return "CHECK FAILS", failure(checked), said, config
    still = "--frames" not in sheet["arguments"]
    target = os.path.join(folder, "limn.png" if still else "limn_####.png")
    code, rendered = tools.render(config, target, *sheet.get("limn", []))
    if code:
        return "RENDER FAILS", failure(rendered), said, config
    code, made = tools.reference(sheet_path, blend, folder)
    if code:
        return "REFERENCE FAILS", failure(made), said, config
    return None, "", said, config


def judge(station, sheet, folder, said):
    """The class of a station and why."""
    still = "--frames" not in sheet["arguments"]
    wrong, words = [], ""
    for frame in station.get("frames", sheet["frames"]):
        theirs = png.read(os.path.join(folder, "ref_%d.png" % frame))
        path = picture_at(folder, "limn", frame, still, ".albedo")
        same, words = compare_station(theirs, png.read(path), station["rect"], sheet.get("mask_only")) if path else (
            False, "no picture")
        if station.get("empty") and mask_of(theirs, station["rect"]):
            words += " (TEST: reference should be empty)"
        if not same:
            wrong.append(("frame %d: " % frame if len(sheet["frames"]) > 1 else "") + words)
    if not wrong:
        return "right", words
    told = summary_about(station["code"], said, station.get("named_by"))
    if not told and len(sheet["stations"]) == 1:  # what is said of the camera
        told = summary_about("", said, r"\b%s\b" % re.escape(sheet["camera"]))
    return ("named" if told else "SILENT"), "; ".join(wrong[:2]) + (" [said: %s]" % told if told else "")


def compare_sheet(sheet_path, tools):
    with open(sheet_path, encoding="utf-8") as file:
        sheet = json.load(file)
    blend, folder = sheet_path[:-5] + ".blend", os.path.join(tools.work, sheet["name"])
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    step, why, said, _ = produce(sheet, sheet_path, blend, folder, tools)
    results = []
    for station in sheet["stations"]:
        kind, reason = (step, why) if step else judge(station, sheet, folder, said)
        results.append(dict(station, sheet=sheet["name"], kind=kind, why=reason))
    return results


def table(results):
    for result in results:
        print("%-5s %-13s %-70s %s" % (result["code"], result["kind"], result["title"][:70], result["why"]))
    kinds = sorted({result["kind"] for result in results})
    print("\n" + ", ".join("%d %s" % (sum(r["kind"] == kind for r in results), kind) for kind in kinds))


def build(blends):
    """Makes the sheets: libraries first, since others link them."""
    makers = sorted(glob.glob(os.path.join(HERE, "make_*.py")), key=lambda path: "libraries" not in path)
    os.environ["STATIONS_BLENDS"] = blends
    for maker in makers:
        code, said = run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "-P", maker])
        if code:
            sys.exit("%s ends with %d\n%s" % (maker, code, said))


def known():
    """Stations that are known to be wrong: code -> class."""
    with open(os.path.join(HERE, "known.tsv"), encoding="utf-8") as file:
        return {line.split("\t")[0]: line.split("\t")[1] for line in file if line.strip() and line[0] != "#"}


def surprises(results, expected):
    for result in results:
        wanted = expected.get(result["code"], "right or named")
        if result["kind"] not in wanted.split(" or "):
            yield "%s is %s instead of %s: %s" % (result["code"], result["kind"], wanted, result["why"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("limn")
    parser.add_argument("folder")
    parser.add_argument("sheets", nargs="*", help="names of sheets; all without")
    arguments = parser.parse_args()
    if not shutil.which("blender"):
        sys.exit(77)
    blends, work = (os.path.join(os.path.abspath(arguments.folder), name) for name in ("blends", "work"))
    for folder in (blends, work):
        os.makedirs(folder, exist_ok=True)
    build(blends)
    tools = Tools(os.path.abspath(arguments.limn), work)
    names = arguments.sheets or sorted(os.path.basename(p)[:-5] for p in glob.glob(os.path.join(blends, "*.json")))
    results = []
    for name in names:
        results += compare_sheet(os.path.join(blends, name + ".json"), tools)
    table(results)
    with open(os.path.join(arguments.folder, "results.json"), "w", encoding="utf-8") as file:
        json.dump(results, file, indent=1, ensure_ascii=False)
    found = list(surprises(results, known()))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
