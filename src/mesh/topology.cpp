#include "mesh/topology.h"

#include "mesh/open_mesh.h"
#include "mesh/tri_mesh.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>
#include <queue>

namespace limn {
namespace {

/// Path-halving union-find.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) { parent_[std::max(root(a), root(b))] = std::min(root(a), root(b)); }

private:
    std::vector<std::uint32_t> parent_;
};

void reverseFace(PolyMesh& mesh, std::size_t face) {
    const auto turn = [&](auto& values) {
        if (!values.empty())
            std::reverse(values.begin() + mesh.faceStart[face], values.begin() + mesh.faceStart[face + 1]);
    };
    turn(mesh.cornerPosition);
    turn(mesh.cornerUv);
    turn(mesh.cornerNormal);
}

std::size_t dropDuplicates(PolyMesh& mesh) {
    // Faces with the same corners, wherever they start and whichever way they run, have the same sorted corners.
    struct Key {
        std::uint32_t least, most, size, face;
        std::uint64_t sum;
    };
    std::vector<Key> keys(mesh.faceCount());
    for (std::uint32_t f = 0; f < keys.size(); ++f) {
        const auto first = mesh.cornerPosition.begin() + mesh.faceStart[f],
                   last = mesh.cornerPosition.begin() + mesh.faceStart[f + 1];
        const auto [least, most] = std::minmax_element(first, last);
        keys[f] = {
            *least, *most, static_cast<std::uint32_t>(last - first), f, std::accumulate(first, last, std::uint64_t{0})};
    }
    const auto order = [](const Key& k) { return std::tuple(k.least, k.most, k.size, k.sum, k.face); };
    tbb::parallel_sort(keys.begin(), keys.end(), [&](const Key& x, const Key& y) { return order(x) < order(y); });
    std::vector<char> keep(keys.size(), 1);
    std::size_t dropped = 0;
    const auto sorted = [&](std::uint32_t f) {
        std::vector<std::uint32_t> corners(
            mesh.cornerPosition.begin() + mesh.faceStart[f], mesh.cornerPosition.begin() + mesh.faceStart[f + 1]);
        std::sort(corners.begin(), corners.end());
        return corners;
    };
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t end = i + 1;
        while (end < keys.size()
            && std::tuple(keys[end].least, keys[end].most, keys[end].size, keys[end].sum)
                == std::tuple(keys[i].least, keys[i].most, keys[i].size, keys[i].sum))
            ++end;
        for (std::size_t j = i + 1; j < end; ++j)
            for (std::size_t k = i; k < j; ++k)
                if (keep[keys[k].face] && sorted(keys[j].face) == sorted(keys[k].face)) {
                    keep[keys[j].face] = 0;
                    ++dropped;
                    break;
                }
        i = end;
    }
    if (dropped > 0) keepFaces(mesh, keep);
    return dropped;
}

}  // namespace

void keepFaces(PolyMesh& mesh, const std::vector<char>& keep) {
    std::vector<std::uint32_t> newNumber(mesh.faceCount());
    std::size_t kept = 0, corner = 0;
    for (std::size_t f = 0; f < keep.size(); ++f) {
        newNumber[f] = static_cast<std::uint32_t>(kept);
        if (!keep[f]) continue;
        const std::size_t start = mesh.faceStart[f], end = mesh.faceStart[f + 1];
        const auto move = [&](auto& values) {
            if (!values.empty())
                std::copy(values.begin() + static_cast<std::ptrdiff_t>(start),
                    values.begin() + static_cast<std::ptrdiff_t>(end),
                    values.begin() + static_cast<std::ptrdiff_t>(corner));
        };
        move(mesh.cornerPosition);
        move(mesh.cornerUv);
        move(mesh.cornerNormal);
        mesh.faceMaterial[kept] = mesh.faceMaterial[f];
        mesh.facePart[kept] = mesh.facePart[f];
        mesh.faceSmoothing[kept] = mesh.faceSmoothing[f];
        corner += end - start;
        mesh.faceStart[++kept] = static_cast<std::uint32_t>(corner);
    }
    const auto cut = [&](auto& values, std::size_t size) {
        if (!values.empty()) values.resize(size);
    };
    mesh.faceStart.resize(kept + 1);
    cut(mesh.cornerPosition, corner);
    cut(mesh.cornerUv, corner);
    cut(mesh.cornerNormal, corner);
    cut(mesh.faceMaterial, kept);
    cut(mesh.facePart, kept);
    cut(mesh.faceSmoothing, kept);
    std::vector<std::uint32_t> holes;
    for (const auto hole : mesh.tags.holes)
        if (keep[hole]) holes.push_back(newNumber[hole]);
    mesh.tags.holes = std::move(holes);
}

