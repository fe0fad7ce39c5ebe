#include "drawing/occluders.h"

#include "mesh/coincident.h"
#include "rays/embree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace limn {
namespace {

/// Sheets closer than this are one, in parts of the scene's size: what two files, or a file and a rounded transform,
/// say about one plane.
constexpr double kTouching = kCoincidentDistance;
/// The same within a connected mesh, in parts of the line's or the triangle's length, whichever is longer: its floats
/// agree, and a fine mesh folds over itself in steps far below the scene's size.
constexpr double kTouchingInMesh = 1e-6;
/// Boxes in the picture are wider than their triangles by this, in parts of the largest coordinate: the rounding of
/// coordinates to floats, and of the tree's own arithmetic.
constexpr double kBoxSlack = 1e-6;

/// Beyond every levelOf(), and within what Embree takes for a box.
constexpr float kFarthest = 1e18f;

/// What the tree's leaves are.
struct Triangle {
    std::uint32_t number = 0;  ///< among all
    std::uint32_t mesh = 0;    ///< index into ViewedScene::meshes()
    std::array<float, 6> box;  ///< around it in the picture, from its nearest point on, a little larger than it
};

/// An interval of a line's parameter.
struct Interval {
    double from, to;
    bool isEmpty() const { return !(from < to); }
    /// Keeps the part in which a linear function, by its values at both ends, is above 0.
    void keepAbove(double atStart, double atEnd) {
        if (atStart > 0 && atEnd > 0) return;
        if (atStart <= 0 && atEnd <= 0) {
            to = from;
            return;
        }
        const double zero = atStart / (atStart - atEnd);
        if (atStart > 0)
            to = std::min(to, zero);
        else
            from = std::max(from, zero);
    }
};

/// A line as triangles are compared with it.
struct Query {
    const Candidate& line;
    int deepest;    ///< faces before it that matter
    Interval part;  ///< in the picture
    double length;  ///< in space
    std::array<glm::dvec3, 2> end;
    std::vector<std::pair<double, int>> steps;  ///< where the number of faces before it changes, and by how much
    std::vector<Interval> continued;            ///< where a border is none
    double shift = 0;  ///< of a border: on which side in the picture its own triangle is seen, −1 or 1
    glm::dvec3 faceNormal{0};
};

/// A box in the picture, and in what grows with depth and is linear along lines there.
struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    void add(const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

struct Context : RTCIntersectContext {
    const void* tree;
    Query* query;
};

}  // namespace

struct Occluders::Tree {
    const ViewedScene& scene;
    glm::dvec2 low, high;   ///< the picture and its margin, in pixels
    glm::dvec2 middle;      ///< subtracted from places, to keep floats small
    double size;            ///< of the scene, normalized units
    double nearest = 1;     ///< depth of what is nearest to the eye
    double levelSlack = 0;  ///< the rounding of levelOf() to floats
    std::vector<Triangle> triangles;
    EmbreeDevice device;
    EmbreeScene boxes;

    Tree(const ViewedScene& scene_, glm::ivec2 imageSize, double margin)
        : scene(scene_),
          low(-margin),
          high(glm::dvec2(imageSize) + margin),
          middle(0.5 * glm::dvec2(imageSize)),
          size(scene_.scene().info.diagonal() * scene_.scene().info.unit()) {
        measureDepths();
        findSeen();
        build();
    }
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;

    /// Depth as the tree knows it: it grows with depth, and is linear along lines in the picture.
    double levelOf(double depth) const { return scene.projector().isParallel ? depth - nearest : -nearest / depth; }
    glm::dvec3 placeOf(const glm::dvec3& p) const { return {scene.projector().place(p), levelOf(-p.z)}; }

    /// The box around a triangle in the picture, from its nearest point on; nullopt where it is not seen.
    std::optional<Box> boxOf(const ViewedMesh& placed, std::uint32_t triangleOfMesh) const {
        const auto corner = scene.corners(placed, triangleOfMesh);
        const Projector& projector = scene.projector();
        Box box;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 &p = corner[i].at, &q = corner[(i + 1) % 3].at;
            const bool isSeen = -p.z > projector.nearest, isNextSeen = -q.z > projector.nearest;
            if (isSeen) box.add(placeOf(p));
            if (isSeen != isNextSeen)  // from the nearest plane on
                box.add(placeOf(p + (q - p) * ((-projector.nearest - p.z) / (q.z - p.z))));
        }
        if (!(box.low.x <= high.x && box.low.y <= high.y && box.high.x >= low.x && box.high.y >= low.y))
            return std::nullopt;
        box.low = glm::max(box.low, glm::dvec3(low, box.low.z));
        box.high = glm::min(box.high, glm::dvec3(high, box.high.z));
        return box;
    }

