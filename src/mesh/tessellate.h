// Tessellation of limit surfaces, edge by edge as finely as asked for.
#pragma once

#include "mesh/subdivide.h"

#include <cstdint>

namespace limn {

/// What a triangle of a subdivided mesh takes, from here to the GPU's buffers (which software renderers have in the
/// same memory): measured 85 bytes at 12 million of them.
inline constexpr std::uint64_t kTriangleBytes = 100;
inline constexpr const char* kFewerTriangles = "lower subdivision.level, or ask for a longer edge_length";

/// Triangles of the limit surface, watertight, not yet numbered by their last vertex; positions relative to `pivot`.
/// Attributes have indices of their own. `byBfr`: points come from OpenSubdiv's Bfr, and the cage must have no interior
/// vertex of two faces; else from Far's patches. Throws Error (out of memory) naming `name` before it takes more memory
/// than there is.
TriMesh tessellate(const PolyMesh& cage, const SubdivisionOptions& options, const MeshNeeds& needs,
    const glm::dvec3& pivot, bool byBfr, const std::string& name);

}  // namespace limn
