// How finely the edges of a cage are cut to look smooth to a camera.
#pragma once

#include "stage/scene_at.h"

#include <functional>
#include <memory>
#include <span>

namespace limn {

/// Where a loaded scene keeps what is found out here.
std::shared_ptr<EdgeViewers> makeEdgeViewers();

/// Instances of one mesh that are of one class look so much alike in size, within a factor of sqrt(2), that they may
/// share one mesh: what that has too many triangles for some of them costs less than making and keeping a mesh for
/// each.
int edgeClass(const LoadedScene& loaded, const SceneAt& scene, std::size_t instance, const FrameRequest& request);

/// Segments per edge of a mesh for its `edge_length`, as fine as any of these instances of it needs; nothing when it
/// has none. Pixels are measured as the nearest camera of all declared frames sees the edge, whatever frames are drawn,
/// so that every subset of frames has the same triangles; edges that no frame sees are not cut.
std::function<int(const glm::dvec3&, const glm::dvec3&)> edgeRates(
    const LoadedScene& loaded, std::span<const std::size_t> instances, const FrameRequest& request);
/// Adds all that these rates depend on.
void addEdgeRates(
    KeyBuilder& key, const LoadedScene& loaded, std::span<const std::size_t> instances, const FrameRequest& request);

}  // namespace limn
