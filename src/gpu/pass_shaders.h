// The shaders of a pass: its own source after GLSL declarations of the pass's reads and writes. A shader can touch
// nothing else.
#pragma once

#include "gl/objects.h"
#include "gpu/shaders.h"
#include "graph/graph.h"
#include "picture/view.h"

#include <vector>

namespace limn {

/// Invocations of a work group of compute passes, each way. Long rows: neighbours in a row are neighbours in memory.
inline constexpr glm::ivec2 kWorkGroup(32, 8);

/// Compute passes run in work groups or as fragments, which is faster on software renderers: of one large triangle, or
/// of squares where the pass has a mask.
enum class ComputeAs { workGroups, fragments };

/// `viewConstants`: the block `view`, see viewBlock(). Shaders with equal text do the same.
std::vector<gl::ShaderStage> shadersOf(const Graph& graph, const PlannedPass& planned, const View& view,
    const UniformBlock& viewConstants, ComputeAs computeAs, const ShaderLibrary& library);

}  // namespace limn
