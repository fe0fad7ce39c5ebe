#!/usr/bin/env bash
# limn beside Blender's Workbench and Freestyle: where lines are right, and how long a picture of the house takes.
# Ratios, from one run.
#
#   tests/bench/freestyle.sh [ROUNDS]
#
# Needs blender and a build with tests (LIMN_PRESET=ci). Freestyle's own render is counted, without start-up and
# loading; of limn's process all but
# the device's start and the scene's loading, with reading back and writing the file.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd) root=$(cd "$(dirname "$0")/../.." && pwd) rounds=${1:-3}
build=$root/build/${LIMN_PRESET:-ci}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/scenes"
LIMN_LINE_SCENES=$work/scenes "$build/gl" --gtest_filter='Lines.areWhereTheEdgesAreAndNowhereElse' >/dev/null
blender -b -P "$here/freestyle.py" -- lines "$work/scenes" >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
echo 'lines against the known edges:'
LIMN_LINE_SCENES=$work/scenes "$build/gl" --gtest_filter='Lines.areWhereTheEdgesAreAndNowhereElse' | grep '%\|drawn'

median() { sort -n | sed -n "$(((rounds + 1) / 2))p"; }
# limn NAME SETTING...: seconds of a frame without the device's start and the scene's loading, into a file.
limn() {
    local name=$1
    shift
    "$build/limn" render "$root/render_configs/house_lines_ao.toml" "$@" --set 'output.aovs=["beauty"]' \
        --output "$work/$name.png" --stats "$work/stats.json" >/dev/null 2>&1
    python3 - "$work/stats.json" <<'PYTHON' >>"$work/$name.s"
import json, sys
frame = json.load(open(sys.argv[1]))["frames"][0]
skipped = sum(v for k, v in frame["parts"].items() if k.startswith("device") or k.startswith("load"))
print(round((frame["total"] - skipped) / 1000, 3))
PYTHON
}
for ((i = 0; i <= rounds; ++i)); do
    if ((i == 1)); then rm "$work"/*.s; fi # the first round warms up
    limn one --set image.samples=1
    limn eight --set image.samples=8
    limn bare --set image.samples=1 --set edges.0.opacity=0
    limn mesh --set image.samples=1 --set edges=mesh_lines
    limn mesh_plain --set image.samples=1 --set edges=mesh_lines --set edges.intersections=0
    ((i == 0)) && continue
    blender -b -P "$here/freestyle.py" -- scene "$root/scenes/house/scene.toml" street 1920 1080 \
        "$work/freestyle.png" 2>/dev/null >"$work/log"
    for name in RENDER PLAIN LINE_ART; do sed -n "s/^${name}_S //p" "$work/log" >>"$work/$name.s"; done
done
of() { median <"$work/$1.s"; }
one=$(of one) eight=$(of eight) theirs=$(of RENDER) plain=$(of PLAIN) art=$(of LINE_ART)
echo "the house at 1920x1080: limn $one s (1 sample), $eight s (8 samples); Workbench + Freestyle $theirs s"
echo "Freestyle / limn: $(echo "scale=1; $theirs / $one" | bc) at 1 sample, $(echo "scale=1; $theirs / \
    $eight" | bc) at 8"
more() { echo "$1 - $2" | bc; }
lines=$(more "$(of mesh)" "$(of bare)") without=$(more "$(of mesh_plain)" "$(of bare)")
echo "lines alone, over the picture without: mesh_lines $lines s, $without s without intersections; Freestyle" \
    "$(more "$theirs" "$plain") s, Line Art $(more "$art" "$plain") s (Workbench alone $plain s)"
echo "Freestyle / mesh_lines: $(echo "scale=1; ($theirs - $plain) / $lines" | bc); Line Art / mesh_lines: $(echo \
    "scale=1; ($art - $plain) / $lines" | bc)"
[ -z "${KEEP:-}" ] || cp "$work"/*.png "$work"/scenes/*.png "$KEEP/"
