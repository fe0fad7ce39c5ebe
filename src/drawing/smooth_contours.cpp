#include "drawing/smooth_contours.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// The lift, in the largest product of an edge's length and the angle between the normals at its ends: twice the height
/// of a circle's arc over its chord, an eighth of that product.
constexpr double kLift = 0.25;
/// Where normals at the ends of an edge differ by more, facets stand for no surface that could be told; radians.
constexpr double kMostTurn = 0.15;
/// Normals are the same up to this.
constexpr float kSameNormal = 1e-4f;

/// The normal of a corner as the file or the surface has it; zero where there is none.
glm::vec3 normalOf(const TriMesh& mesh, std::uint32_t corner) {
    return mesh.normals[(mesh.normalIndices.empty() ? mesh.indices : mesh.normalIndices)[corner]];
}

class Finder {
public:
    Finder(const ViewedScene& scene, const ViewedMesh& placed)
        : scene_(scene), placed_(placed), mesh_(*placed.mesh), edgeOfCorner_(mesh_.indices.size(), kNoVertex) {
        const auto& edges = placed.edges->edges;
        tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t e) {
            for (std::uint32_t u = 0; u < edges[e].useCount; ++u)
                edgeOfCorner_[placed.edges->uses[edges[e].firstUse + u]] = static_cast<std::uint32_t>(e);
        });
    }

    SmoothContours find() const {
        constexpr std::size_t kPart = 4096;
        std::vector<std::vector<Candidate>> parts((mesh_.triangleCount() + kPart - 1) / kPart);
        tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
            const std::size_t end = std::min(mesh_.triangleCount(), (part + 1) * kPart);
            for (std::size_t t = part * kPart; t < end; ++t) {
                Candidate made;
                if (cross(static_cast<std::uint32_t>(t), made)) parts[part].push_back(made);
            }
        });
        SmoothContours result;
        result.isSmooth = findSmooth(parts);
        for (const auto& part : parts)
            for (const auto& line : part)
                if (result.isSmooth[line.component - placed_.firstComponent]) result.lines.push_back(line);
        return result;
    }

