#!/usr/bin/env bash
# The table of ambient occlusion: accuracy against the ray-traced truth and time, of every technique, tuned on one
# camera of each place and
# scored on another. Needs LIMN_TEST_DATA. Takes about ten minutes on two cores.
#
#   tests/bench/ao_table.sh [OUTPUT_FOLDER]
set -euo pipefail
cd "$(dirname "$0")/../.."
: "${LIMN_TEST_DATA:?set it to the folder of test data}"
limn=build/${LIMN_PRESET:-release}/limn
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fov=91.49284228186366   # 60 degrees from top to bottom at 16:9
camera() { printf '[[camera]]\nname = "%s"\nposition = [%s]\nlook_at = [%s]\nfov = %s\n' "$1" "$2" "$3" "$fov"; }
scene() { printf '[[mesh]]\nname = "%s"\nfile = "%s"\n' "$1" "$2"; }
{ scene room "$LIMN_TEST_DATA/ao_scenes/room.obj"; camera A "0.3, 1.6, 4.8" "-0.1, 1.1, -3"; camera B \
    "-1.9, 1.2, 3.6" "1.5, 0.6, -2.5"; } > "$folder/room.toml"
{ scene thin "$LIMN_TEST_DATA/ao_scenes/thin.obj"; camera A "2.7, 1.8, 3.6" "0, 0.45, 0.3"; camera B \
    "-2.6, 0.9, 3.2" "0.3, 0.5, 0"; } > "$folder/thin.toml"
{ scene bust "$LIMN_TEST_DATA/ao_scenes/bust.obj"; camera A "1.6, 1.6, 2.6" "0, 0.95, 0"; camera B "-1.2, 1.1, 2.3" \
    "0, 1.0, 0"; } > "$folder/bust.toml"
{ scene sponza "$LIMN_TEST_DATA/sponza_architecture/sponza.obj"; camera A "-1100, 180, -40" "600, 320, 30"; camera B \
    "480, 620, -330" "-500, 420, 250"; } > "$folder/sponza.toml"
cp tests/bench/ao_table.toml "$folder/study.toml"
"$limn" study "$folder/study.toml" ${1:+--output "$1"}
