// How finely the edges of a cage are cut to look smooth to a camera.
#pragma once

#include "render/loader.h"

#include <functional>

namespace limn {

/// Segments per edge of an instance's mesh for its `edge_length`, or nothing when it has none. Pixels are measured as the nearest camera of all declared
/// frames sees the edge, whatever frames are drawn, so that every subset of frames has the same triangles; edges that no frame sees are not
/// cut.
std::function<int(const glm::dvec3&, const glm::dvec3&)> edgeRates(const LoadedScene& loaded, std::size_t instance, const RenderConfig& config);

}  // namespace limn
