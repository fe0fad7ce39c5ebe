#include "gpu/culling.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {
namespace {

constexpr float kGridStep = 1.0f / 256;  // vertices are snapped to this, in fine pixels
constexpr float kRounding =
    1.0f / (1 << 20);  // sixteen half ulps of float: a dozen sums and products, here and on the GPU

/// Four numbers in one register, since culling runs for every triangle of a scene.
using Four = float __attribute__((vector_size(16)));

Four four(float v) { return Four{v, v, v, v}; }
Four least(Four a, Four b) { return a < b ? a : b; }
Four most(Four a, Four b) { return a > b ? a : b; }

struct Transform {
    std::array<Four, 4> columns;

    explicit Transform(const glm::mat4& m) {
        for (int c = 0; c < 4; ++c) columns[static_cast<std::size_t>(c)] = Four{m[c].x, m[c].y, m[c].z, m[c].w};
    }
    Four operator()(const glm::vec3& p) const {
        return columns[0] * four(p.x) + columns[1] * four(p.y) + columns[2] * four(p.z) + columns[3];
    }
};

/// The box around a cluster or a triangle: x and y in fine pixels of the canvas, z as in the depth buffer.
struct Box {
    Four low, high;
};

/// The bounds of a cluster.
struct ClusterBounds {
    Box box;
    float room = 0;             // error bound of a vertex's computed place, in fine pixels
    float depthRoom = 0;        // the same for its depth: relative, or absolute where orthographic
    bool isEverywhere = false;  // the cluster reaches behind the eye, or lies too near to it for floats
};

ClusterBounds boundsOf(
    const CullView& view, const PlacedMesh& mesh, const Transform& pixelFromMesh, const Cluster& cluster) {
    ClusterBounds result;
    const Four centre = pixelFromMesh(cluster.centre);
    Four leastW = centre;
    for (int corner = 0; corner < 8; ++corner) {
        Four p = centre;
        for (int axis = 0; axis < 3; ++axis)
            p += pixelFromMesh.columns[static_cast<std::size_t>(axis)]
                * four((corner >> axis & 1) != 0 ? cluster.half[axis] : -cluster.half[axis]);
        leastW = least(leastW, p);
        const Four at = p / four(p[3]);
        result.box = corner == 0 ? Box{at, at} : Box{least(result.box.low, at), most(result.box.high, at)};
    }
    const glm::vec4 terms = mesh.terms * glm::vec4(glm::abs(cluster.centre) + cluster.half, 1);
    const float ofW = terms.w / leastW[3];  // relative error of w, the divisor of all, in roundings
    result.room = kGridStep + kRounding * (std::max(terms.x, terms.y) / leastW[3]) * ofW;
    result.depthRoom =
        view.orthographic ? 1e-5f + kRounding * terms.z : 1e-4f + kRounding * ofW;  // constants cover interpolation
    result.isEverywhere = !(leastW[3] > 1e-4f * terms.w) || !(result.room < 1e4f);
    return result;
}

bool isOutside(const CullView& view, const ClusterBounds& bounds) {
    const Box& box = bounds.box;
    return !bounds.isEverywhere
        && (box.high[0] + bounds.room < view.regionLow.x || box.high[1] + bounds.room < view.regionLow.y
            || box.low[0] - bounds.room > view.regionHigh.x || box.low[1] - bounds.room > view.regionHigh.y);
}

/// Is everything drawn so far within the box nearer?
bool isHidden(const CullView& view, const Box& box, const ClusterBounds& bounds, const FarthestDepths& farthest) {
    const float nearest = view.orthographic ? box.high[2] + bounds.depthRoom : box.high[2] * (1 + bounds.depthRoom),
                room = bounds.room;
    const auto squareOf = [&](float place, int axis) {
        return std::clamp(
            static_cast<int>(std::clamp(place, view.regionLow[axis], view.regionHigh[axis])) / farthest.side, 0,
            farthest.size[axis] - 1);
    };
    const int left = squareOf(box.low[0] - room, 0), right = squareOf(box.high[0] + room, 0),
              bottom = squareOf(box.low[1] - room, 1), top = squareOf(box.high[1] + room, 1);
    for (int y = bottom; y <= top; ++y)
        for (int x = left; x <= right; ++x)
            if (!(farthest.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(farthest.size.x)
                      + static_cast<std::size_t>(x)]
                    > nearest))
                return false;
    return true;
}

