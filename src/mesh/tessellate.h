// Tessellation of limit surfaces, edge by edge as finely as asked for.
#pragma once

#include "mesh/subdivide.h"

namespace limn {

/// Triangles of the limit surface, watertight, not yet numbered by their last vertex; positions relative to `pivot`.
/// Attributes have indices of their own. `byBfr`: points come from OpenSubdiv's Bfr, and the cage must have no interior
/// vertex of two faces; else from Far's patches.
TriMesh tessellate(const PolyMesh& cage, const SubdivisionOptions& options, const MeshNeeds& needs,
    const glm::dvec3& pivot, bool byBfr);

}  // namespace limn
