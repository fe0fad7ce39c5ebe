// Triangles in small groups with boxes around them, so that what cannot be seen is found without looking at every
// triangle.
#pragma once

#include "mesh/tri_mesh.h"

namespace limn {

/// Triangles of a mesh that follow each other, and the box around them in mesh units from the mesh's pivot.
struct Cluster {
    std::uint32_t firstTriangle = 0, triangleCount = 0;
    glm::vec3 centre{0}, half{0};
};

/// Clusters of up to 64 triangles, in the order of the triangles; together they are all of the mesh. Parallel.
std::vector<Cluster> makeClusters(const TriMesh& mesh);

}  // namespace limn
