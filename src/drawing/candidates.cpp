#include "drawing/candidates.h"

#include "base/content_key.h"
#include "drawing/smooth_contours.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace limn {
namespace {

/// A triangle seen at less than this sine from its edge is seen from its edge.
constexpr double kEdgeOn = 1e-9;

/// Finds the reasons of one mesh's edges.
class EdgeReasons {
public:
    /// `isSmooth`: SmoothContours'; empty where contours are not wanted.
    EdgeReasons(const ViewedScene& scene, const ViewedMesh& placed, const MeshLineRequest& request,
        const std::vector<char>& isSmooth)
        : scene_(scene), placed_(placed), mesh_(*placed.mesh), request_(request), isSmooth_(isSmooth) {}

    std::optional<Candidate> candidate(const TriangleEdge& edge) const {
        std::vector<std::uint32_t> doubled;
        const Uses uses = distinctUses(edge, doubled);
        const auto turnsAway = [&](std::uint32_t corner) { return scene_.turnsAway(placed_, corner / 3); };
        if (request_.deepest == 0 && std::all_of(uses.begin(), uses.end(), turnsAway)) return std::nullopt;
        const std::uint32_t owner = ownerOf(uses);
        const LineRecord& record = recordOf(owner);
        if (!record.draws) return std::nullopt;
        for (const MeshLineSource source : kMeshLinePriority) {
            if (!request_.wanted[static_cast<std::size_t>(source)] || !holds(source, edge, uses, record)) continue;
            Candidate made;
            for (std::size_t i = 0; i < 2; ++i) {
                const ViewedVertex end = scene_.vertex(placed_, i == 0 ? edge.a : edge.b);
                made.end[i] = end.at;
                made.vertex[i] = end.number;
                made.node[i] = std::uint64_t{end.number} + 1;  // 0 is no node
            }
            made.source = source;
            made.isCurve = source == MeshLineSource::contours && isSmoothEdge(placed_, edge);
            describe(made, scene_, placed_, owner);
            made.component = placed_.firstComponent + placed_.edges->componentOf[edge.a];
            if (uses.size() == 1) made.face = placed_.firstTriangle + uses[0] / 3;
            return made;
        }
        return std::nullopt;
    }

private:
    using Uses = std::span<const std::uint32_t>;

    std::uint32_t materialOf(std::uint32_t triangle) const {
        return mesh_.triangleMaterial.empty() ? 0 : mesh_.triangleMaterial[triangle];
    }
    std::uint32_t partOf(std::uint32_t triangle) const {
        return mesh_.trianglePart.empty() ? 0 : mesh_.trianglePart[triangle];
    }
    const LineRecord& recordOf(std::uint32_t triangle) const {
        const auto& records = placed_.instance->lineRecords;
        return scene_.scene().lineRecords[records.empty() ? 0 : records[materialOf(triangle)]];
    }
    glm::dvec3 cornerAt(std::uint32_t corner) const { return scene_.vertex(placed_, mesh_.indices[corner]).at; }
    static std::uint32_t opposite(std::uint32_t corner) { return corner / 3 * 3 + (corner + 2) % 3; }

    /// The triangles on an edge, once each: sheets that are there twice are one. `kept` holds them where some were left
    /// out.
    Uses distinctUses(const TriangleEdge& edge, std::vector<std::uint32_t>& kept) const {
        const Uses all = Uses(placed_.edges->uses).subspan(edge.firstUse, edge.useCount);
        if (all.size() < 2) return all;
        const auto thirdOf = [&](std::uint32_t corner) {
            return placed_.edges->vertexOf[mesh_.indices[opposite(corner)]];
        };
        if (all.size() == 2 && thirdOf(all[0]) != thirdOf(all[1])) return all;
        for (const std::uint32_t corner : all)
            if (std::none_of(kept.begin(), kept.end(), [&](auto other) { return thirdOf(other) == thirdOf(corner); }))
                kept.push_back(corner);
        return kept;
    }

