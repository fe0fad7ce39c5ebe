#!/usr/bin/env bash
# limn beside the programs that people would use instead, on one picture, in one run: ratios, not seconds.
#
#   tests/bench/peers.sh HEADS.obj SCENE.py [ROUNDS]
#
# HEADS.obj  25 subdivided heads on a plane, y up;  SCENE.py  a Blender script that builds the same scene and renders
# it with
#            `-- workbench OUT.png`, printing RENDER_S and RENDER2_S (its first and second render, start-up excluded)
# Needs f3d, xvfb-run and blender. Every program draws 1280×720 from the same camera; F3D takes one sample, Workbench
# eight.
set -euo pipefail
obj=$(realpath "$1") script=$(realpath "$2") rounds=${3:-5}
limn=$(cd "$(dirname "$0")/../.." && pwd)/build/${LIMN_PRESET:-release}/limn
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat >"$work/scene.toml" <<TOML
[[mesh]]
name = "heads"
file = "$obj"
[[camera]]
position = [0, 8, 14]
look_at = [0, 7.53052844, 13.1170524]
focal_length = 50
[[light]]
direction = [-0.3, -1, -0.5]
TOML
cat >"$work/config.toml" <<TOML
scene = "scene.toml"
[image]
size = [1280, 720]
[shading]
technique = "toon"
[ao]
technique = "toon_ssao"
filter = { technique = "gaussian" }
[[edges]]
technique = "depth_normal"
[output]
path = "limn.png"
TOML

seconds() {
    local start end
    start=$(date +%s%N)
    "$@" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
    end=$(date +%s%N)
    echo "scale=3; ($end - $start) / 1000000000" | bc
}
median() { sort -n | sed -n "$(((rounds + 1) / 2))p"; }
render() { "$limn" render "$work/config.toml" --set image.samples="$1" --stats "$work/stats$1.json"; }
f3d_ssao() { DISPLAY=:97 f3d --ssao --no-background --resolution 1280,720 --camera-position 0,8,14 \
    --camera-focal-point 0,7.53052844,13.1170524 --camera-view-up 0,1,0 --camera-view-angle 22.895 --output \
    "$work/f3d.png" "$obj"; }

Xvfb :97 -screen 0 1280x720x24 >/dev/null 2>&1 &
xvfb=$!
trap 'kill $xvfb; rm -rf "$work"' EXIT
sleep 2
render 1 >/dev/null 2>&1; render 8 >/dev/null 2>&1; f3d_ssao >/dev/null 2>&1   # warm: shader caches, file cache
for ((i = 0; i < rounds; ++i)); do
    seconds render 1 >>"$work/limn1"
    seconds f3d_ssao >>"$work/f3d"
    seconds render 8 >>"$work/limn8"
    blender -b -P "$script" -- workbench "$work/workbench.png" 2>/dev/null | sed -n 's/^RENDER2\?_S workbench //p' | \
        sort -n | head -1 >>"$work/workbench"
done
l1=$(median <"$work/limn1") f=$(median <"$work/f3d") l8=$(median <"$work/limn8") w=$(median <"$work/workbench")
printf '%-44s %6s s\n' 'limn, 1 sample, whole process' "$l1" 'F3D --ssao, whole process' "$f" \
    'limn, 8 samples, whole process' "$l8" 'Workbench, cavity and outline, render alone' "$w"
# Of each round, whose programs run one after the other: a machine that slows down between rounds does not tilt them.
ratio() { paste "$work/$1" "$work/$2" | awk '{ printf "%.3f\n", $1 / $2 }' | median; }
echo "limn / F3D at 1 sample, median of the rounds:        $(ratio limn1 f3d)"
echo "limn / Workbench at 8 samples, median of the rounds: $(ratio limn8 workbench)   ($(paste -sd' ' <(paste \
"$work/limn8" "$work/workbench" | awk '{ printf "%.2f\n", $1 / $2 }')))"
echo 'parts of the last runs, milliseconds:'
cat "$work/stats1.json" "$work/stats8.json"
[ -z "${KEEP:-}" ] || cp "$work"/*.png "$KEEP/"
