// Triangles ready for the GPU, with only the attributes that something reads.
#pragma once

#include "mesh/poly_mesh.h"
#include "scene/bounds.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace limn {

/// What the plan reads of a mesh.
struct MeshNeeds {
    bool normals = false;
    bool uvs = false;
    bool unified = false;  ///< one index for everything, as vertex pipelines want it; else positions stay shared and
                           ///< each attribute has its own
    bool colors = false;   ///< where the mesh has them
    bool operator==(const MeshNeeds&) const = default;
};

/// A line to be drawn whatever the surfaces are.
struct Segment {
    glm::vec3 a{0}, b{0};        ///< as TriMesh::positions
    std::uint32_t material = 0;  ///< as TriMesh::triangleMaterial
    bool isCut = false;          ///< the cut of a surface without thickness
};

struct TriMesh {
    glm::dvec3 pivot{0};               ///< positions are relative to it: float keeps its precision far from the origin
    std::vector<glm::vec3> positions;  ///< mesh units
    std::vector<glm::vec3> normals;    ///< unit length, or zero where the surface has none; empty unless asked for
    std::vector<glm::vec2> uvs;        ///< empty unless asked for
    std::vector<glm::vec3> colors;     ///< linear; empty unless asked for, and where the mesh has none
    std::vector<std::uint32_t>
        indices;  ///< three positions per triangle, counter-clockwise from outside. Unless unified, triangle t's last
                  ///< index is t: rasterizers pass that vertex number on as the triangle's
    std::vector<std::uint32_t> normalIndices;  ///< three normals per triangle; empty when unified, or without normals
    std::vector<std::uint32_t> uvIndices;      ///< three uvs per triangle; empty when unified, or without uvs
    std::vector<std::uint32_t> colorIndices;   ///< three colours per triangle; empty when unified, or without colours
    std::vector<std::uint32_t> triangleMaterial;  ///< index into PolyMesh::materialNames; empty = all 0
    std::vector<std::uint32_t> trianglePart;      ///< index into PolyMesh::partNames; empty = all 0

    std::vector<Segment> segments;

    std::size_t triangleCount() const { return indices.size() / 3; }
};

/// Faces meeting at less than this angle are smoothed where a file gives neither normals nor smoothing groups.
inline constexpr double kSmoothAngleDegrees = 30;

/// Triangulates (concave polygons filled right, holes in self-touching ones left open) and gathers the attributes asked
/// for. Makes missing normals: by smoothing group where the file has them, else smooth across edges flatter than
/// kSmoothAngleDegrees. Drops zero-area triangles. Parallel; the result does not depend on threads.
TriMesh buildTriMesh(const PolyMesh& mesh, const MeshNeeds& needs);

/// The middle of the vertices that faces use, rounded to a coarse grid so that pivots of moved copies differ by exactly
/// the move.
glm::dvec3 choosePivot(const PolyMesh& mesh);
/// buildTriMesh around a given pivot, before the numbering.
TriMesh triangulateMesh(const PolyMesh& mesh, const MeshNeeds& needs, const glm::dvec3& pivot);
/// The lines that the file draws, around a pivot.
std::vector<Segment> segmentsOf(const PolyMesh& mesh, const glm::dvec3& pivot);

/// Rotates the corners of triangles, and reorders and repeats positions, so that indices[3·t + 2] == t. Shaders could
/// number triangles too (gl_PrimitiveID), but software renderers are slow at it.
void numberByLastVertex(TriMesh& mesh);

/// Corner indices (0 … n−1) of the triangles that fill a polygon; n−2 of them unless it crosses itself.
std::vector<std::uint32_t> triangulatePolygon(const std::vector<glm::dvec3>& polygon);

}  // namespace limn