private:
    glm::dvec3 viewedNormal(std::uint32_t corner) const {
        const glm::dvec3 n = placed_.normalMatrix * glm::dvec3(normalOf(mesh_, corner));
        const double length = glm::length(n);
        return length > 0 ? n / length : n;
    }
    glm::dvec3 at(std::uint32_t corner) const { return scene_.vertex(placed_, mesh_.indices[corner]).at; }
    double facing(std::uint32_t corner, const glm::dvec3& normal) const {
        return scene_.projector().facing(normal, at(corner));
    }

    /// The lift of a triangle's contour; where wanted, the largest angle between its corners' normals too.
    double liftOf(std::uint32_t triangle, double* turn = nullptr) const {
        double most = 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = 3 * triangle + k, b = 3 * triangle + (k + 1) % 3;
            const double angle = glm::distance(viewedNormal(a), viewedNormal(b));
            most = std::max(most, glm::distance(at(a), at(b)) * angle);
            if (turn) *turn = std::max(*turn, angle);
        }
        return kLift * most;
    }

    double inPixels(double length, const glm::dvec3& p) const {
        return length / (scene_.projector().rayScale.x * (scene_.projector().isParallel ? 1 : std::max(-p.z, 1e-30)));
    }

    /// Is a triangle fine enough for its smooth contour?
    bool isFine(std::uint32_t triangle) const {
        double turn = 0;
        const double lift = liftOf(triangle, &turn);
        double pixels = 0;
        for (std::uint32_t k = 0; k < 3; ++k) pixels = std::max(pixels, inPixels(lift, at(3 * triangle + k)));
        return pixels <= kMostLift && turn <= kMostTurn;
    }

    bool facesCamera(std::uint32_t triangle) const {
        const glm::dvec3 p = at(3 * triangle), n = glm::cross(at(3 * triangle + 1) - p, at(3 * triangle + 2) - p);
        return scene_.projector().facing(n, p) > 0;
    }

    /// Those components whose triangles are fine wherever the smooth contour or the mesh's own goes.
    std::vector<char> findSmooth(const std::vector<std::vector<Candidate>>& parts) const {
        std::vector<char> isSmooth(placed_.edges->components.size(), true);
        for (const auto& part : parts)
            for (const auto& line : part)
                if (!isFine(line.within[0] - placed_.firstTriangle))
                    isSmooth[line.component - placed_.firstComponent] = false;
        const auto& edges = placed_.edges->edges;
        std::vector<char> isCoarse(edges.size());
        tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t e) {
            const std::uint32_t* uses = placed_.edges->uses.data() + edges[e].firstUse;
            isCoarse[e] = edges[e].useCount == 2 && facesCamera(uses[0] / 3) != facesCamera(uses[1] / 3)
                && isSmoothEdge(placed_, edges[e]) && !(isFine(uses[0] / 3) && isFine(uses[1] / 3));
        });
        for (std::size_t e = 0; e < edges.size(); ++e)
            if (isCoarse[e]) isSmooth[placed_.edges->componentOf[edges[e].a]] = false;
        return isSmooth;
    }

    /// Where the contour crosses an edge; the same from both triangles where the edge is smooth.
    struct Crossing {
        glm::dvec3 at{0}, lift{0};
    };
    Crossing crossingOf(std::uint32_t corner) const {
        std::uint32_t a = corner, b = corner / 3 * 3 + (corner + 1) % 3;
        if (scene_.vertex(placed_, mesh_.indices[a]).number > scene_.vertex(placed_, mesh_.indices[b]).number)
            std::swap(a, b);
        const glm::dvec3 one = viewedNormal(a), other = viewedNormal(b);
        const double atA = facing(a, one), atB = facing(b, other), t = atA / (atA - atB);
        const TriangleEdge& edge = placed_.edges->edges[edgeOfCorner_[corner]];
        double lift = liftOf(corner / 3);
        for (std::uint32_t u = 0; u < edge.useCount && isSmoothEdge(placed_, edge); ++u)
            lift = std::max(lift, liftOf(placed_.edges->uses[edge.firstUse + u] / 3));
        const glm::dvec3 p = glm::mix(at(a), at(b), t), n = glm::mix(one, other, t);
        const double length = glm::length(n);
        const glm::dvec3 outward = length > 0 ? n / length : n;
        // The surface's arc over the edge.
        const double arc = 0.5 * t * (1 - t) * glm::distance(at(a), at(b)) * glm::distance(one, other);
        return {p + outward * arc, outward * (lift - arc)};
    }

    /// The piece of contour within a triangle.
    bool cross(std::uint32_t triangle, Candidate& made) const {
        std::array<bool, 3> isFront;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const glm::dvec3 normal = viewedNormal(3 * triangle + k);
            if (normal == glm::dvec3(0)) return false;
            isFront[k] = facing(3 * triangle + k, normal) > 0;
        }
        if (isFront[0] == isFront[1] && isFront[1] == isFront[2]) return false;
        describe(made, scene_, placed_, triangle);
        made.isCurve = true;
        if (!scene_.scene().lineRecords[made.record].draws) return false;
        std::size_t end = 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = 3 * triangle + k;
            if (isFront[k] == isFront[(k + 1) % 3] || edgeOfCorner_[corner] == kNoVertex) continue;
            const Crossing crossing = crossingOf(corner);
            made.end[end] = crossing.at;
            made.lift[end] = crossing.lift;
            made.node[end++] = nodeOf(corner);
        }
        if (end < 2) return false;
        made.within[0] = placed_.firstTriangle + triangle;
        made.component =
            placed_.firstComponent + placed_.edges->componentOf[placed_.edges->vertexOf[mesh_.indices[3 * triangle]]];
        return true;
    }

    /// A node for the contour's crossing of an edge; of its own for each side of an edge that is not smooth.
    std::uint64_t nodeOf(std::uint32_t corner) const {
        const std::uint32_t edge = edgeOfCorner_[corner];
        const bool isSmooth = isSmoothEdge(placed_, placed_.edges->edges[edge]);
        return std::uint64_t{1} << 61
            | (std::uint64_t{placed_.firstTriangle} * 6 + (isSmooth ? edge : mesh_.indices.size() + corner));
    }

    const ViewedScene& scene_;
    const ViewedMesh& placed_;
    const TriMesh& mesh_;
    std::vector<std::uint32_t> edgeOfCorner_;  ///< the edge that begins there
};

}  // namespace

bool isSmoothEdge(const ViewedMesh& placed, const TriangleEdge& edge) {
    if (placed.mesh->normals.empty() || edge.useCount != 2) return false;
    const auto& vertexOf = placed.edges->vertexOf;
    const auto& indices = placed.mesh->indices;
    const auto normalAt = [&](std::uint32_t corner, std::uint32_t vertex) {
        if (vertexOf[indices[corner]] != vertex) corner = corner / 3 * 3 + (corner + 1) % 3;
        return normalOf(*placed.mesh, corner);
    };
    const std::uint32_t one = placed.edges->uses[edge.firstUse], other = placed.edges->uses[edge.firstUse + 1];
    for (const std::uint32_t vertex : {edge.a, edge.b}) {
        const glm::vec3 apart = normalAt(one, vertex) - normalAt(other, vertex);
        if (glm::dot(apart, apart) > kSameNormal * kSameNormal) return false;
    }
    return true;
}

SmoothContours findSmoothContours(const ViewedScene& scene, const ViewedMesh& placed) {
    if (placed.mesh->normals.empty()) return {{}, std::vector<char>(placed.edges->components.size(), false)};
    return Finder(scene, placed).find();
}

}  // namespace limn
