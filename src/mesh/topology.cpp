#include "mesh/topology.h"

#include "mesh/open_mesh.h"
#include "mesh/tri_mesh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
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

namespace {

/// Turns faces around so that neighbours are wound alike, as few as possible in each piece.
void windAlike(PolyMesh& mesh, std::vector<MeshWarning>& warnings) {
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
    if (turnedFaces > 0) warnings.push_back({"face wound against its neighbours; turned around", turnedFaces, 0, {}});
}

/// Newell's normal of a face: its length is twice the area.
glm::dvec3 areaOf(const PolyMesh& mesh, std::size_t face) {
    const std::uint32_t start = mesh.faceStart[face], end = mesh.faceStart[face + 1];
    const glm::dvec3& first = mesh.positions[mesh.cornerPosition[start]];
    glm::dvec3 area(0);
    for (std::uint32_t c = start + 1; c + 1 < end; ++c)
        area += glm::cross(
            mesh.positions[mesh.cornerPosition[c]] - first, mesh.positions[mesh.cornerPosition[c + 1]] - first);
    return area;
}

/// How far a corner's normal points to its face's side: the sign counts.
double towardsFace(const PolyMesh& mesh, std::uint32_t corner, const glm::dvec3& area) {
    const std::int32_t normal = mesh.cornerNormal[corner];
    return normal == PolyMesh::kNone ? 0 : glm::dot(glm::dvec3(mesh.normals[static_cast<std::size_t>(normal)]), area);
}

bool hasNormalsAgainst(const PolyMesh& mesh) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, mesh.faceCount(), 1 << 14), false,
        [&](const auto& range, bool found) {
            for (std::size_t f = range.begin(); f != range.end() && !found; ++f) {
                const glm::dvec3 area = areaOf(mesh, f);
                for (std::uint32_t c = mesh.faceStart[f]; c < mesh.faceStart[f + 1]; ++c)
                    found = found || towardsFace(mesh, c, area) < 0;
            }
            return found;
        },
        [](bool a, bool b) { return a || b; });
}

}  // namespace

void turnNormals(PolyMesh& mesh, std::vector<MeshWarning>& warnings) {
    if (mesh.cornerNormal.empty() || !hasNormalsAgainst(mesh)) return;
    windAlike(mesh, warnings);
    // A vertex is a position with a normal; all its faces vote. Single faces may lie beyond a right angle of the normal
    // that they share, where a smooth shape is coarse.
    struct Vote {
        std::uint32_t position, corner;
        std::int32_t normal;
        double towards;
    };
    std::vector<Vote> votes;
    votes.reserve(mesh.cornerPosition.size());
    for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
        const glm::dvec3 area = areaOf(mesh, f);
        for (std::uint32_t c = mesh.faceStart[f]; c < mesh.faceStart[f + 1]; ++c)
            votes.push_back({mesh.cornerPosition[c], c, mesh.cornerNormal[c], towardsFace(mesh, c, area)});
    }
    const auto vertex = [](const Vote& v) { return std::pair(v.position, v.normal); };
    tbb::parallel_sort(votes.begin(), votes.end(), [&](const Vote& a, const Vote& b) {
        return vertex(a) != vertex(b) ? vertex(a) < vertex(b) : a.corner < b.corner;
    });
    std::vector<std::int32_t> opposite(mesh.normals.size(), PolyMesh::kNone);
    std::size_t turned = 0;
    for (std::size_t i = 0, end = 0; i < votes.size(); i = end) {
        double sum = 0;
        for (end = i; end < votes.size() && vertex(votes[end]) == vertex(votes[i]); ++end) sum += votes[end].towards;
        if (!(sum < 0)) continue;
        ++turned;
        auto& other = opposite[static_cast<std::size_t>(votes[i].normal)];
        if (other == PolyMesh::kNone) {
            other = static_cast<std::int32_t>(mesh.normals.size());
            mesh.normals.push_back(-mesh.normals[static_cast<std::size_t>(votes[i].normal)]);
        }
        for (std::size_t v = i; v < end; ++v) mesh.cornerNormal[votes[v].corner] = other;
    }
    if (turned > 0) warnings.push_back({"vertex normal that points against its faces; turned around", turned, 0, {}});
}