std::int64_t EdgeTable::find(std::uint32_t a, std::uint32_t b) const {
    const std::pair key(std::min(a, b), std::max(a, b));
    const auto at = std::lower_bound(edges.begin(), edges.end(), key,
        [](const MeshEdge& edge, const auto& k) { return std::pair(edge.a, edge.b) < k; });
    return at != edges.end() && std::pair(at->a, at->b) == key ? at - edges.begin() : -1;
}

EdgeTable findEdges(const PolyMesh& mesh) {
    struct Record {
        std::uint64_t key;
        EdgeUse use;
    };
    std::vector<Record> records(mesh.cornerPosition.size());
    for (std::uint32_t f = 0; f < mesh.faceCount(); ++f) {
        const std::uint32_t start = mesh.faceStart[f], end = mesh.faceStart[f + 1];
        for (std::uint32_t c = start; c < end; ++c) {
            const std::uint32_t from = mesh.cornerPosition[c], to = mesh.cornerPosition[c + 1 < end ? c + 1 : start];
            records[c] = {std::uint64_t{std::min(from, to)} << 32 | std::max(from, to), {c, f, from < to}};
        }
    }
    tbb::parallel_sort(records.begin(), records.end(),
        [](const Record& x, const Record& y) { return x.key != y.key ? x.key < y.key : x.use.corner < y.use.corner; });
    EdgeTable table;
    table.uses.reserve(records.size());
    table.cornerEdge.resize(records.size());
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto& r = records[i];
        if (i == 0 || r.key != records[i - 1].key)
            table.edges.push_back({static_cast<std::uint32_t>(r.key >> 32), static_cast<std::uint32_t>(r.key),
                static_cast<std::uint32_t>(i), 0});
        ++table.edges.back().useCount;
        table.uses.push_back(r.use);
        table.cornerEdge[r.use.corner] = static_cast<std::uint32_t>(table.edges.size() - 1);
    }
    return table;
}

Components findComponents(const PolyMesh& mesh) {
    DisjointSets sets(mesh.positions.size());
    for (std::size_t f = 0; f < mesh.faceCount(); ++f)
        for (std::uint32_t c = mesh.faceStart[f] + 1; c < mesh.faceStart[f + 1]; ++c)
            sets.join(mesh.cornerPosition[c - 1], mesh.cornerPosition[c]);
    constexpr std::uint32_t none = ~0u;
    Components components;
    std::vector<std::uint32_t> number(mesh.positions.size(), none);
    components.ofFace.resize(mesh.faceCount());
    for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
        std::uint32_t& n = number[sets.root(mesh.cornerPosition[mesh.faceStart[f]])];
        if (n == none) n = components.count++;
        components.ofFace[f] = n;
    }
    return components;
}

