// Where triangles pass through one another: pairs from a tree of boxes (Embree's rtcCollide), then the segment that
// both triangles share (Möller 1997, "A Fast Triangle-Triangle Intersection Test").

#include "drawing/candidates.h"
#include "mesh/coincident.h"
#include "rays/embree.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
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
    struct Leaf {
        std::uint32_t triangle;  ///< number among all
        std::uint32_t mesh;      ///< index into ViewedScene::meshes()
        std::array<std::uint32_t, 3> vertex;
    };
    std::vector<Leaf> leaves;
    tbb::enumerable_thread_specific<std::vector<Crossing>> found;

    std::array<ViewedVertex, 3> corners(const Leaf& leaf) const {
        return {ViewedVertex{leaf.vertex[0], scene.at(leaf.vertex[0])}, {leaf.vertex[1], scene.at(leaf.vertex[1])},
            {leaf.vertex[2], scene.at(leaf.vertex[2])}};
    }
};

void addLeaves(Tree& tree, bool withHidden) {
    for (std::uint32_t i = 0; i < tree.scene.meshes().size(); ++i) {
        const ViewedMesh& placed = tree.scene.meshes()[i];
        for (std::uint32_t t = 0; t < placed.mesh->triangleCount(); ++t) {
            if (!withHidden && tree.scene.turnsAway(placed, t)) continue;
            const auto corner = tree.scene.corners(placed, t);
            tree.leaves.push_back(
                {placed.firstTriangle + t, i, {corner[0].number, corner[1].number, corner[2].number}});
        }
    }
}

void boundsOf(const RTCBoundsFunctionArguments* args) {
    const auto& tree = *static_cast<const Tree*>(args->geometryUserPtr);
    const auto corner = tree.corners(tree.leaves[args->primID]);
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

bool sharesVertex(const Tree::Leaf& one, const Tree::Leaf& other) {
    for (const std::uint32_t p : one.vertex)
        for (const std::uint32_t q : other.vertex)
            if (p == q) return true;
    return false;
}

bool intersect(const Corners& one, const Corners& other, double touching, std::array<glm::dvec3, 2>& segment) {
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
        if (collisions[i].primID0 >= collisions[i].primID1) continue;
        const Tree::Leaf &one = tree.leaves[collisions[i].primID0], &other = tree.leaves[collisions[i].primID1];
        if (sharesVertex(one, other)) continue;
        Crossing crossing{one.triangle, other.triangle, {}};
        if (intersect(tree.corners(one), tree.corners(other), tree.touching, crossing.segment))
            found.push_back(crossing);
    }
}

/// In the order of triangles.
std::vector<Crossing> crossings(const ViewedScene& scene, bool withHidden) {
    const SceneInfo& info = scene.scene().info;
    Tree tree{scene, kCoincidentDistance * info.diagonal() * info.unit(), {}, {}};
    addLeaves(tree, withHidden);
    if (tree.leaves.size() < 2) return {};
    constexpr TreePurpose kPurpose{"the tree of intersections", "use coarser meshes, or intersections = 0"};
    const EmbreeDevice device = makeEmbreeDevice();
    const EmbreeScene boxes = treeOfBoxes(device.get(), tree.leaves.size(), &tree, boundsOf, nullptr, kPurpose);
    rtcCollide(boxes.get(), boxes.get(), takePairs, &tree);
    checkEmbree(device.get(), kPurpose);
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

void findIntersections(const ViewedScene& scene, bool withHidden, std::vector<Candidate>& found) {
    for (const Crossing& crossing : crossings(scene, withHidden)) {
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
