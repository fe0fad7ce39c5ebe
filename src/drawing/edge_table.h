// The edges of a mesh's triangles, and which of its vertices are one: what lines from the mesh go by.
#pragma once

#include "mesh/tri_mesh.h"

#include <cstdint>
#include <vector>

namespace limn {

/// An edge and the triangles on it.
struct TriangleEdge {
    std::uint32_t a = 0, b = 0;                ///< TriangleEdges::vertexOf of its ends, a < b
    std::uint32_t firstUse = 0, useCount = 0;  ///< a range of TriangleEdges::uses
};

/// Triangles that edges join, directly or through others.
struct TriangleComponent {
    Bounds box;  ///< mesh units, as TriMesh::positions
    /// 1: closed, counter-clockwise from outside; −1: closed, clockwise from outside; 0: open, or of several minds.
    int outward = 0;
};

/// Vertices in the same place, within a few roundings, are one here, whatever attributes or cracks split them.
struct TriangleEdges {
    std::vector<std::uint32_t> vertexOf;     ///< of each position: the first position in the same place
    std::vector<std::uint32_t> componentOf;  ///< of each position: index into components
    std::vector<TriangleComponent> components;
    std::vector<TriangleEdge> edges;  ///< ascending by (a, b)
    std::vector<std::uint32_t> uses;  ///< 3 · triangle + corner that the edge begins at, ascending for each edge
};

/// Sorts in parallel; the result does not depend on threads. Edges that end where they begin are left out.
TriangleEdges findTriangleEdges(const TriMesh& mesh);

}  // namespace limn
