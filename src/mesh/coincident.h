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

/// Which side of a triangle faces the camera: counter-clockwise in the world is the front.
enum class Side { both, front, back };

/// A triangle that others in its plane must hide, seen from a side.
struct CoincidentTriangle {
    std::uint32_t mesh = 0, triangle = 0;
    Side side = Side::both;
    int level = 0;  ///< of triangles that overlap, the one with the lowest level is seen; those not listed have 0
    bool operator==(const CoincidentTriangle&) const = default;
};

/// Planes are one where they come this close, relative to the size of the scene: floats near a picture's resolution,
/// and files of six digits, cannot tell them apart.
inline constexpr double kCoincidentDistance = 2e-6;

/// The triangles that do not simply stay where they are: of those that turn the same side to the camera the first in
/// the order of meshes and triangles is seen, and before all these the one that turns its front to it, since the others
/// are the backs of sheets, or the ground that a body stands on. Sorted by side, level, mesh and triangle; one that
/// must be drawn by sides is listed for each. Parallel; a scene without such triangles costs a sort of their planes.
std::vector<CoincidentTriangle> findCoincident(std::span<const PlacedTriangles> meshes);

/// How many triangles lie on an earlier one of the mesh, whole or in part.
std::size_t countCovered(const PlacedTriangles& mesh);

}  // namespace limn
