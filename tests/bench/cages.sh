#!/usr/bin/env bash
# limn drawing subdivision cages beside programs that draw the same scene subdivided beforehand: one run, ratios.
#
#   tests/bench/cages.sh CAGES.toml HEADS.obj SCENE.py [ROUNDS]
#
# CAGES.toml  a render config of the heads' cages, as the exporter wrote it;  HEADS.obj, SCENE.py  as for peers.sh.
# SCENE.py also knows
#             `-- wb_fs OUT.png`: Workbench with Freestyle's lines
# limn's times are whole processes. F3D's too; Blender's are its second render, start-up excluded.
set -euo pipefail
cages=$(realpath "$1") obj=$(realpath "$2") script=$(realpath "$3") rounds=${4:-3}
limn=$(cd "$(dirname "$0")/../.." && pwd)/build/${LIMN_PRESET:-release}/limn
work=$(mktemp -d)
seconds() {
    local start end
    start=$(date +%s%N)
    "$@" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
    end=$(date +%s%N)
    echo "scale=3; ($end - $start) / 1000000000" | bc
}
median() { sort -n "$1" | sed -n "$(((rounds + 1) / 2))p"; }
render() { "$limn" render "$cages" --set image.samples="$1" --output "$work/limn.png" --stats "$work/stats$1.json"; }
f3d_ssao() { DISPLAY=:97 f3d --ssao --no-background --resolution 1280,720 --camera-position 0,8,14 \
    --camera-focal-point 0,7.53052844,13.1170524 --camera-view-up 0,1,0 --camera-view-angle 22.895 --output \
    "$work/f3d.png" "$obj"; }
blender_mode() { blender -b -P "$script" -- "$1" "$work/$1.png" 2>/dev/null | sed -n "s/^RENDER2\?_S $1 //p" | sort \
    -n | head -1; }
Xvfb :97 -screen 0 1280x720x24 >/dev/null 2>&1 &
xvfb=$!
trap 'kill $xvfb; rm -rf "$work"' EXIT
sleep 2
render 1 >/dev/null 2>&1; render 8 >/dev/null 2>&1; f3d_ssao >/dev/null 2>&1
for ((i = 0; i < rounds; ++i)); do
    seconds render 1 >>"$work/limn1"
    seconds f3d_ssao >>"$work/f3d"
    seconds render 8 >>"$work/limn8"
    blender_mode workbench >>"$work/wb"
    blender_mode wb_fs >>"$work/fs"
done
l1=$(median "$work/limn1") l8=$(median "$work/limn8") f=$(median "$work/f3d") w=$(median "$work/wb") s=$(median \
    "$work/fs")
printf '%-44s %7s s\n' 'limn from cages, 1 sample, whole process' "$l1" 'limn from cages, 8 samples, whole process' \
    "$l8" 'F3D --ssao, subdivided, whole process' "$f" 'Workbench, render alone' "$w" \
    'Workbench with Freestyle, render alone' "$s"
echo "times as fast at 1 sample: F3D $(echo "scale=1; $f / $l1" | bc), Workbench $(echo "scale=1; $w / \
    $l1" | bc), Workbench with Freestyle $(echo "scale=1; $s / $l1" | bc)"
echo "times as fast as Workbench at 8 samples: $(echo "scale=1; $w / $l8" | bc)"
cat "$work/stats1.json" "$work/stats8.json"
