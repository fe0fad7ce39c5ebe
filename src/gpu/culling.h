// Which triangles a camera can see: those that cover the middle of some pixel and do not lie behind what has been drawn
// already. Pure functions.
//
// Leaving out what cannot be seen changes no bit of a picture. It is for software renderers, which set triangles up on
// one core: most triangles of a finely cut scene turn their backs to the camera, or slip between the pixels' middles.
#pragma once

#include "mesh/clusters.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace limn {

/// An instance's mesh, and how it gets to pixels. Positions are mesh units from the pivot.
struct PlacedMesh {
    std::span<const Cluster> clusters;
    std::size_t firstPosition = 0, firstIndex = 0;  ///< of the mesh, in TriangleSource
    /// To fine pixels of the canvas (xy), value in the depth buffer (z), all times w, and w.
    glm::mat4 pixelFromMesh{1};
    /// The same with every term's absolute value: rounding errors grow with what it gives.
    glm::mat4 terms{0};
    glm::vec3 eye{0};  ///< orthographic: the direction to it
};

struct CullView {
    std::vector<PlacedMesh> instances;
    glm::vec2 regionLow{0}, regionHigh{0};  ///< fine pixels of the canvas: only what lies in there is of interest
    bool orthographic = false;
};

/// All meshes' positions and, counted within each mesh, corners.
struct TriangleSource {
    const glm::vec3* positions = nullptr;
    const std::uint32_t* indices = nullptr;
};

/// Of a depth buffer the least value of each square of `side` fine pixels, rows from the bottom.
struct FarthestDepths {
    int side = 4;
    glm::ivec2 size{0};
    std::vector<float> values;
};

/// Some of an instance's clusters, and which of their triangles are drawn.
struct SeenPart {
    std::size_t instance = 0;
    std::size_t firstCluster = 0, clusterCount = 0;
    std::vector<std::uint32_t> indices;    ///< corners of triangles
    std::vector<std::uint32_t> withBacks;  ///< clusters of which some triangle does not face the camera
};

/// All instances in order, cut into parts that can be looked at side by side; nothing is chosen yet.
std::vector<SeenPart> partsOf(const CullView& view);

/// Appends the triangles that may be seen of those that face the camera.
void chooseFacing(const CullView& view, const TriangleSource& source, SeenPart& part);

/// After that: those that turn their backs to the camera. Where meshes are closed they are few, once what faces the
/// camera is drawn.
void chooseBacks(const CullView& view, const TriangleSource& source, const FarthestDepths& farthest, SeenPart& part);

}  // namespace limn
