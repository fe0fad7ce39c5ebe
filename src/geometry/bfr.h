// Tessellation of limit surfaces by OpenSubdiv's Bfr.
#pragma once

#include "geometry/subdivide.h"

namespace limn {

/// Triangles of the limit surface, watertight, not yet numbered by their last vertex; positions relative to `pivot`. The cage must have no
/// interior vertex of two faces. Attributes have indices of their own.
TriMesh tessellateByBfr(const PolyMesh& cage, const SubdivisionOptions& options, const MeshNeeds& needs, const glm::dvec3& pivot);

}  // namespace limn
