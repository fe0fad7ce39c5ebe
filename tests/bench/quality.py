#!/usr/bin/env python3
"""Are promises kept, and at what price? /usr/bin/python3 tests/bench/quality.py LIMN [--only NAME]

For places and cameras that limn's model of cost was not made from, and several promised errors: draws with quality =
{ error = E }, measures the error of the whole picture beside rays of other seeds, and compares its time with the
cheapest settings that are enough among all of a sweep of rays and filter passes. Then draws with promised times.
Needs LIMN_TEST_DATA, numpy and scikit-image.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy
from skimage import io

HERE = os.path.dirname(os.path.abspath(__file__))
SCENES = os.path.join(HERE, "..", "..", "scenes")
DATA = os.environ.get("LIMN_TEST_DATA", "")
SIZE = (320, 180)
SAMPLES = 4
RAYS = (1, 2, 4, 8, 16, 32, 64)
TARGETS = (0.1, 0.05, 0.025)

# name: mesh or scene, radius, and a camera where the scene has none
PLACES = {
    "interior": (SCENES + "/interior/scene.toml", "0.6", None),
    "house": (SCENES + "/house/scene.toml", "0.8", None),
    "terrain": (SCENES + "/terrain/scene.toml", "'5%'", None),
    "solids": (SCENES + "/solids/scene.toml", "'5%'", None),
    "pink": (SCENES + "/pink/scene.toml", "'5%'", None),
    "room": (DATA + "/ao_scenes/room.obj", "0.5", "position = [1.7, 1.9, 3.0]\nlook_at = [-1.0, 0.4, -2.0]\nfov = 75"),
    "thin": (DATA + "/ao_scenes/thin.obj", "0.4", "position = [2.2, 1.6, 2.9]\nlook_at = [0, 0.4, 0]\nfov = 60"),
    "bust": (DATA + "/ao_scenes/bust.obj", "0.3", "position = [1.4, 1.5, 2.0]\nlook_at = [0, 0.9, 0]\nfov = 50"),
    "sponza": (DATA + "/sponza_architecture/sponza.obj", "60",
               "position = [-700, 300, 100]\nlook_at = [400, 350, -150]\nfov = 80"),
    "metal": (DATA + "/baroque_table/METAL.obj", "'5%'", None),
}


def run(limn, config, *settings, output):
    stats = output + ".json"
    command = [limn, "--quiet", "render", config, "--output", output, "--stats", stats]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        return None, done.stderr.strip()
    report = json.load(open(stats))
    name = output.replace(".png", ".ambient_occlusion.png")
    return (io.imread(name) / 65535.0, report["frames"][0]["parts"]["draw"] / 1000), report.get("quality")


def config_of(folder, name):
    scene, radius, camera = PLACES[name]
    if camera:
        with open(folder + "/%s_scene.toml" % name, "w") as file:
            file.write("[[mesh]]\nname = 'm'\nfile = '%s'\n[[camera]]\n%s\n" % (scene, camera))
        scene = folder + "/%s_scene.toml" % name
    path = folder + "/%s.toml" % name
    with open(path, "w") as file:
        file.write("scene = '%s'\n[image]\nsize = [%d, %d]\nsamples = %d\n[ao]\ntechnique = 'gtao'\nradius = %s\n"
                   "[output]\npath = 'p.png'\naovs = ['ambient_occlusion']\nbits = 16\n"
                   % (os.path.abspath(scene), *SIZE, SAMPLES, radius))
    return path


def surfaces(limn, config, folder):
    """Where a surface is at the pixel's centre."""
    output = folder + "/seen.png"
    command = [limn, "--quiet", "render", config, "--output", output, "--set", "image.samples=1", "--set",
               "image.background=transparent", "--set", "output.aovs=['beauty']", "--set", "ao={technique='hbao'}"]
    subprocess.run(command, check=True)
    return io.imread(output)[:, :, 3] > 0


def traced(rays, passes):
    ao = "technique = 'ray_traced', rays = %d" % rays
    return ao + (", filter = { technique = 'plane_aware', passes = %d }" % passes if passes else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("limn")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    limn = os.path.abspath(options.limn)
    kept = asked = 0
    ratios, times = [], []
    with tempfile.TemporaryDirectory() as folder:
        for name in PLACES:
            if options.only not in name or not os.path.exists(PLACES[name][0]):
                continue
            config = config_of(folder, name)
            radius = PLACES[name][1]
            draw = lambda ao, *more: run(limn, config, "ao={ %s, radius = %s }" % (ao, radius), *more,
                                         output=folder + "/x.png")[0]
            all_samples = "image.ao_samples=%d" % SAMPLES
            truth = numpy.mean([draw(traced(256, 0), all_samples, "image.seed=%d" % seed)[0] for seed in (71, 72)], 0)
            seen = surfaces(limn, config, folder)
            error = lambda picture: float(numpy.sqrt(numpy.mean((picture - truth)[seen] ** 2)))
            sweep = []
            for passes in (0, 1, 3):
                for rays in RAYS:
                    runs = [draw(traced(rays, passes)) for _ in range(2)]
                    sweep.append((min(time for _, time in runs), error(runs[0][0]), rays, passes))
            for target in TARGETS:
                enough = [s for s in sweep if s[1] <= target]
                result, said = run(limn, config, "quality.error=%g" % target, output=folder + "/q.png")
                if result is None:
                    print("%-10s %.3f  refused: %s" % (name, target, said[:90]))
                    continue
                again = [run(limn, config, "quality.error=%g" % target, output=folder + "/q.png")[0][1]
                         for _ in range(3)]
                got = error(result[0])
                asked += 1
                kept += got <= target
                ratio = min(again) / min(enough)[0] if enough else float("nan")
                ratios.append(ratio)
                print("%-10s %.3f  got %.4f  %s   %.3f s, cheapest %s   ratio %.2f   (%s)" % (
                    name, target, got, "kept  " if got <= target else "BROKEN", min(again),
                    "%.3f s (%d rays, %d passes)" % (min(enough)[0], *min(enough)[2:]) if enough else "-", ratio,
                    said[0]), flush=True)
            for seconds in (0.25, 1.0):
                result, said = run(limn, config, "quality.seconds=%g" % seconds, output=folder + "/s.png")
                if result is None:
                    print("%-10s %.2f s  refused: %s" % (name, seconds, said[:90]))
                    continue
                took = sorted(run(limn, config, "quality.seconds=%g" % seconds, output=folder + "/s.png")[0][1]
                              for _ in range(3))[1]
                times.append(took / seconds)
                print("%-10s %.2f s  took %.3f s  (%+.0f %%)" % (name, seconds, took, 100 * (took / seconds - 1)),
                      flush=True)
    print("errors: %d of %d promises kept; time over the cheapest: median %.2f, largest %.2f" % (
        kept, asked, numpy.nanmedian(ratios), numpy.nanmax(ratios)))
    print("times: %d of %d within 20 %%" % (sum(abs(t - 1) <= 0.2 for t in times), len(times)))


if __name__ == "__main__":
    sys.exit(main())
