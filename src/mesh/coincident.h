// Triangles that lie in one plane and overlap: rounding alone would decide which is visible.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

/// The triangles of one mesh, where they stand.
struct PlacedTriangles {
    std::span<const glm::vec3> positions;
    std::span<const std::uint32_t> indices;  ///< three per triangle, counted within `positions`
    glm::dmat4 worldFromMesh{1};             ///< from the units of `positions`
};

/// A triangle that must be seen in the place of others.
struct CoincidentTriangle {
    std::uint32_t mesh = 0, triangle = 0;
    int level = 0;  ///< from 1; of triangles that overlap, the one with the highest level is seen
    /// It is so only where it faces the camera, counter-clockwise in the world: the others are the backs of sheets, or
    /// the ground that a body stands on.
    bool facing = false;
    bool operator==(const CoincidentTriangle&) const = default;
};

/// Planes are one where they come this close, relative to the size of the scene: floats near a picture's resolution,
/// and files of six digits, cannot tell them apart.
inline constexpr double kCoincidentDistance = 2e-6;

/// The triangles that others must not hide: of those that turn the same side to the camera the first in order of meshes
/// and triangles, and before all these the ones that face it. Sorted by facing, level, mesh and triangle. Parallel; a
/// scene without such triangles costs a sort of their planes.
std::vector<CoincidentTriangle> findCoincident(std::span<const PlacedTriangles> meshes);

/// How many triangles lie on an earlier one of the mesh, whole or in part.
std::size_t countCovered(const PlacedTriangles& mesh);

}  // namespace limn
