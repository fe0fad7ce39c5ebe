#!/usr/bin/env python3
"""Ambient occlusion beside EEVEE's, on one chart: /usr/bin/python3 tests/bench/peers_ao.py LIMN [--chart FILE.svg]

Three scenes of LIMN_TEST_DATA from one camera each, at 640x360, in one run on one machine. The truth is neither's own:
Cycles' ambient occlusion with 512 samples, which lies beside the scenes. Seconds: limn's drawing, in a process of its
own; EEVEE's second render, start-up excluded. Errors: over the pixels that show a surface away from edges, all scenes
together.
Needs blender, numpy and scikit-image.
"""

import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile

import numpy
from skimage import io

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.environ.get("LIMN_TEST_DATA") or sys.exit("LIMN_TEST_DATA names no folder of test data")
FOV = 91.49284228186366  # 60 degrees from top to bottom at 16:9
PLACES = {
    "room": ("0.3, 1.6, 4.8", "-0.1, 1.1, -3", 0.5),
    "thin": ("2.7, 1.8, 3.6", "0, 0.45, 0.3", 0.5),
    "bust": ("1.6, 1.6, 2.6", "0, 0.95, 0", 0.3),
}
OURS = {
    "gtao": "technique = 'gtao'",
    "gtao, filtered": "technique = 'gtao', filter = 'plane_aware'",
    "2 rays, filtered": "technique = 'ray_traced', rays = 2, filter = 'plane_aware'",
    "4 rays, filtered": "technique = 'ray_traced', rays = 4, filter = 'plane_aware'",
    "16 rays, filtered": "technique = 'ray_traced', rays = 16, filter = { technique = 'plane_aware', passes = 1 }",
    "64 rays": "technique = 'ray_traced', rays = 64",
    "256 rays": "technique = 'ray_traced', rays = 256",
}


def gray(path):
    picture = io.imread(path) / 65535.0
    return picture if picture.ndim == 2 else picture[:, :, 0]


def inside(truth):
    """Surfaces away from edges, where programs differ in which side a pixel shows."""
    padded = numpy.pad(truth, 1, mode="edge")
    around = [padded[1 + dy : 1 + dy + truth.shape[0], 1 + dx : 1 + dx + truth.shape[1]]
              for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    return (truth > 0) & (numpy.max(around, 0) - numpy.min(around, 0) < 0.1)


def limn_draws(limn, folder, place, ao):
    position, target, radius = PLACES[place]
    with open(folder + "/scene.toml", "w") as file:
        file.write("[[mesh]]\nname = 'm'\nfile = '%s/ao_scenes/%s.obj'\n[[camera]]\nposition = [%s]\nlook_at = [%s]\n"
                   "fov = %r\n" % (DATA, place, position, target, FOV))
    with open(folder + "/config.toml", "w") as file:
        file.write("scene = 'scene.toml'\nao = { %s, radius = %g }\n[image]\nsize = [640, 360]\nsamples = 1\n[output]\n"
                   "path = 'p.png'\nbits = 16\naovs = ['ambient_occlusion']\n" % (ao, radius))
    times = []
    for _ in range(3):
        subprocess.run([limn, "--quiet", "render", folder + "/config.toml", "--stats", folder + "/stats.json"],
                       check=True)
        times.append(json.load(open(folder + "/stats.json"))["frames"][0]["parts"]["draw"] / 1000)
    return gray(folder + "/p.ambient_occlusion.png"), sorted(times)[1]


def eevee_draws(folder, place, samples):
    position, target, radius = PLACES[place]
    squeezed = [text.replace(" ", "") for text in (position, target)]
    done = subprocess.run(["blender", "-b", "-P", HERE + "/eevee_ao.py", "--", "%s/ao_scenes/%s.obj" % (DATA, place),
                           *squeezed, str(radius), str(samples), folder + "/e.png"], capture_output=True, text=True)
    return gray(folder + "/e.png"), float(re.search(r"^RENDER_S (.*)$", done.stdout, re.M).group(1))


def score(draw):
    squares, sums, count, seconds = 0.0, 0.0, 0, 0.0
    for place in PLACES:
        truth = gray("%s/ao_scenes/%s_A.cycles512.png" % (DATA, place))
        picture, took = draw(place)
        off = (picture - truth)[inside(truth)]
        squares, sums = squares + (off ** 2).sum(), sums + off.sum()
        count, seconds = count + off.size, seconds + took
    return math.sqrt(squares / count), sums / count, seconds / len(PLACES)


def chart(rows, path):
    width, height, left, right, top, bottom = 760, 460, 70, 30, 46, 50
    xs, ys = [math.log10(row[3]) for row in rows], [math.log10(row[1]) for row in rows]
    low_x, high_x, low_y, high_y = min(xs) - 0.15, max(xs) + 0.35, min(ys) - 0.1, max(ys) + 0.1
    x = lambda v: left + (math.log10(v) - low_x) / (high_x - low_x) * (width - left - right)
    y = lambda v: height - bottom - (math.log10(v) - low_y) / (high_y - low_y) * (height - top - bottom)
    svg = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" font-family="sans-serif" font-size="12">'
           % (width, height), '<rect width="100%" height="100%" fill="#fff"/>',
           '<text x="%d" y="24" font-size="15">Ambient occlusion beside Cycles: limn, EEVEE; two cores</text>' % left]
    for power in range(-4, 3):
        for step in (1, 2, 5):
            value = step * 10.0 ** power
            if low_x <= math.log10(value) <= high_x:
                svg.append('<path d="M%.1f %dV%d" stroke="#ddd"/><text x="%.1f" y="%d" text-anchor="middle">%g</text>'
                           % (x(value), top, height - bottom, x(value), height - bottom + 16, value))
            if low_y <= math.log10(value) <= high_y:
                svg.append('<path d="M%d %.1fH%d" stroke="#ddd"/><text x="%d" y="%.1f" text-anchor="end">%g</text>'
                           % (left, y(value), width - right, left - 6, y(value) + 4, value))
    svg.append('<text x="%d" y="%d" text-anchor="middle">seconds a picture of 640×360; errors away from edges</text>'
               % (width / 2, height - 12))
    svg.append('<text transform="translate(18 %d) rotate(-90)" text-anchor="middle">RMSE</text>' % (height / 2))
    for number, (name, error, _, seconds) in enumerate(rows):
        above = 16 if number % 2 else -9  # names of neighbours do not meet
        color = "#d55e00" if name.startswith("EEVEE") else "#0072b2"
        svg.append('<circle cx="%.1f" cy="%.1f" r="5" fill="%s"/><text x="%.1f" y="%.1f" fill="%s" '
                   'text-anchor="middle">%s</text>'
                   % (x(seconds), y(error), color, x(seconds), y(error) + above, color, name))
    with open(path, "w") as file:
        file.write("\n".join(svg) + "\n</svg>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("limn")
    parser.add_argument("--chart", default="")
    options = parser.parse_args()
    limn, rows = os.path.abspath(options.limn), []
    with tempfile.TemporaryDirectory() as folder:
        draws = {name: (lambda place, ao=ao: limn_draws(limn, folder, place, ao)) for name, ao in OURS.items()}
        for samples in (1, 4, 16):
            draws["EEVEE, %d sample%s" % (samples, "s" if samples > 1 else "")] = (
                lambda place, samples=samples: eevee_draws(folder, place, samples))
        for name, draw in draws.items():
            rows.append((name, *score(draw)))
            print("%-20s RMSE %.4f  bias %+.4f  %.3f s" % rows[-1], flush=True)
    if options.chart:
        chart(rows, options.chart)


if __name__ == "__main__":
    main()