    /// The triangles in the picture, in their order.
    void findSeen() {
        const double slack = kBoxSlack * std::max(glm::length(high), 1.0);
        constexpr std::size_t kPart = 8192;
        for (std::uint32_t i = 0; i < scene.meshes().size(); ++i) {
            const ViewedMesh& placed = scene.meshes()[i];
            const std::size_t count = placed.mesh->triangleCount();
            std::vector<std::vector<Triangle>> parts((count + kPart - 1) / kPart);
            tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
                for (std::size_t t = part * kPart; t < std::min(count, (part + 1) * kPart); ++t) {
                    const auto box = boxOf(placed, static_cast<std::uint32_t>(t));
                    if (!box) continue;
                    const glm::vec3 least(box->low - glm::dvec3(middle + slack, levelSlack)),
                        most(box->high + glm::dvec3(slack - middle, 0));
                    // What lies behind the triangle may be hidden by it, however far.
                    parts[part].push_back({placed.firstTriangle + static_cast<std::uint32_t>(t), i,
                        {least.x, least.y, least.z, most.x, most.y, kFarthest}});
                }
            });
            for (const auto& part : parts) triangles.insert(triangles.end(), part.begin(), part.end());
        }
    }

    void measureDepths() {
        Bounds depths;
        for (std::uint32_t v = 0; v < scene.vertexCount(); ++v) depths.add(glm::dvec3(-scene.at(v).z));
        nearest = scene.projector().isParallel ? depths.lo.z : std::max(depths.lo.z, scene.projector().nearest);
        levelSlack = kBoxSlack * (scene.projector().isParallel ? std::max(size, 1.0) : 1);
    }

    void build();
    Interval partInPicture(const Candidate& line) const;
    /// True where nothing else needs to be compared.
    bool compare(Query& query, const Triangle& triangle) const;
    double touchingOf(const Query& query, const ViewedMesh& placed, const std::array<ViewedVertex, 3>& corner,
        std::size_t end, bool sharesVertex) const;
    void keepBeforeNearest(Interval& hidden, const Query& query, const std::array<ViewedVertex, 3>& corner,
        const glm::dvec3& normal, const std::array<double, 2>& height) const;
    void hideBeyondHoles(Query& query, const Interval& hidden, const ViewedMesh& placed, std::uint32_t triangleOfMesh,
        const Mask& mask, const std::array<std::array<double, 2>, 3>& sides) const;
    void findContinued(Query& query, const std::array<ViewedVertex, 3>& corner, const glm::dvec3& normal, double sign,
        const std::array<double, 2>& height) const;
};

namespace {

void boundsOfTriangle(const RTCBoundsFunctionArguments* args) {
    const auto& tree = *static_cast<const Occluders::Tree*>(args->geometryUserPtr);
    const auto& box = tree.triangles[args->primID].box;
    *args->bounds_o = {box[0], box[1], box[2], 0, box[3], box[4], box[5], 0};
}

void meetTriangle(const RTCOccludedFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto& context = *static_cast<const Context*>(args->context);
    const auto& tree = *static_cast<const Occluders::Tree*>(context.tree);
    if (tree.compare(*context.query, tree.triangles[args->primID]))
        RTCRayN_tfar(args->ray, args->N, 0) = -std::numeric_limits<float>::infinity();
}

}  // namespace

void Occluders::Tree::build() {
    device = makeEmbreeDevice();
    boxes = treeOfBoxes(device.get(), triangles.size(), this, boundsOfTriangle, meetTriangle,
        {"the tree of what hides lines",
            "use coarser meshes, or lines that are found in the picture: technique = \"depth_normal\""});
}

