// Meshes cut open by planes: the part beyond is removed, and solids get filled cut faces.
#pragma once

#include "mesh/tri_mesh.h"

namespace limn {

/// A plane in the space of a mesh's positions, that is, counted from its pivot.
struct CutPlane {
    glm::dvec3 gradient{0, 0, 1};  ///< height(p) = dot(gradient, p) + offset; what is above 0 is cut away
    double offset = 0;
    std::uint32_t material = 0;  ///< of cut faces of the mesh's first material, as in TriMesh::triangleMaterial; those
                                 ///< of its others follow
    std::uint32_t materialCount = 1;  ///< of the mesh; numbers from here on belong to cut faces
    std::uint32_t part = 0;           ///< of the cut faces, as in TriMesh::trianglePart

    double height(const glm::vec3& p) const { return glm::dot(gradient, glm::dvec3(p)) + offset; }
};

/// Does the plane cut any of the mesh away, its lines included?
bool isCut(const TriMesh& mesh, const CutPlane& plane);

struct CutMesh {
    TriMesh mesh;  ///< attributes and indices as the mesh had them; not numbered by last vertex
    std::size_t openOutlines =
        0;  ///< pieces of outline that do not close: surfaces without thickness, which become segments
};

/// Cuts a mesh. Both faces on an edge get the same new vertices, to the bit. Cut faces are filled by nonzero winding,
/// material by material, so that solids of one material inside one another are filled once. A solid has the material of
/// most of its outline.
CutMesh cutMesh(const TriMesh& mesh, const CutPlane& plane, const MeshNeeds& needs);

/// Triangles that fill outlines in a plane with the given normal: nonzero winding. Crossing outlines add points.
std::vector<std::uint32_t> triangulateOutlines(
    std::vector<glm::dvec3>& points, const std::vector<std::vector<std::uint32_t>>& outlines, const glm::dvec3& normal);

}  // namespace limn