std::size_t joinSeams(PolyMesh& mesh) {
    struct Rim {
        std::uint32_t part, face, low, high;  ///< the ends' positions, ordered by where they lie
    };
    const auto place = [&](std::uint32_t v) {
        const glm::dvec3 p = mesh.positions[v] + 0.0;  // -0 lies where 0 does
        return std::tuple(p.x, p.y, p.z);
    };
    const EdgeTable table = findEdges(mesh);
    std::vector<Rim> rims;
    for (const auto& edge : table.edges) {
        if (edge.useCount != 1 || place(edge.a) == place(edge.b)) continue;
        const bool isOrdered = place(edge.a) < place(edge.b);
        const std::uint32_t face = table.uses[edge.firstUse].face;
        rims.push_back({mesh.facePart[face], face, isOrdered ? edge.a : edge.b, isOrdered ? edge.b : edge.a});
    }
    const auto key = [&](const Rim& rim) { return std::tuple(rim.part, place(rim.low), place(rim.high)); };
    tbb::parallel_sort(rims.begin(), rims.end(), [&](const Rim& x, const Rim& y) {
        const auto a = key(x), b = key(y);
        return a != b ? a < b : std::pair(x.low, x.high) < std::pair(y.low, y.high);
    });
    DisjointSets sets(mesh.positions.size());
    for (std::size_t i = 0, end = 0; i < rims.size(); i = end) {
        for (end = i + 1; end < rims.size() && key(rims[end]) == key(rims[i]);) ++end;
        if (end - i != 2 || rims[i].face == rims[i + 1].face) continue;
        sets.join(rims[i].low, rims[i + 1].low);
        sets.join(rims[i].high, rims[i + 1].high);
    }
    // A face must not come to have a corner twice: what would make it so stays apart.
    std::vector<char> isKept(mesh.positions.size()), isUsed(mesh.positions.size());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> corners;  // what a corner would become, and what it is
    for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
        corners.clear();
        for (std::uint32_t c = mesh.faceStart[f]; c < mesh.faceStart[f + 1]; ++c)
            corners.emplace_back(sets.root(mesh.cornerPosition[c]), mesh.cornerPosition[c]);
        std::sort(corners.begin(), corners.end());
        for (std::size_t c = 1; c < corners.size(); ++c)
            if (corners[c].first == corners[c - 1].first && corners[c].second != corners[c - 1].second)
                isKept[corners[c].first] = 1;
        for (const auto& corner : corners) isUsed[corner.second] = 1;
    }
    const auto rename = [&](std::uint32_t& v) { v = isKept[sets.root(v)] ? v : sets.root(v); };
    std::size_t joined = 0;
    for (std::uint32_t v = 0; v < isUsed.size(); ++v) {
        std::uint32_t renamed = v;
        rename(renamed);
        joined += isUsed[v] && renamed != v;
    }
    if (joined == 0) return 0;
    for (auto& v : mesh.cornerPosition) rename(v);
    for (auto& crease : mesh.tags.creases) {
        rename(crease.a);
        rename(crease.b);
    }
    for (auto& corner : mesh.tags.corners) rename(corner.vertex);
    return joined;
}

void repairTopology(PolyMesh& mesh, std::vector<MeshWarning>& warnings) {
    if (const std::size_t dropped = dropDuplicates(mesh); dropped > 0)
        warnings.push_back({"face that repeats another one; dropped", dropped, 0, {}});
    windAlike(mesh, warnings);
}

/// Vertices whose faces form more than one fan: corners around a vertex hang together across edges of two faces.
static std::size_t countBowTies(const PolyMesh& mesh, const EdgeTable& table) {
    DisjointSets fans(mesh.cornerPosition.size());
    const auto next = [&](const EdgeUse& use) {
        const std::uint32_t end = mesh.faceStart[use.face + 1];
        return use.corner + 1 < end ? use.corner + 1 : mesh.faceStart[use.face];
    };
    for (const auto& edge : table.edges)
        for (std::uint32_t u = edge.firstUse + 1; u < edge.firstUse + edge.useCount; ++u) {
            const EdgeUse &one = table.uses[edge.firstUse], &other = table.uses[u];
            // The corner at edge.a is where a use begins that runs from there, and the next one of a use towards it.
            fans.join(one.forward ? one.corner : next(one), other.forward ? other.corner : next(other));
            fans.join(one.forward ? next(one) : one.corner, other.forward ? next(other) : other.corner);
        }
    std::vector<std::uint32_t> count(mesh.positions.size(), 0);
    for (std::uint32_t c = 0; c < mesh.cornerPosition.size(); ++c) count[mesh.cornerPosition[c]] += fans.root(c) == c;
    return static_cast<std::size_t>(std::count_if(count.begin(), count.end(), [](auto n) { return n > 1; }));
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
        if (glm::length(areaOf(mesh, f)) == 0) ++report.degenerateFaces;
    }
    const HalfEdgeFacts facts = askOpenMesh(mesh, kSmoothAngleDegrees);
    report.boundaryLoops = facts.boundaryLoops;
    report.featureEdges = facts.featureEdges;
    report.nonManifoldVertices = countBowTies(mesh, table);
    return report;
}

}  // namespace limn
