#include "drawing/viewed_scene.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace limn {

Projector::Projector(const View& view)
    : isParallel(view.orthographic),
      rayScale(view.rayScale),
      rayOffset(view.rayOffset - view.rayScale * view.samplePlace),
      nearest(view.near) {}

/// ViewedMesh::seenWinding. Nothing is certain about what has holes, and what reaches the nearest plane.
static std::vector<int> seenWindingOf(const ViewedMesh& placed, const Projector& projector) {
    std::vector<int> winding(placed.edges->components.size());
    if (!placed.masks.empty()) return winding;
    for (std::size_t i = 0; i < winding.size(); ++i) {
        const TriangleComponent& component = placed.edges->components[i];
        double depth = std::numeric_limits<double>::infinity();
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p(corner & 1 ? component.box.hi.x : component.box.lo.x,
                corner & 2 ? component.box.hi.y : component.box.lo.y,
                corner & 4 ? component.box.hi.z : component.box.lo.z);
            depth = std::min(depth, -(placed.viewFromMesh * p + placed.pivot).z);
        }
        if (depth > projector.nearest)
            winding[i] = component.outward * (glm::determinant(placed.viewFromMesh) < 0 ? -1 : 1);
    }
    return winding;
}

bool ViewedScene::turnsAway(const ViewedMesh& mesh, std::uint32_t triangleOfMesh) const {
    const auto corner = corners(mesh, triangleOfMesh);
    const int winding = mesh.seenWinding[mesh.edges->componentOf[corner[0].number - mesh.firstVertex]];
    if (winding == 0) return false;
    const glm::dvec3 n = glm::cross(corner[1].at - corner[0].at, corner[2].at - corner[0].at);
    return winding * projector_.facing(n, corner[0].at) < 0;
}

ViewedScene::ViewedScene(const SceneAt& scene, std::span<const TriMesh* const> meshOf,
    std::span<const TriangleEdges* const> edgesOf, const View& view)
    : scene_(scene), projector_(view) {
    std::size_t vertices = 0, components = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        ViewedMesh placed;
        placed.mesh = meshOf[i];
        placed.edges = edgesOf[i];
        placed.instance = &scene.instances[i];
        if (!placed.mesh->uvs.empty()) placed.masks = masks_.of(scene, scene.instances[i]);
        placed.firstVertex = static_cast<std::uint32_t>(vertices);
        placed.firstTriangle = static_cast<std::uint32_t>(triangleCount_);
        placed.firstComponent = static_cast<std::uint32_t>(components);
        components += placed.edges->components.size();
        vertices += placed.mesh->positions.size();
        triangleCount_ += placed.mesh->triangleCount();
        meshes_.push_back(placed);
    }
    at_.resize(vertices);
    for (auto& placed : meshes_) {
        const glm::dmat4& world = placed.instance->worldFromMesh;
        // The eye is subtracted first, so that scenes far from the origin lose nothing.
        const glm::dmat3 linear = view.viewFromRelative * glm::dmat3(world);
        placed.viewFromMesh = linear;
        placed.pivot = view.viewFromRelative * (glm::dvec3(world * glm::dvec4(placed.mesh->pivot, 1)) - view.eye);
        placed.seenWinding = seenWindingOf(placed, projector_);
        placed.normalMatrix = glm::dmat3(
            glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]), glm::cross(linear[0], linear[1]));
        if (glm::determinant(linear) < 0) placed.normalMatrix = -placed.normalMatrix;
        const auto& positions = placed.mesh->positions;
        tbb::parallel_for(std::size_t{0}, positions.size(),
            [&](std::size_t i) { at_[placed.firstVertex + i] = viewed(placed, positions[i]); });
    }
}

const ViewedMesh& ViewedScene::meshOf(std::uint32_t triangle) const {
    const auto after = std::upper_bound(meshes_.begin(), meshes_.end(), triangle,
        [](std::uint32_t number, const ViewedMesh& mesh) { return number < mesh.firstTriangle; });
    return *(after - 1);
}

std::array<ViewedVertex, 3> ViewedScene::corners(const ViewedMesh& mesh, std::uint32_t triangleOfMesh) const {
    const std::uint32_t* indices = mesh.mesh->indices.data() + std::size_t{3} * triangleOfMesh;
    return {vertex(mesh, indices[0]), vertex(mesh, indices[1]), vertex(mesh, indices[2])};
}

}  // namespace limn
