#include "mesh/clusters.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace limn {

std::vector<Cluster> makeClusters(const TriMesh& mesh) {
    constexpr std::size_t kTriangles = 64;  // half of a patch cut eight by eight
    std::vector<Cluster> clusters((mesh.triangleCount() + kTriangles - 1) / kTriangles);
    tbb::parallel_for(std::size_t{0}, clusters.size(), [&](std::size_t i) {
        const std::size_t first = i * kTriangles, count = std::min(kTriangles, mesh.triangleCount() - first);
        glm::vec3 low(std::numeric_limits<float>::infinity()), high(-std::numeric_limits<float>::infinity());
        for (std::size_t corner = 3 * first; corner < 3 * (first + count); ++corner) {
            const glm::vec3& p = mesh.positions[mesh.indices[corner]];
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        // Rounded up, so that the box holds its triangles.
        clusters[i] = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), 0.5f * (low + high),
            0.5f * (high - low) + 1e-6f * glm::max(glm::abs(low), glm::abs(high))};
    });
    return clusters;
}

}  // namespace limn
