#!/usr/bin/env python3
"""Films of finished frames, opened by ffprobe and ffmpeg: python3 tests/jobs/video.py LIMN; 77 without these."""

import json
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path.insert(0, HERE)
from safety import Runs, hashes, out  # noqa: E402


def probe(film):
    done = subprocess.run(
        ["ffprobe", "-v", "error", "-count_packets", "-select_streams", "v", "-show_streams", "-of", "json", film],
        capture_output=True,
        check=True,
        text=True,
    )
    (stream,) = json.loads(done.stdout)["streams"]
    return stream


def pixels(path, frame, pixel_format="rgb24"):
    """A frame's samples, as ffmpeg decodes them."""
    select = ["-vf", "select=eq(n\\,%d)" % frame, "-frames:v", "1"]
    command = ["ffmpeg", "-v", "error", "-i", path, *select, "-pix_fmt", pixel_format, "-f", "rawvideo", "-"]
    return subprocess.run(command, capture_output=True, check=True).stdout


def mean_colour(samples, channels=3):
    return [sum(samples[c::channels]) / len(samples[c::channels]) for c in range(3)]


def formats(runs):
    config = runs.fresh(frames=6, width=98, height=64)
    place = os.path.dirname(config)
    colour = ["--set", "image.background='#c83c14'"]
    runs.run(config, *colour)
    frame = os.path.join(out(config), "box_0003.png")
    for kind, codec in [("mp4", "h264"), ("webm", "vp9"), ("gif", "gif")]:
        film = os.path.join(place, "film." + kind)
        said = runs.run(config, "--resume", *colour, "--set", "output.video='%s'" % film)
        assert said.count("Kept:") == 6 and "Saved: '%s'" % film in said, said
        stream = probe(film)
        assert stream["codec_name"] == codec and stream["nb_read_packets"] == "6", stream
        assert (stream["width"], stream["height"]) == (98, 64), stream
        if kind != "gif":
            tags = [stream.get(key) for key in ("color_space", "color_transfer", "color_primaries", "color_range")]
            assert tags == ["bt709", "bt709", "bt709", "tv"] and stream["r_frame_rate"] == "24/1", stream
        # Colours come back as they were, whatever matrix a reader that believes no tags would take: this red would be
        # off by 12 or more. The upper rows are background alone.
        found, wanted = (mean_colour(pixels(path, at)[: 98 * 8 * 3]) for path, at in ((film, 2), (frame, 0)))
        assert max(abs(a - b) for a, b in zip(found, wanted)) < 2, (kind, found, wanted)
        first = open(film, "rb").read()
        subprocess.run(
            [runs.limn, "video", os.path.join(out(config), "box_####.png"), "--output", film],
            check=True,
            capture_output=True,
        )
        assert open(film, "rb").read() == first, kind + ": the same frames make the same film"
    print("mp4, webm and gif: frames, sizes, tags and colours as asked for")


def odd_and_transparent(runs):
    config = runs.fresh(frames=3, width=97, height=63)
    place = os.path.dirname(config)
    film = os.path.join(place, "film.mp4")
    runs.run(config, "--set", "output.video='%s'" % film)
    stream = probe(film)
    assert (stream["width"], stream["height"]) == (98, 64), stream
    for kind, words in [("mp4", "keeps no transparency"), ("webm", None)]:
        film = os.path.join(place, "clear." + kind)
        said = runs.run(config, "--set", "image.background='transparent'", "--set", "output.video='%s'" % film)
        assert (words in said) if words else "transparency" not in said, said
    alpha = subprocess.run(
        ["ffmpeg", "-v", "error", "-c:v", "libvpx-vp9", "-i", film, "-frames:v", "1", "-pix_fmt", "rgba", "-f",
         "rawvideo", "-"], capture_output=True, check=True,
    ).stdout[3::4]  # fmt: skip
    assert min(alpha) < 10 and max(alpha) > 245, (min(alpha), max(alpha))
    print("odd sizes are made even; transparency is kept by webm and said of mp4")


def refused(runs):
    config = runs.fresh(frames=3)
    place = os.path.dirname(config)
    film = os.path.join(place, "film.mp4")
    assert "end the path in" in runs.run(config, "--set", "output.video='film.avi'", expect=64)
    nowhere = {**os.environ, "PATH": place}
    assert "ffmpeg" in runs.run(config, "--set", "output.video='%s'" % film, expect=66, env=nowhere)
    assert not os.path.isdir(out(config)), "said before anything is drawn"
    for pattern, code in [("box.png", 64), ("none_####.png", 66)]:
        done = subprocess.run([runs.limn, "video", os.path.join(place, pattern), "--output", film], capture_output=True)
        assert done.returncode == code, (pattern, done)
    # A film of all frames is not replaced by one of some, nor by one with frames that failed.
    whole = runs.fresh(frames=3)
    kept = os.path.join(os.path.dirname(whole), "kept.mp4")
    wanted = ["--set", "output.video='%s'" % kept]
    runs.run(whole, *wanted)
    before = open(kept, "rb").read()
    for part in (["--frames", "2"], ["--crop", "0,0,16,16"], ["--output", place + "/other/box_####.png"]):
        assert "limn video" in runs.run(whole, "--resume", *wanted, *part)
    os.remove(os.path.join(os.path.dirname(whole), "box.obj"))
    runs.run(whole, "--resume", "--keep-going", *wanted, expect=66)
    assert open(kept, "rb").read() == before
    # A part of the frames makes no film; it says who does.
    said = runs.run(config, "--chunk", "1/2", "--set", "output.video='%s'" % film)
    assert "limn video" in said and not os.path.exists(film), said
    assert not [name for name in hashes(out(config)) if name.startswith(".limn-")]
    print("films that cannot be made are refused before drawing")


def main():
    if not (shutil.which("ffmpeg") and shutil.which("ffprobe")):
        print("ffmpeg is not installed")
        return 77
    with tempfile.TemporaryDirectory() as place:
        runs = Runs(os.path.abspath(sys.argv[1]), place)
        for part in (formats, odd_and_transparent, refused):
            part(runs)
    return 0


if __name__ == "__main__":
    sys.exit(main())