/// The part of a line before the eye and within the picture's margin.
Interval Occluders::Tree::partInPicture(const Candidate& line) const {
    const Projector& projector = scene.projector();
    Interval part{0, 1};
    const auto keep = [&](const auto& function) {
        part.keepAbove(function(line.end[0] + line.lift[0]), function(line.end[1] + line.lift[1]));
    };
    keep([&](const glm::dvec3& p) { return -p.z - projector.nearest; });
    for (int axis = 0; axis < 2; ++axis) {
        const double from = projector.rayOffset[axis] + projector.rayScale[axis] * low[axis],
                     to = projector.rayOffset[axis] + projector.rayScale[axis] * high[axis];
        const auto depth = [&](const glm::dvec3& p) { return projector.isParallel ? 1 : -p.z; };
        keep([&](const glm::dvec3& p) { return p[axis] - from * depth(p); });
        keep([&](const glm::dvec3& p) { return to * depth(p) - p[axis]; });
    }
    return part;
}

/// How far a triangle's plane may lie before the line without hiding it, at one end.
double Occluders::Tree::touchingOf(const Query& query, const ViewedMesh& placed,
    const std::array<ViewedVertex, 3>& corner, std::size_t end, bool sharesVertex) const {
    for (const auto& one : corner)
        if (one.number == query.line.vertex[end]) return 0;
    const std::uint32_t component =
        placed.firstComponent + placed.edges->componentOf[corner[0].number - placed.firstVertex];
    if (component != query.line.component && !sharesVertex) return kTouching * size;
    double longest = query.length;
    for (std::size_t i = 0; i < 3 && !sharesVertex; ++i)
        longest = std::max(longest, glm::distance(corner[i].at, corner[(i + 1) % 3].at));
    return kTouchingInMesh * longest;
}

/// The function of three points that is above 0 where `x` is seen on the inner side of the edge from p to q. Both
/// triangles on an edge compute the same number, but for its sign.
static double innerSide(const Projector& projector, const ViewedVertex& p, const ViewedVertex& q, const glm::dvec3& x) {
    return p.number < q.number ? projector.side(p.at, q.at, x) : -projector.side(q.at, p.at, x);
}

bool Occluders::Tree::compare(Query& query, const Triangle& triangle) const {
    const std::uint32_t number = triangle.number;
    const Candidate& line = query.line;
    if (number == line.within[0] || number == line.within[1]) return false;
    const ViewedMesh& placed = scene.meshes()[triangle.mesh];
    const auto corner = scene.corners(placed, number - placed.firstTriangle);
    const Projector& projector = scene.projector();
    std::array<bool, 2> isAtCorner{false, false};
    for (std::size_t e = 0; e < 2; ++e)
        for (const auto& one : corner) isAtCorner[e] = isAtCorner[e] || one.number == line.vertex[e];
    if (isAtCorner[0] && isAtCorner[1]) return false;  // on the line's own edge
    // Its plane, upward to the eye.
    glm::dvec3 normal = glm::cross(corner[1].at - corner[0].at, corner[2].at - corner[0].at);
    const double area = glm::length(normal);
    if (!(area > 0)) return false;
    normal /= area;
    const double facing = projector.facing(normal, corner[0].at);
    if (facing == 0) return false;
    const double sign = facing > 0 ? 1 : -1;
    normal *= sign;
    std::array<double, 2> height, below;
    for (std::size_t e = 0; e < 2; ++e) {
        height[e] = isAtCorner[e] ? 0 : glm::dot(normal, query.end[e] - corner[0].at);
        below[e] = -height[e] - touchingOf(query, placed, corner, e, isAtCorner[0] || isAtCorner[1]);
    }
    if (line.face != kNoVertex && number != line.face) findContinued(query, corner, normal, sign, height);
    Interval hidden{0, 1};
    hidden.keepAbove(below[0], below[1]);
    std::array<std::array<double, 2>, 3> sides;
    for (std::size_t i = 0; i < 3 && !hidden.isEmpty(); ++i) {
        const ViewedVertex &p = corner[i], &q = corner[(i + 1) % 3];
        std::array<double, 2>& inside = sides[i];
        for (std::size_t e = 0; e < 2; ++e) {
            const bool isOnEdge =
                line.vertex[e] != kNoVertex && (line.vertex[e] == p.number || line.vertex[e] == q.number);
            inside[e] = isOnEdge ? 0 : sign * innerSide(projector, p, q, query.end[e]);
        }
        hidden.keepAbove(inside[0], inside[1]);
    }
    keepBeforeNearest(hidden, query, corner, normal, height);
    if (hidden.isEmpty()) return false;
    if (const Mask* mask = scene.maskOf(placed, number - placed.firstTriangle)) {
        hideBeyondHoles(query, hidden, placed, number - placed.firstTriangle, *mask, sides);
        return false;
    }
    query.steps.emplace_back(hidden.from, 1);
    query.steps.emplace_back(hidden.to, -1);
    return query.deepest == 0 && hidden.from <= query.part.from && hidden.to >= query.part.to;
}

