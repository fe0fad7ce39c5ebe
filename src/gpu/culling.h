// Finds the triangles that a camera can see: they cover the middle of some pixel and do not lie behind earlier ones.
// Pure functions.
//
// Culling changes no bit of a picture. It is for software renderers, which set triangles up on one core: most triangles
// of a finely cut scene turn their backs to the camera, or slip between the pixels' middles.
#pragma once

#include "mesh/clusters.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace limn {

/// An instance's mesh, and its transform to pixels. Positions are mesh units from the pivot.
struct PlacedMesh {
    std::span<const Cluster> clusters;
    std::size_t firstPosition = 0, firstIndex = 0;  ///< of the mesh, in TriangleSource
    /// Gives fine pixels of the canvas (xy) and the depth buffer's value (z), all times w, and w.
    glm::mat4 pixelFromMesh{1};
    /// The same with every term's absolute value: rounding errors grow with its results.
    glm::mat4 terms{0};
    glm::vec3 eye{0};  ///< orthographic: the direction to it
};

struct CullView {
    std::vector<PlacedMesh> instances;
    glm::vec2 regionLow{0}, regionHigh{0};  ///< fine pixels of the canvas: only this part matters
    bool orthographic = false;
};

/// All meshes' positions and, counted within each mesh, corners.
struct TriangleSource {
    const glm::vec3* positions = nullptr;
    const std::uint32_t* indices = nullptr;
};

/// The least value of a depth buffer in each square of `side` fine pixels, rows from the bottom.
struct FarthestDepths {
    int side = 4;
    glm::ivec2 size{0};
    std::vector<float> values;
};

/// Some of an instance's clusters, and their triangles that are drawn.
struct SeenPart {
    std::size_t instance = 0;
    std::size_t firstCluster = 0, clusterCount = 0;
    std::vector<std::uint32_t> indices;    ///< corners of triangles
    std::vector<std::uint32_t> withBacks;  ///< clusters with a triangle that does not face the camera
};

/// Cuts all instances, in order, into parts for parallel work; nothing is chosen yet.
std::vector<SeenPart> partsOf(const CullView& view);

/// Appends the triangles that face the camera and may be visible.
void chooseFacing(const CullView& view, const TriangleSource& source, SeenPart& part);

/// Then appends the visible triangles that turn their backs to the camera. Closed meshes have few of them once their
/// fronts are drawn.
void chooseBacks(const CullView& view, const TriangleSource& source, const FarthestDepths& farthest, SeenPart& part);

}  // namespace limn
