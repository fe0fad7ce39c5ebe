#include "mesh/open_mesh.h"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/GenProg.hh>

#include <algorithm>

namespace limn {
namespace {

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using HalfEdges = OpenMesh::PolyMesh_ArrayKernelT<Traits>;

}  // namespace

HalfEdgeFacts askOpenMesh(const PolyMesh& mesh, double featureAngleDegrees) {
    HalfEdges half;
    half.reserve(mesh.positions.size(), mesh.cornerPosition.size(), mesh.faceCount());
    for (const auto& p : mesh.positions) half.add_vertex(HalfEdges::Point(p.x, p.y, p.z));
    HalfEdgeFacts facts;
    omerr().disable();  // add_face tells standard error about each face it refuses; we count them
    std::vector<HalfEdges::VertexHandle> corners;
    for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
        corners.clear();
        for (std::uint32_t c = mesh.faceStart[f]; c < mesh.faceStart[f + 1]; ++c)
            corners.emplace_back(static_cast<int>(mesh.cornerPosition[c]));
        std::vector<HalfEdges::VertexHandle> sorted = corners;
        std::sort(sorted.begin(), sorted.end());
        const bool repeats = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
        if (repeats || !half.add_face(corners).is_valid()) ++facts.refusedFaces;
    }
    omerr().enable();
    half.request_face_normals();
    half.update_face_normals();

    std::vector<char> seen(half.n_halfedges(), 0);
    for (const auto h : half.halfedges()) {
        if (!half.is_boundary(h) || seen[static_cast<std::size_t>(h.idx())]) continue;
        ++facts.boundaryLoops;
        for (auto next = HalfEdges::HalfedgeHandle(h); !seen[static_cast<std::size_t>(next.idx())];
             next = half.next_halfedge_handle(next))
            seen[static_cast<std::size_t>(next.idx())] = 1;
    }
    for (const auto e : half.edges())
        if (!half.is_boundary(e) && std::abs(half.calc_dihedral_angle(e)) > glm::radians(featureAngleDegrees))
            ++facts.featureEdges;
    return facts;
}

}  // namespace limn
