#include "drawing/edge_table.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cstddef>

namespace limn {
namespace {

constexpr std::uint32_t kFree = ~std::uint32_t{0};

std::uint64_t mixed(const glm::vec3& p) {
    // Multiplicative hashing by odd numbers near the golden ratio (Knuth, TAOCP 3, 6.4); −0 is 0.
    const auto bits = [](float x) { return std::uint64_t{std::bit_cast<std::uint32_t>(x + 0.0f)}; };
    std::uint64_t h = (bits(p.x) << 32 | bits(p.y)) * 0x9E3779B97F4A7C15u;
    h = (h ^ (h >> 29) ^ bits(p.z)) * 0xBF58476D1CE4E5B9u;
    return h ^ (h >> 32);
}

std::vector<std::uint32_t> joinPlaces(const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> vertexOf(positions.size());
    std::vector<std::uint32_t> table(std::bit_ceil(2 * positions.size() + 1), kFree);
    const std::size_t mask = table.size() - 1;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        std::size_t slot = mixed(positions[i]) & mask;
        while (table[slot] != kFree && positions[table[slot]] != positions[i]) slot = (slot + 1) & mask;
        if (table[slot] == kFree) table[slot] = i;
        vertexOf[i] = table[slot];
    }
    return vertexOf;
}

struct Use {
    std::uint64_t ends;  ///< a in the upper half, b in the lower
    std::uint32_t corner;
    bool operator<(const Use& other) const { return ends != other.ends ? ends < other.ends : corner < other.corner; }
};

std::vector<Use> sortedUses(const TriMesh& mesh, const std::vector<std::uint32_t>& vertexOf) {
    std::vector<Use> uses(mesh.indices.size());
    tbb::parallel_for(std::size_t{0}, mesh.triangleCount(), [&](std::size_t t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t from = vertexOf[mesh.indices[3 * t + k]],
                                to = vertexOf[mesh.indices[3 * t + (k + 1) % 3]];
            uses[3 * t + k] = {std::min(from, to) << 32 | std::max(from, to), static_cast<std::uint32_t>(3 * t + k)};
        }
    });
    tbb::parallel_sort(uses);
    return uses;
}

/// The first vertex of a component, with the way to it made shorter.
std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t vertex) {
    while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
    return vertex;
}

/// Numbers the components in the order of their first vertices.
void findComponents(TriangleEdges& found) {
    std::vector<std::uint32_t> parent = found.vertexOf;
    for (const auto& edge : found.edges) {
        const std::uint32_t a = rootOf(parent, edge.a), b = rootOf(parent, edge.b);
        parent[std::max(a, b)] = std::min(a, b);
    }
    found.componentOf.resize(parent.size());
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < parent.size(); ++i) {
        const std::uint32_t root = rootOf(parent, i);
        found.componentOf[i] = root == i ? count++ : found.componentOf[root];
    }
    found.components.resize(count);
}

/// Measures the components' boxes, and finds those that are closed.
void measureComponents(const TriMesh& mesh, TriangleEdges& found) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        found.components[found.componentOf[i]].box.add(glm::dvec3(mesh.positions[i]));
    std::vector<char> isOpen(found.components.size());
    for (const auto& edge : found.edges) {
        // Two triangles, one along the edge and one against it.
        const auto beginOf = [&](std::uint32_t use) { return found.vertexOf[mesh.indices[found.uses[use]]]; };
        if (edge.useCount != 2 || beginOf(edge.firstUse) == beginOf(edge.firstUse + 1))
            isOpen[found.componentOf[edge.a]] = true;
    }
    // The divergence theorem: six times the volume.
    std::vector<double> volume(found.components.size());
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const std::uint32_t component = found.componentOf[mesh.indices[3 * t]];
        const auto corner = [&](std::size_t k) {
            return glm::dvec3(mesh.positions[mesh.indices[3 * t + k]]) - found.components[component].box.lo;
        };
        volume[component] += glm::dot(corner(0), glm::cross(corner(1), corner(2)));
    }
    for (std::size_t i = 0; i < found.components.size(); ++i)
        if (!isOpen[i] && volume[i] != 0) found.components[i].outward = volume[i] > 0 ? 1 : -1;
}

}  // namespace

TriangleEdges findTriangleEdges(const TriMesh& mesh) {
    TriangleEdges result;
    result.vertexOf = joinPlaces(mesh.positions);
    const std::vector<Use> uses = sortedUses(mesh, result.vertexOf);
    result.uses.reserve(uses.size());
    result.edges.reserve(uses.size() / 2);
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t end = i;
        while (end < uses.size() && uses[end].ends == uses[i].ends) ++end;
        const auto a = static_cast<std::uint32_t>(uses[i].ends >> 32), b = static_cast<std::uint32_t>(uses[i].ends);
        if (a != b) {
            result.edges.push_back(
                {a, b, static_cast<std::uint32_t>(result.uses.size()), static_cast<std::uint32_t>(end - i)});
            for (; i < end; ++i) result.uses.push_back(uses[i].corner);
        }
        i = end;
    }
    findComponents(result);
    measureComponents(mesh, result);
    return result;
}

}  // namespace limn
