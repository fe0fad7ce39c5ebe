// The scene's own lines as pieces of line, beside those that a technique finds.
#pragma once

#include "effects/technique.h"
#include "lines/style.h"

#include <array>

namespace limn {

/// Two images of pieces (RGBA32F, see Mark in shaders/lib/lines.glsl), so that neighbours in a polyline do not contend
/// for a cell.
using MarkImages = std::array<ResourceId, 2>;

/// Adds the pass that cuts the scene's marks into the picture's cells, hidden by what lies in front of them. Marks
/// within half a pixel of a surface lie on it and are visible.
MarkImages placeMarks(EffectBuilder& graph, const Stroke& stroke, int rate);

}  // namespace limn