/// Of a triangle that reaches nearer than the nearest plane, the part beyond it hides.
void Occluders::Tree::keepBeforeNearest(Interval& hidden, const Query& query, const std::array<ViewedVertex, 3>& corner,
    const glm::dvec3& normal, const std::array<double, 2>& height) const {
    const Projector& projector = scene.projector();
    if (std::none_of(corner.begin(), corner.end(), [&](const auto& one) { return -one.at.z <= projector.nearest; }))
        return;
    // The depth of the triangle before a point of the line, times what makes it linear along the line.
    const auto beyond = [&](std::size_t end) {
        const glm::dvec3& p = query.end[end];
        if (projector.isParallel) return -p.z + height[end] / normal.z - projector.nearest;
        return -p.z - projector.nearest * glm::dot(normal, p) / glm::dot(normal, corner[0].at);
    };
    hidden.keepAbove(beyond(0), beyond(1));
}

/// Hides what a triangle with holes hides: looks at the mask every half pixel, and halves in on where alpha is one
/// half.
void Occluders::Tree::hideBeyondHoles(Query& query, const Interval& hidden, const ViewedMesh& placed,
    std::uint32_t triangleOfMesh, const Mask& mask, const std::array<std::array<double, 2>, 3>& sides) const {
    const TriMesh& mesh = *placed.mesh;
    std::array<glm::dvec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& indices = mesh.uvIndices.empty() ? mesh.indices : mesh.uvIndices;
        uv[k] = glm::dvec2(mesh.uvs[indices[std::size_t{3} * triangleOfMesh + k]] * mask.scale + mask.offset);
    }
    const auto isSolid = [&](double t) {
        // The side opposite to a corner is its barycentric coordinate, but for a factor.
        std::array<double, 3> weight;
        for (std::size_t k = 0; k < 3; ++k)
            weight[k] = std::max(0.0, glm::mix(sides[(k + 1) % 3][0], sides[(k + 1) % 3][1], t));
        const double sum = weight[0] + weight[1] + weight[2];
        if (!(sum > 0)) return true;
        return alphaAt(mask, glm::vec2((uv[0] * weight[0] + uv[1] * weight[1] + uv[2] * weight[2]) / sum)) >= 0.5f;
    };
    const auto placeAt = [&](double t) { return scene.projector().place(glm::mix(query.end[0], query.end[1], t)); };
    const double from = std::max(hidden.from, query.part.from), to = std::min(hidden.to, query.part.to);
    if (!(from < to)) return;
    const int count = std::clamp(static_cast<int>(2 * glm::distance(placeAt(from), placeAt(to))) + 2, 2, 1 << 16);
    double begin = from, last = from;
    bool wasSolid = isSolid(from);
    const auto hide = [&](double until) {
        query.steps.emplace_back(begin, 1);
        query.steps.emplace_back(until, -1);
    };
    for (int i = 1; i <= count; ++i) {
        const double t = i == count ? to : from + (to - from) * i / count;
        const bool is = isSolid(t);
        if (is != wasSolid) {
            double unchanged = last, changed = t;
            for (int k = 0; k < 12; ++k) {
                const double halfway = 0.5 * (unchanged + changed);
                (isSolid(halfway) == is ? changed : unchanged) = halfway;
            }
            if (wasSolid) hide(changed);
            begin = changed;
            wasSolid = is;
        }
        last = t;
    }
    if (wasSolid) hide(to);
}

/// A border is none where another surface goes on in its triangle's plane: walls of many pieces, whose vertices do not
/// meet, have no lines between them.
void Occluders::Tree::findContinued(Query& query, const std::array<ViewedVertex, 3>& corner, const glm::dvec3& normal,
    double sign, const std::array<double, 2>& height) const {
    if (std::abs(height[0]) > kTouching * size || std::abs(height[1]) > kTouching * size) return;
    if (std::abs(glm::dot(normal, query.faceNormal)) < 1 - 1e-6) return;
    // The line, moved away from its own triangle by little.
    const glm::dvec3 along = (query.end[1] - query.end[0]) / query.length;
    const glm::dvec3 beside = glm::cross(query.faceNormal, along) * (query.shift * 2 * kTouching * size);
    Interval part{0, 1};
    for (std::size_t i = 0; i < 3; ++i)
        part.keepAbove(sign * innerSide(scene.projector(), corner[i], corner[(i + 1) % 3], query.end[0] + beside),
            sign * innerSide(scene.projector(), corner[i], corner[(i + 1) % 3], query.end[1] + beside));
    if (!part.isEmpty()) query.continued.push_back(part);
}