    /// The side of the edge on which a triangle is seen: −1, 1, or 0 where it is seen from its edge.
    int sideOf(const TriangleEdge& edge, std::uint32_t corner) const {
        const glm::dvec3 a = scene_.vertex(placed_, edge.a).at, b = scene_.vertex(placed_, edge.b).at,
                         c = cornerAt(opposite(corner));
        const double side = scene_.projector().side(a, b, c);
        const double least =
            kEdgeOn * glm::length(b - a) * glm::length(c - a) * (scene_.projector().isParallel ? 1 : glm::length(a));
        return side > least ? 1 : side < -least ? -1 : 0;
    }

    /// The triangle whose object and material an edge belongs to: the first that faces the camera, else the first.
    std::uint32_t ownerOf(Uses uses) const {
        for (const std::uint32_t corner : uses) {
            const std::uint32_t first = corner / 3 * 3;
            const glm::dvec3 p = cornerAt(first), n = glm::cross(cornerAt(first + 1) - p, cornerAt(first + 2) - p);
            if (scene_.projector().facing(n, p) > 0) return corner / 3;
        }
        return uses[0] / 3;
    }

    /// Is the surface seen on one side of the edge only?
    bool isContour(const TriangleEdge& edge, Uses uses) const {
        int sides = 0;
        for (const std::uint32_t corner : uses) {
            const int side = sideOf(edge, corner);
            sides |= side > 0 ? 1 : side < 0 ? 2 : 0;
        }
        return sides != 3;
    }

    /// The shading normal of a triangle's side of an edge: the mean of both ends'.
    glm::dvec3 normalAt(std::uint32_t corner) const {
        const std::uint32_t next = corner / 3 * 3 + (corner + 1) % 3, first = corner / 3 * 3;
        if (!mesh_.normals.empty()) {
            const auto& indices = mesh_.normalIndices.empty() ? mesh_.indices : mesh_.normalIndices;
            const glm::vec3 sum = mesh_.normals[indices[corner]] + mesh_.normals[indices[next]];
            if (glm::dot(sum, sum) > 1e-6f) return glm::normalize(placed_.normalMatrix * glm::dvec3(sum));
        }
        const glm::dvec3 n = glm::cross(cornerAt(first + 1) - cornerAt(first), cornerAt(first + 2) - cornerAt(first));
        const double length = glm::length(n);
        return length > 0 ? n / length : glm::dvec3(0);
    }

    bool isCrease(Uses uses, const LineRecord& record) const {
        const double least =
            record.creaseAngle > 0 ? std::cos(glm::radians(record.creaseAngle)) : request_.creaseCosine;
        for (std::size_t i = 0; i + 1 < uses.size(); ++i)
            for (std::size_t j = i + 1; j < uses.size(); ++j) {
                const glm::dvec3 one = normalAt(uses[i]), other = normalAt(uses[j]);
                if (one == glm::dvec3(0) || other == glm::dvec3(0)) continue;
                const double cosine = glm::dot(one, other);
                const bool runsAlike =
                    placed_.edges->vertexOf[mesh_.indices[uses[i]]] == placed_.edges->vertexOf[mesh_.indices[uses[j]]];
                // Where more than two meet, a surface that goes on through the edge is no crease, whichever way it is
                // wound.
                if ((uses.size() > 2 ? std::abs(cosine) : runsAlike ? -cosine : cosine) < least) return true;
            }
        return false;
    }

    bool differ(Uses uses, const auto& valueOf) const {
        return std::any_of(
            uses.begin(), uses.end(), [&](std::uint32_t corner) { return valueOf(corner) != valueOf(uses[0]); });
    }