/// May a triangle cover the middle of a pixel? `at`: its corners, each right to `room`. `box`: the box around it.
bool mayCoverMiddle(const std::array<Four, 3>& at, const Box& box, float room) {
    // Finds the pixels' middles in the box. Truncation rounds positive numbers down. Places beyond 65536 may as well
    // lie there.
    static constexpr double kFar = 65536;
    const auto down = [](float v) { return static_cast<int>(std::clamp(static_cast<double>(v), -kFar, kFar) + kFar); };
    const int left = down(box.low[0] - room + 0.5f), right = down(box.high[0] + room - 0.5f),
              bottom = down(box.low[1] - room + 0.5f), top = down(box.high[1] + room - 0.5f);
    if (left > right || bottom > top) return false;
    if (right - left > 1 || top - bottom > 1) return true;  // large triangles are seldom worth a closer look
    const Four a = at[1] - at[0], b = at[2] - at[0];
    const float side = a[0] * b[1] - a[1] * b[0] < 0 ? -1.0f : 1.0f;
    for (int row = bottom; row <= top; ++row)
        for (int column = left; column <= right; ++column) {
            const Four middle{static_cast<float>(column - kFar + 0.5), static_cast<float>(row - kFar + 0.5), 0, 0};
            bool isInside = true;
            for (std::size_t i = 0; i < 3; ++i) {
                const Four edge = at[i == 2 ? 0 : i + 1] - at[i], to = middle - at[i];
                // Both ends may move by `room` each way.
                isInside = isInside
                    && side * (edge[0] * to[1] - edge[1] * to[0]) >= -2 * room
                            * (std::abs(edge[0]) + std::abs(edge[1]) + std::abs(to[0]) + std::abs(to[1]) + 2 * room);
            }
            if (isInside) return true;
        }
    return false;
}

/// Appends the triangles of a cluster that are to be drawn: those that face the camera, or with `farthest` the others.
/// Returns whether there are triangles of the other kind.
bool chooseOf(const CullView& view, const PlacedMesh& mesh, const Transform& pixelFromMesh, const Cluster& cluster,
    const ClusterBounds& bounds, const TriangleSource& source, const FarthestDepths* farthest,
    std::vector<std::uint32_t>& chosen) {
    const std::uint32_t* corners = source.indices + mesh.firstIndex + 3 * std::size_t{cluster.firstTriangle};
    const glm::vec3* positions = source.positions + mesh.firstPosition;
    bool others = false;
    for (std::uint32_t t = 0; t < cluster.triangleCount; ++t, corners += 3) {
        const glm::vec3 &p0 = positions[corners[0]], &p1 = positions[corners[1]], &p2 = positions[corners[2]];
        // The visible side decides when a triangle is drawn, not whether.
        const bool faces = glm::dot(glm::cross(p1 - p0, p2 - p0), view.orthographic ? mesh.eye : mesh.eye - p0) >= 0;
        if (faces == (farthest != nullptr)) {
            others = true;
            continue;
        }
        if (!bounds.isEverywhere) {
            std::array<Four, 3> at{pixelFromMesh(p0), pixelFromMesh(p1), pixelFromMesh(p2)};
            for (Four& p : at) p /= four(p[3]);
            const Box box{least(least(at[0], at[1]), at[2]), most(most(at[0], at[1]), at[2])};
            if (!mayCoverMiddle(at, box, bounds.room)) continue;
            if (farthest && isHidden(view, box, bounds, *farthest)) continue;
        }
        chosen.insert(chosen.end(), corners, corners + 3);
    }
    return others;
}

}  // namespace

std::vector<SeenPart> partsOf(const CullView& view) {
    constexpr std::size_t kClusters = 64;  // some thousand triangles in a part
    std::vector<SeenPart> parts;
    for (std::size_t i = 0; i < view.instances.size(); ++i)
        for (std::size_t first = 0; first < view.instances[i].clusters.size(); first += kClusters)
            parts.push_back({i, first, std::min(kClusters, view.instances[i].clusters.size() - first), {}, {}});
    return parts;
}

void chooseFacing(const CullView& view, const TriangleSource& source, SeenPart& part) {
    const auto& mesh = view.instances[part.instance];
    const Transform pixelFromMesh(mesh.pixelFromMesh);
    for (std::size_t c = part.firstCluster; c < part.firstCluster + part.clusterCount; ++c) {
        const ClusterBounds bounds = boundsOf(view, mesh, pixelFromMesh, mesh.clusters[c]);
        if (isOutside(view, bounds)) continue;
        if (chooseOf(view, mesh, pixelFromMesh, mesh.clusters[c], bounds, source, nullptr, part.indices))
            part.withBacks.push_back(static_cast<std::uint32_t>(c));
    }
}

void chooseBacks(const CullView& view, const TriangleSource& source, const FarthestDepths& farthest, SeenPart& part) {
    const auto& mesh = view.instances[part.instance];
    const Transform pixelFromMesh(mesh.pixelFromMesh);
    for (const auto c : part.withBacks) {
        const ClusterBounds bounds = boundsOf(view, mesh, pixelFromMesh, mesh.clusters[c]);
        if (!bounds.isEverywhere && isHidden(view, bounds.box, bounds, farthest)) continue;
        chooseOf(view, mesh, pixelFromMesh, mesh.clusters[c], bounds, source, &farthest, part.indices);
    }
}

}  // namespace limn
