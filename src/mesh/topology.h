// How the faces of a mesh hang together.
//
// Edges and orientation come from sorted arrays, fast enough for every mesh. Boundary loops and feature edges come from
// OpenMesh. Its half-edges take only manifold, consistently wound faces and cost about ten times as much: they are
// built on request.
#pragma once

#include "mesh/poly_mesh.h"

#include <cstdint>
#include <vector>

namespace limn {

/// An edge and the faces on it.
struct MeshEdge {
    std::uint32_t a, b;                ///< positions, a < b
    std::uint32_t firstUse, useCount;  ///< a range of EdgeTable::uses
};

struct EdgeUse {
    std::uint32_t corner;  ///< the corner that the edge begins at: index into PolyMesh::cornerPosition
    std::uint32_t face;
    bool forward;  ///< the face runs from a to b
};

struct EdgeTable {
    std::vector<MeshEdge> edges;  ///< ascending by (a, b)
    std::vector<EdgeUse> uses;
    std::vector<std::uint32_t> cornerEdge;  ///< of each corner: index into edges

    /// Index into edges, or −1.
    std::int64_t find(std::uint32_t a, std::uint32_t b) const;
};

EdgeTable findEdges(const PolyMesh& mesh);

/// Keeps the marked faces and their tags.
void keepFaces(PolyMesh& mesh, const std::vector<char>& keep);

/// A component number per face: faces that share a position are one component. Numbers run from 0 in the order of
/// faces.
struct Components {
    std::vector<std::uint32_t> ofFace;
    std::uint32_t count = 0;
};
Components findComponents(const PolyMesh& mesh);

/// Drops duplicate faces (same corners in the same or the opposite direction). Flips faces so that neighbours agree, as
/// few as possible in each piece. Pieces that cannot agree, such as a Möbius band, stay as they are. Adds warnings
/// without lines.
void repairTopology(PolyMesh& mesh, std::vector<MeshWarning>& warnings);

/// Joins what exporters split along seams of texture coordinates: where exactly two boundary edges of one part lie in
/// the same place, their ends become the same positions; texture coordinates stay each corner's own. Returns how many
/// positions have gone into others.
std::size_t joinSeams(PolyMesh& mesh);

/// Turns normals around that point against the faces of their vertex on the whole, after faces have been wound alike:
/// scans have such, and meshes mirrored by programs that forgot one of the two. Adds warnings without lines. Costs a
/// look at each corner where there are none.
void turnNormals(PolyMesh& mesh, std::vector<MeshWarning>& warnings);

struct TopologyReport {
    std::size_t vertices = 0;  ///< that faces use
    std::size_t unusedVertices = 0;
    std::size_t edges = 0;
    std::size_t boundaryEdges = 0, boundaryLoops = 0;
    std::size_t nonManifoldEdges = 0;     ///< three or more faces
    std::size_t nonManifoldVertices = 0;  ///< faces around it do not form one fan
    std::size_t components = 0;
    std::size_t unorientable = 0;     ///< edges whose two faces run the same way, after repair
    std::size_t featureEdges = 0;     ///< faces meet at more than kSmoothAngleDegrees
    std::size_t degenerateFaces = 0;  ///< of no area
    std::size_t valenceTwo = 0;       ///< interior vertices of two faces
    std::size_t largestFace = 0, largestValence = 0;
};
TopologyReport analyseTopology(const PolyMesh& mesh);

}  // namespace limn