    bool holds(MeshLineSource source, const TriangleEdge& edge, Uses uses, const LineRecord& record) const {
        switch (source) {
            case MeshLineSource::sections:
                return differ(uses, [&](std::uint32_t corner) { return recordOf(corner / 3).isCut; });
            case MeshLineSource::contours:
                return uses.size() > 1 && isContour(edge, uses)
                    && !(isSmooth_[placed_.edges->componentOf[edge.a]] && isSmoothEdge(placed_, edge));
            case MeshLineSource::borders: return uses.size() == 1;
            case MeshLineSource::objects: return differ(uses, [&](std::uint32_t corner) { return partOf(corner / 3); });
            case MeshLineSource::materials:
                return differ(
                    uses, [&](std::uint32_t corner) { return placed_.instance->materials[materialOf(corner / 3)]; });
            case MeshLineSource::creases: return isCrease(uses, record);
            case MeshLineSource::intersections:
            case MeshLineSource::marks: return false;
        }
        return false;
    }

    const ViewedScene& scene_;
    const ViewedMesh& placed_;
    const TriMesh& mesh_;
    const MeshLineRequest& request_;
    const std::vector<char>& isSmooth_;
};

/// The lines that a mesh draws itself.
void addMarks(
    const ViewedScene& scene, const ViewedMesh& placed, const MeshLineRequest& request, std::vector<Candidate>& found) {
    const DrawInstance& instance = *placed.instance;
    for (const Segment& segment : placed.mesh->segments) {
        const MeshLineSource source = segment.isCut ? MeshLineSource::sections : MeshLineSource::marks;
        Candidate made;
        made.record = instance.lineRecords.empty() ? 0 : instance.lineRecords[segment.material];
        if (!request.wanted[static_cast<std::size_t>(source)] || !scene.scene().lineRecords[made.record].draws)
            continue;
        made.end = {scene.viewed(placed, segment.a), scene.viewed(placed, segment.b)};
        made.node = {nodeAt(made.end[0]), nodeAt(made.end[1])};
        made.source = source;
        made.instance = static_cast<std::uint32_t>(&instance - scene.scene().instances.data());
        made.material = instance.materials[segment.material];
        found.push_back(made);
    }
}

}  // namespace

void describe(Candidate& made, const ViewedScene& scene, const ViewedMesh& placed, std::uint32_t triangleOfMesh) {
    const TriMesh& mesh = *placed.mesh;
    const std::uint32_t material = mesh.triangleMaterial.empty() ? 0 : mesh.triangleMaterial[triangleOfMesh];
    made.record = placed.instance->lineRecords.empty() ? 0 : placed.instance->lineRecords[material];
    made.instance = static_cast<std::uint32_t>(placed.instance - scene.scene().instances.data());
    made.part = mesh.trianglePart.empty() ? 0 : mesh.trianglePart[triangleOfMesh];
    made.material = placed.instance->materials[material];
}

std::uint64_t nodeAt(const glm::dvec3& place) {
    KeyBuilder key;
    key.add(place.x + 0.0).add(place.y + 0.0).add(place.z + 0.0);
    // The upper half: numbers of vertices and of inner nodes lie below.
    return key.key().low | std::uint64_t{1} << 63;
}

std::vector<Candidate> findCandidates(const ViewedScene& scene, const MeshLineRequest& request) {
    std::vector<Candidate> all;
    for (const auto& placed : scene.meshes()) {
        SmoothContours smooth;
        if (request.wanted[static_cast<std::size_t>(MeshLineSource::contours)])
            smooth = findSmoothContours(scene, placed);
        all.insert(all.end(), smooth.lines.begin(), smooth.lines.end());
        const EdgeReasons reasons(scene, placed, request, smooth.isSmooth);
        const auto& edges = placed.edges->edges;
        // Parts of fixed size, joined in their order.
        constexpr std::size_t kPart = 4096;
        std::vector<std::vector<Candidate>> parts((edges.size() + kPart - 1) / kPart);
        tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
            const std::size_t end = std::min(edges.size(), (part + 1) * kPart);
            for (std::size_t i = part * kPart; i < end; ++i)
                if (auto made = reasons.candidate(edges[i])) parts[part].push_back(*made);
        });
        for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    }
    for (const auto& placed : scene.meshes()) addMarks(scene, placed, request, all);
    if (request.wanted[static_cast<std::size_t>(MeshLineSource::intersections)])
        findIntersections(scene, request.deepest > 0, all);
    return all;
}

}  // namespace limn
