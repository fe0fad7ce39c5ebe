// Facts about a mesh from OpenMesh's half-edges. Kept apart: OpenMesh's headers are large.
#pragma once

#include "mesh/poly_mesh.h"

namespace limn {

struct HalfEdgeFacts {
    std::size_t boundaryLoops = 0;
    std::size_t featureEdges = 0;  ///< interior edges with a dihedral angle beyond the one asked for
    std::size_t refusedFaces = 0;  ///< that half-edges cannot represent; they are left out of the other counts
};

/// Builds half-edges from the mesh's faces.
HalfEdgeFacts askOpenMesh(const PolyMesh& mesh, double featureAngleDegrees);

}  // namespace limn
