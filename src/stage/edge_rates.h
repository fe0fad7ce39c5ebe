// Edge rates: how finely a cage's edges are cut to look smooth to a camera.
#pragma once

#include "stage/scene_at.h"

#include <functional>
#include <memory>
#include <span>

namespace limn {

/// Cache of a loaded scene for the results found here.
std::shared_ptr<EdgeViewers> makeEdgeViewers();

/// Instances of one mesh and one class look alike in size, within a factor of sqrt(2), and may share one mesh. Its
/// surplus triangles cost less than a mesh for each instance.
int edgeClass(const LoadedScene& loaded, const SceneAt& scene, std::size_t instance, const FrameRequest& request);

/// Segments per edge of a mesh for its `edge_length`, as fine as the finest of these instances (numbers in the scene)
/// needs; nothing when it has none. The nearest camera of all declared frames measures the pixels of an edge, whatever
/// frames are drawn, so that every subset of frames has the same triangles. Edges that no frame sees are not cut.
std::function<int(const glm::dvec3&, const glm::dvec3&)> edgeRates(
    const LoadedScene& loaded, std::span<const std::size_t> instances, const FrameRequest& request);
/// Adds everything that these rates depend on to a content key.
void addEdgeRates(
    KeyBuilder& key, const LoadedScene& loaded, std::span<const std::size_t> instances, const FrameRequest& request);

}  // namespace limn
