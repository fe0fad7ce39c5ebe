#include "drawing/edge_table.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace limn {
namespace {

constexpr std::uint32_t kFree = ~std::uint32_t{0};

/// Vertices this close are one, in parts of the mesh's size: a few roundings of coordinates, which are what is between
/// the vertices of cracks that nobody meant.
constexpr double kSamePlace = 2e-7;

using Cell = std::array<std::int64_t, 3>;

std::uint64_t mixed(const Cell& cell) {
    // Multiplicative hashing by odd numbers near the golden ratio (Knuth, TAOCP 3, 6.4).
    std::uint64_t h = static_cast<std::uint64_t>(cell[0]) * 0x9E3779B97F4A7C15u;
    h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(cell[1])) * 0xBF58476D1CE4E5B9u;
    h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(cell[2])) * 0x94D049BB133111EBu;
    return h ^ (h >> 31);
}

/// Finds the first position in each place.
class Places {
public:
    explicit Places(const std::vector<glm::vec3>& positions)
        : positions_(positions), table_(std::bit_ceil(2 * positions.size() + 1), kFree) {
        Bounds box;
        for (const auto& p : positions) box.add(glm::dvec3(p));
        low_ = box.lo;
        near_ = kSamePlace * box.diagonal();
        side_ = near_ > 0 ? 16 * near_ : 1;
    }

    std::uint32_t firstAt(std::uint32_t i) {
        // Cells are wide: few positions lie so near the side of theirs that the next one matters.
        const glm::dvec3 at = (glm::dvec3(positions_[i]) - low_) / side_;
        const double margin = near_ / side_;
        Cell first, last, own;
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = at[static_cast<int>(k)];
            own[k] = static_cast<std::int64_t>(std::floor(x));
            first[k] = static_cast<std::int64_t>(std::floor(x - margin));
            last[k] = static_cast<std::int64_t>(std::floor(x + margin));
        }
        std::uint32_t found = kFree;
        Cell cell;
        for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0])
            for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1])
                for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2]) found = std::min(found, look(cell, i));
        if (found == kFree) insert(own, i);
        return std::min(found, i);
    }

private:
    std::size_t mask() const { return table_.size() - 1; }
    std::uint32_t look(const Cell& cell, std::uint32_t i) const {
        for (std::size_t slot = mixed(cell) & mask(); table_[slot] != kFree; slot = (slot + 1) & mask()) {
            const glm::vec3 apart = glm::abs(positions_[table_[slot]] - positions_[i]);
            if (static_cast<double>(std::max({apart.x, apart.y, apart.z})) <= near_) return table_[slot];
        }
        return kFree;
    }
    void insert(const Cell& cell, std::uint32_t i) {
        std::size_t slot = mixed(cell) & mask();
        while (table_[slot] != kFree) slot = (slot + 1) & mask();
        table_[slot] = i;
    }

    const std::vector<glm::vec3>& positions_;
    std::vector<std::uint32_t> table_;
    glm::dvec3 low_{0};
    double near_ = 0, side_ = 1;
};

std::vector<std::uint32_t> joinPlaces(const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> vertexOf(positions.size());
    Places places(positions);
    for (std::uint32_t i = 0; i < positions.size(); ++i) vertexOf[i] = places.firstAt(i);
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
