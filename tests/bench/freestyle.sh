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
"$build/limn" render "$root/render_configs/house_lines_ao.toml" --set image.samples=1 --output "$work/limn.png" \
    >/dev/null 2>&1
for ((i = 0; i < rounds; ++i)); do
    for samples in 1 8; do
        "$build/limn" render "$root/render_configs/house_lines_ao.toml" --set image.samples=$samples --set \
            'output.aovs=["beauty"]' --output "$work/limn.png" --stats "$work/stats.json" >/dev/null 2>&1
        python3 - "$work/stats.json" <<'PYTHON' >>"$work/limn$samples"
import json, sys
frame = json.load(open(sys.argv[1]))[0]
parts = frame["parts"]
skipped = sum(v for k, v in parts.items() if k.startswith("device") or k.startswith("load"))
print(round((frame["total"] - skipped) / 1000, 3))
PYTHON
    done
    blender -b -P "$here/freestyle.py" -- scene "$root/scenes/house/scene.toml" street 1920 1080 \
        "$work/freestyle.png" 2>/dev/null | sed -n 's/^RENDER_S //p' >>"$work/freestyle"
done
one=$(median <"$work/limn1") eight=$(median <"$work/limn8") theirs=$(median <"$work/freestyle")
echo "the house at 1920x1080: limn $one s (1 sample), $eight s (8 samples); Workbench + Freestyle $theirs s"
echo "Freestyle / limn: $(echo "scale=1; $theirs / $one" | bc) at 1 sample, $(echo "scale=1; $theirs / \
    $eight" | bc) at 8"
[ -z "${KEEP:-}" ] || cp "$work"/*.png "$work"/scenes/*.png "$KEEP/"
