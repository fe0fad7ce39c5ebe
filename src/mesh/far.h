// The bridge to OpenSubdiv's Far: cages as topology refiners. Only subdivision includes it, since OpenSubdiv's headers
// are large.
#pragma once

#include "mesh/subdivide.h"

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>

namespace limn {
namespace far {

/// What PrimvarRefiner interpolates: N numbers in double precision.
template <int N>
struct Value {
    glm::vec<N, double, glm::defaultp> v{0};
    void Clear() { v = glm::vec<N, double, glm::defaultp>(0); }
    void AddWithWeight(const Value& other, double weight) { v += other.v * weight; }
};

}  // namespace far

/// The cage's topology with its creases, corners, holes and, if asked, UVs as channel 0 (corners without one have the
/// value after the last). Every index is in range already: OpenSubdiv does not check. Creases on missing edges are left
/// out. Throws Error (internal) if OpenSubdiv refuses.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> makeRefiner(
    const PolyMesh& cage, const SubdivisionOptions& options, bool withUvs);

/// Levels until the last semi-sharp crease or corner has gone smooth.
int levelsOfCreases(const SubdivisionTags& tags);

/// The mesh's uvs, and one more for corners without one.
std::vector<glm::dvec2> uvValues(const PolyMesh& mesh);

}  // namespace limn