void repairTopology(PolyMesh& mesh, std::vector<MeshWarning>& warnings) {
    if (const std::size_t dropped = dropDuplicates(mesh); dropped > 0)
        warnings.push_back({"face that repeats another one; dropped", dropped, 0});

    const EdgeTable table = findEdges(mesh);
    const auto disagrees = [&](const MeshEdge& edge) {
        return edge.useCount == 2 && table.uses[edge.firstUse].forward == table.uses[edge.firstUse + 1].forward;
    };
    if (std::none_of(table.edges.begin(), table.edges.end(), disagrees)) return;

    constexpr char unseen = 2;
    std::vector<char> turned(mesh.faceCount(), unseen);
    std::size_t turnedFaces = 0;
    for (std::uint32_t seed = 0; seed < mesh.faceCount(); ++seed) {
        if (turned[seed] != unseen) continue;
        std::vector<std::uint32_t> piece{seed};
        turned[seed] = 0;
        bool possible = true;
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const std::uint32_t face = piece[i];
            for (std::uint32_t c = mesh.faceStart[face]; c < mesh.faceStart[face + 1]; ++c) {
                const MeshEdge& edge = table.edges[table.cornerEdge[c]];
                if (edge.useCount != 2) continue;
                const EdgeUse& first = table.uses[edge.firstUse];
                const EdgeUse& second = table.uses[edge.firstUse + 1];
                const std::uint32_t other = first.face == face ? second.face : first.face;
                if (other == face) continue;
                const char wanted = static_cast<char>(turned[face] ^ (disagrees(edge) ? 1 : 0));
                if (turned[other] == unseen) {
                    turned[other] = wanted;
                    piece.push_back(other);
                } else if (turned[other] != wanted)
                    possible = false;
            }
        }
        const auto count =
            static_cast<std::size_t>(std::count_if(piece.begin(), piece.end(), [&](auto f) { return turned[f] == 1; }));
        const char minority = count * 2 > piece.size() ? 0 : 1;
        for (const auto f : piece) {
            if (!possible || turned[f] != minority) continue;
            reverseFace(mesh, f);
            ++turnedFaces;
        }
    }
    if (turnedFaces > 0) warnings.push_back({"face wound against its neighbours; turned around", turnedFaces, 0});
}

TopologyReport analyseTopology(const PolyMesh& mesh) {
    TopologyReport report;
    const EdgeTable table = findEdges(mesh);
    report.components = findComponents(mesh).count;
    report.edges = table.edges.size();
    std::vector<std::uint32_t> facesAround(mesh.positions.size(), 0), edgesAround(mesh.positions.size(), 0),
        borders(mesh.positions.size(), 0);
    for (const auto v : mesh.cornerPosition) ++facesAround[v];
    for (const auto& edge : table.edges) {
        ++edgesAround[edge.a];
        ++edgesAround[edge.b];
        if (edge.useCount == 1) {
            ++report.boundaryEdges;
            ++borders[edge.a];
            ++borders[edge.b];
        }
        if (edge.useCount > 2) ++report.nonManifoldEdges;
        if (edge.useCount == 2 && table.uses[edge.firstUse].forward == table.uses[edge.firstUse + 1].forward)
            ++report.unorientable;
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (facesAround[v] == 0)
            ++report.unusedVertices;
        else
            ++report.vertices;
        report.largestValence = std::max<std::size_t>(report.largestValence, edgesAround[v]);
        if (facesAround[v] == 2 && edgesAround[v] == 2) ++report.valenceTwo;
    }
    for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
        const std::uint32_t start = mesh.faceStart[f], end = mesh.faceStart[f + 1];
        report.largestFace = std::max<std::size_t>(report.largestFace, end - start);
        glm::dvec3 area(0);
        const auto& origin = mesh.positions[mesh.cornerPosition[start]];
        for (std::uint32_t c = start + 1; c + 1 < end; ++c)
            area += glm::cross(
                mesh.positions[mesh.cornerPosition[c]] - origin, mesh.positions[mesh.cornerPosition[c + 1]] - origin);
        if (glm::length(area) == 0) ++report.degenerateFaces;
    }
    const HalfEdgeFacts facts = askOpenMesh(mesh, kSmoothAngleDegrees);
    report.boundaryLoops = facts.boundaryLoops;
    report.featureEdges = facts.featureEdges;
    report.nonManifoldVertices = facts.nonManifoldVertices;
    return report;
}

}  // namespace limn
