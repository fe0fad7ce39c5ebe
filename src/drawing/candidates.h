// Edges that can make lines, before anyone asks what hides them.
#pragma once

#include "drawing/drawn_line.h"
#include "drawing/viewed_scene.h"

namespace limn {

/// No vertex of a mesh.
inline constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};

/// A straight piece of line in space.
struct Candidate {
    std::array<glm::dvec3, 2> end;   ///< view space, normalized units
    std::array<glm::dvec3, 2> lift;  ///< added to them where it is asked what hides the line
    /// Numbers of its ends among all vertices (ViewedVertex), or kNoVertex.
    std::array<std::uint32_t, 2> vertex{kNoVertex, kNoVertex};
    std::array<std::uint64_t, 2> node{0, 0};  ///< pieces join where they share one
    std::array<std::uint32_t, 2> within{
        kNoVertex, kNoVertex};  ///< triangles that it lies in, besides those on its edge
    MeshLineSource source = MeshLineSource::contours;
    bool isCurve = false;  ///< part of the contour of a surface that is curved there, or is meant to be
    std::uint32_t record = 0, instance = 0, part = 0, material = 0;  ///< as DrawnLine's
    std::uint32_t component = kNoVertex;                             ///< of its mesh: number among all
    std::uint32_t face = kNoVertex;                                  ///< of a border: the triangle beside it
};

/// The edges of all meshes with a reason to be drawn, then the scene's own lines, then intersections where they are
/// asked for. In the order of meshes and edges, whatever the number of threads.
std::vector<Candidate> findCandidates(const ViewedScene& scene, const MeshLineRequest& request);

/// Where triangles pass through one another. Triangles that touch, or lie in one plane, do not. Unless hidden ones are
/// asked for, triangles that turn away are left out where their component is closed and seen from outside.
void findIntersections(const ViewedScene& scene, bool withHidden, std::vector<Candidate>& found);

/// What a triangle of a mesh says about its lines.
void describe(Candidate& made, const ViewedScene& scene, const ViewedMesh& placed, std::uint32_t triangleOfMesh);

/// A node for the ends in one place.
std::uint64_t nodeAt(const glm::dvec3& place);

}  // namespace limn
