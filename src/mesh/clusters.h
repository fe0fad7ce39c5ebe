// Small groups of triangles with boxes around them: culling need not look at every triangle.
#pragma once

#include "mesh/tri_mesh.h"

namespace limn {

/// Consecutive triangles of a mesh, and the box around them in mesh units from the mesh's pivot.
struct Cluster {
    std::uint32_t firstTriangle = 0, triangleCount = 0;
    glm::vec3 centre{0}, half{0};
};

/// Cuts the whole mesh into clusters of up to 64 triangles, in order. Parallel.
std::vector<Cluster> makeClusters(const TriMesh& mesh);

}  // namespace limn