Occluders::Occluders(const ViewedScene& scene, glm::ivec2 imageSize, double margin)
    : tree_(std::make_unique<Tree>(scene, imageSize, margin)) {}
Occluders::~Occluders() = default;

/// The parts between the steps, of equal numbers joined.
static std::vector<LinePart> partsBetween(Interval within, std::vector<std::pair<double, int>>& steps, int deepest) {
    // At the same place a face begins before another ends: they meet there.
    std::sort(steps.begin(), steps.end(),
        [](const auto& a, const auto& b) { return a.first != b.first ? a.first < b.first : a.second > b.second; });
    std::vector<LinePart> parts;
    double from = within.from;
    int behind = 0;
    const auto close = [&](double to) {
        if (to <= from) return;
        const int known = std::min(behind, deepest + 1);
        if (!parts.empty() && parts.back().behind == known && parts.back().to == from)
            parts.back().to = to;
        else
            parts.push_back({from, to, known});
        from = to;
    };
    for (const auto& [at, step] : steps) {
        close(std::clamp(at, within.from, within.to));
        behind += step;
    }
    close(within.to);
    return parts;
}

/// Removes the parts of a border that are none.
static std::vector<LinePart> without(const std::vector<LinePart>& parts, std::vector<Interval>& removed) {
    std::sort(removed.begin(), removed.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
    std::vector<LinePart> kept;
    for (const auto& part : parts) {
        double from = part.from;
        for (const auto& gap : removed) {
            if (gap.from > from && from < part.to) kept.push_back({from, std::min(gap.from, part.to), part.behind});
            from = std::max(from, gap.to);
        }
        if (from < part.to) kept.push_back({from, part.to, part.behind});
    }
    return kept;
}

std::vector<LinePart> Occluders::partsOf(const Candidate& line, int deepest) const {
    const Tree& tree = *tree_;
    const Interval part = tree.partInPicture(line);
    if (part.isEmpty()) return {};
    Query query{line, deepest, part, glm::length(line.end[1] - line.end[0]),
        {line.end[0] + line.lift[0], line.end[1] + line.lift[1]}, {}, {}, 0, {}};
    if (!(query.length > 0)) return {};
    if (line.face != kNoVertex) {
        const ViewedMesh& placed = tree.scene.meshOf(line.face);
        const auto corner = tree.scene.corners(placed, line.face - placed.firstTriangle);
        query.faceNormal = glm::normalize(glm::cross(corner[1].at - corner[0].at, corner[2].at - corner[0].at));
        const glm::dvec3 beside = glm::cross(query.faceNormal, line.end[1] - line.end[0]);
        glm::dvec3 third{0};
        for (const auto& one : corner)
            if (one.number != line.vertex[0] && one.number != line.vertex[1]) third = one.at;
        query.shift = glm::dot(beside, third - line.end[0]) > 0 ? -1 : 1;
    }
    const auto placeAt = [&](double t) {
        return tree.placeOf(glm::mix(query.end[0], query.end[1], t)) - glm::dvec3(tree.middle, 0);
    };
    const glm::dvec3 from = placeAt(part.from), way = placeAt(part.to) - from;
    if (glm::dvec2(way) == glm::dvec2(0)) return {};
    Context context;
    rtcInitIntersectContext(&context);
    context.tree = tree_.get();
    context.query = &query;
    RTCRay ray{};
    ray.org_x = static_cast<float>(from.x);
    ray.org_y = static_cast<float>(from.y);
    ray.org_z = static_cast<float>(from.z);
    ray.dir_z = static_cast<float>(way.z);
    ray.dir_x = static_cast<float>(way.x);
    ray.dir_y = static_cast<float>(way.y);
    ray.tfar = 1;
    ray.mask = ~0u;
    rtcOccluded1(tree.boxes.get(), &context, &ray);
    std::vector<LinePart> parts = partsBetween(part, query.steps, deepest);
    return query.continued.empty() ? parts : without(parts, query.continued);
}

}  // namespace limn
