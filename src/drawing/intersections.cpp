// Where triangles pass through one another: pairs from a tree of boxes (Embree's rtcCollide), then the segment that
// both triangles share (Möller 1997, "A Fast Triangle-Triangle Intersection Test").

#include "base/error.h"
#include "drawing/candidates.h"
#include "mesh/coincident.h"

#include <embree3/rtcore.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace limn {
namespace {

/// Two triangles and what they share.
struct Crossing {
    std::uint32_t first, second;
    std::array<glm::dvec3, 2> segment;
};

struct Tree {
    const ViewedScene& scene;
    double touching;  ///< triangles come this close without passing through one another
    tbb::enumerable_thread_specific<std::vector<Crossing>> found;
};

void boundsOf(const RTCBoundsFunctionArguments* args) {
    const auto& tree = *static_cast<const Tree*>(args->geometryUserPtr);
    const ViewedMesh& placed = tree.scene.meshOf(args->primID);
    const auto corner = tree.scene.corners(placed, args->primID - placed.firstTriangle);
    const glm::dvec3 low = glm::min(corner[0].at, glm::min(corner[1].at, corner[2].at)),
                     high = glm::max(corner[0].at, glm::max(corner[1].at, corner[2].at));
    // One float farther out each way.
    const auto down = [](double x) { return std::nextafter(static_cast<float>(x), -1e30f); };
    const auto up = [](double x) { return std::nextafter(static_cast<float>(x), 1e30f); };
    *args->bounds_o = {down(low.x), down(low.y), down(low.z), 0, up(high.x), up(high.y), up(high.z), 0};
}

using Corners = std::array<ViewedVertex, 3>;

struct Plane {
    explicit Plane(const Corners& corner) : origin(corner[0].at) {
        normal = glm::cross(corner[1].at - origin, corner[2].at - origin);
        const double length = glm::length(normal);
        normal = length > 0 ? normal / length : glm::dvec3(0);
    }
    glm::dvec3 origin, normal;
    double height(const glm::dvec3& p) const { return glm::dot(normal, p - origin); }
};

/// The two points in which a triangle's sides meet a plane; false where the triangle only touches it.
bool cut(const Corners& corner, const Plane& plane, double touching, std::array<glm::dvec3, 2>& points) {
    std::array<double, 3> height;
    for (std::size_t i = 0; i < 3; ++i) {
        height[i] = plane.height(corner[i].at);
        if (std::abs(height[i]) <= touching) height[i] = 0;
    }
    if (std::max({height[0], height[1], height[2]}) <= 0 || std::min({height[0], height[1], height[2]}) >= 0)
        return false;
    std::size_t found = 0;
    for (std::size_t i = 0; i < 3 && found < 2; ++i) {
        std::size_t a = i, b = (i + 1) % 3;
        if (height[a] == 0) points[found++] = corner[a].at;
        if (height[a] * height[b] >= 0 || found == 2) continue;
        // In the order of vertices: the neighbour on this side finds the same point to the bit.
        if (corner[a].number > corner[b].number) std::swap(a, b);
        points[found++] = corner[a].at + (corner[b].at - corner[a].at) * (height[a] / (height[a] - height[b]));
    }
    return found == 2;
}

bool intersect(const Corners& one, const Corners& other, double touching, std::array<glm::dvec3, 2>& segment) {
    for (const auto& p : one)
        for (const auto& q : other)
            if (p.number == q.number) return false;
    const Plane first(one), second(other);
    std::array<glm::dvec3, 2> a, b;
    if (!cut(one, second, touching, a) || !cut(other, first, touching, b)) return false;
    const glm::dvec3 along = glm::cross(first.normal, second.normal);
    const auto sort = [&](std::array<glm::dvec3, 2>& ends) {
        if (glm::dot(ends[0], along) > glm::dot(ends[1], along)) std::swap(ends[0], ends[1]);
    };
    sort(a);
    sort(b);
    segment = {glm::dot(a[0], along) >= glm::dot(b[0], along) ? a[0] : b[0],
        glm::dot(a[1], along) <= glm::dot(b[1], along) ? a[1] : b[1]};
    return glm::dot(segment[1] - segment[0], along) > 0;
}

void takePairs(void* user, RTCCollision* collisions, unsigned count) {
    auto& tree = *static_cast<Tree*>(user);
    auto& found = tree.found.local();
    for (unsigned i = 0; i < count; ++i) {
        const std::uint32_t first = collisions[i].primID0, second = collisions[i].primID1;
        if (first >= second) continue;
        const ViewedMesh &one = tree.scene.meshOf(first), &other = tree.scene.meshOf(second);
        Crossing crossing{first, second, {}};
        if (intersect(tree.scene.corners(one, first - one.firstTriangle),
                tree.scene.corners(other, second - other.firstTriangle), tree.touching, crossing.segment))
            found.push_back(crossing);
    }
}

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

/// In the order of triangles.
std::vector<Crossing> crossings(const ViewedScene& scene) {
    const SceneInfo& info = scene.scene().info;
    Tree tree{scene, kCoincidentDistance * info.diagonal() * info.unit(), {}};
    const std::unique_ptr<RTCDeviceTy, ReleaseDevice> device(rtcNewDevice(nullptr));
    const std::unique_ptr<RTCSceneTy, ReleaseScene> boxes(rtcNewScene(device.get()));
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(scene.triangleCount()));
    rtcSetGeometryUserData(geometry, &tree);
    rtcSetGeometryBoundsFunction(geometry, boundsOf, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(boxes.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(boxes.get());
    rtcCollide(boxes.get(), boxes.get(), takePairs, &tree);
    if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE)
        throw Error(ExitCode::outOfMemory, {}, "there is not enough memory for the tree of intersections",
            "use coarser meshes, or intersections = 0");
    std::vector<Crossing> all;
    for (const auto& part : tree.found) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) {
        return std::pair(a.first, a.second) < std::pair(b.first, b.second);
    });
    const auto isSame = [](const Crossing& a, const Crossing& b) { return a.first == b.first && a.second == b.second; };
    all.erase(std::unique(all.begin(), all.end(), isSame), all.end());
    return all;
}

}  // namespace

void findIntersections(const ViewedScene& scene, std::vector<Candidate>& found) {
    if (scene.triangleCount() < 2) return;
    for (const Crossing& crossing : crossings(scene)) {
        const ViewedMesh& placed = scene.meshOf(crossing.first);
        Candidate made;
        made.end = crossing.segment;
        made.source = MeshLineSource::intersections;
        made.node = {nodeAt(made.end[0]), nodeAt(made.end[1])};
        made.within = {crossing.first, crossing.second};
        describe(made, scene, placed, crossing.first - placed.firstTriangle);
        if (scene.scene().lineRecords[made.record].draws) found.push_back(made);
    }
}

}  // namespace limn
