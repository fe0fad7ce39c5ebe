#include "mesh/coincident.h"

#include "scene/bounds.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace limn {
namespace {

/// Cells of planes: so many along a unit of a normal, and along the size of the scene.
constexpr double kNormalCells = 128, kOffsetCells = 4096;
/// Groups up to this size are compared pair by pair.
constexpr std::size_t kFew = 24;
/// A cell of a group's grid, in sides of its triangles.
constexpr double kCellSides = 2.5;
/// Triangles over more cells of a group's grid than this are compared with all of the group.
constexpr int kManyCells = 256;
/// More levels than this are one: a stack of so many sheets has no order that anyone would see.
constexpr int kMostLevels = 12;

struct Corners {
    std::array<glm::dvec3, 3> at;
};

/// A triangle under the cell of its plane.
struct Record {
    std::uint64_t cell = 0;
    std::uint32_t number = 0;  ///< counted over all meshes
    auto operator<=>(const Record&) const = default;
};

/// Two triangles that overlap, by their numbers: first < second.
struct Pair {
    std::uint32_t first = 0, second = 0;
    bool alike = true;  ///< both turn the same side to the camera
    auto operator<=>(const Pair&) const = default;
};

using Found = tbb::enumerable_thread_specific<std::vector<Pair>>;

/// A triangle in the plane of two axes, and the box around it.
struct Flat {
    Flat() = default;
    Flat(const Corners& c, int u, int v) {
        for (std::size_t i = 0; i < 3; ++i) at[i] = {c.at[i][u], c.at[i][v]};
        low = glm::min(at[0], glm::min(at[1], at[2]));
        high = glm::max(at[0], glm::max(at[1], at[2]));
    }
    std::array<glm::dvec2, 3> at;
    glm::dvec2 low{0}, high{0};
};

/// The triangles of one plane.
struct PlaneGrid {
    std::vector<Flat> flats;
    glm::dvec2 low{std::numeric_limits<double>::infinity()};
    double cell = 1;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> grid;  ///< cell and triangle, sorted
    std::vector<std::size_t> starts;                            ///< of each cell in `grid`, and its end
    std::vector<std::uint32_t> large;                           ///< triangles that touch too many cells

    glm::dvec2 place(const glm::dvec2& p) const { return glm::floor((p - low) / cell); }
    static std::uint64_t number(const glm::dvec2& place) {
        return static_cast<std::uint64_t>(place.y) << 32 | static_cast<std::uint64_t>(place.x);
    }
    std::uint64_t cellOf(const glm::dvec2& p) const { return number(place(p)); }
};

class Finder {
public:
    explicit Finder(std::span<const PlacedTriangles> meshes) : meshes_(meshes) {
        Bounds bounds;
        for (const auto& mesh : meshes) {
            first_.push_back(count_);
            count_ += static_cast<std::uint32_t>(mesh.indices.size() / 3);
            Bounds own;
            for (const auto& p : mesh.positions) own.add(glm::dvec3(p));
            if (own.empty()) continue;
            for (int i = 0; i < 8; ++i)
                bounds.add(glm::dvec3(mesh.worldFromMesh
                    * glm::dvec4(
                        i & 1 ? own.hi.x : own.lo.x, i & 2 ? own.hi.y : own.lo.y, i & 4 ? own.hi.z : own.lo.z, 1)));
        }
        centre_ = bounds.empty() ? glm::dvec3(0) : bounds.centre();
        size_ = bounds.diagonal();
        near_ = kCoincidentDistance * size_;
    }

    std::uint32_t meshOf(std::uint32_t number) const {
        return static_cast<std::uint32_t>(std::upper_bound(first_.begin(), first_.end(), number) - first_.begin() - 1);
    }
    std::uint32_t triangleOf(std::uint32_t number) const { return number - first_[meshOf(number)]; }

    /// Every pair once, sorted.
    std::vector<Pair> pairs() const {
        std::vector<Pair> found;
        if (!(size_ > 0) || !std::isfinite(size_)) return found;
        const std::vector<Record> sorted = records();
        std::vector<std::size_t> groups;
        for (std::size_t i = 0; i < sorted.size(); ++i)
            if (i == 0 || sorted[i].cell != sorted[i - 1].cell) groups.push_back(i);
        groups.push_back(sorted.size());
        Found each;
        tbb::parallel_for(std::size_t{0}, groups.size() - 1, [&](std::size_t g) {
            const std::size_t size = groups[g + 1] - groups[g];
            if (size > 1) compareGroup(std::span(sorted).subspan(groups[g], size), each);
        });
        for (const auto& some : each) found.insert(found.end(), some.begin(), some.end());
        tbb::parallel_sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

private:
    /// In the world, from the middle of the scene.
    Corners corners(std::uint32_t number) const {
        const std::uint32_t m = meshOf(number);
        const PlacedTriangles& mesh = meshes_[m];
        const std::size_t first = 3 * std::size_t{number - first_[m]};
        Corners c;
        for (std::size_t i = 0; i < 3; ++i)
            c.at[i] =
                glm::dvec3(mesh.worldFromMesh * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[first + i]]), 1))
                - centre_;
        return c;
    }

    static glm::dvec3 across(const Corners& c) { return glm::cross(c.at[1] - c.at[0], c.at[2] - c.at[0]); }

    /// Calls `put` with each cell that the plane may lie in: more than one where it comes near a cell's border.
    template <class Put>
    void cellsOf(const Corners& c, const Put& put) const {
        const glm::dvec3 n = across(c);
        const double area = glm::length(n);
        const double longest =
            std::max({glm::length(c.at[1] - c.at[0]), glm::length(c.at[2] - c.at[1]), glm::length(c.at[0] - c.at[2])});
        if (!(area > 0) || !std::isfinite(area)) return;
        const glm::dvec4 plane(n / area, glm::dot(n / area, c.at[0]) / size_);
        // A corner off by a rounding turns the plane by that over the triangle's height; most are off by far less than
        // `near_`.
        const double turn = 0.1 * near_ / (area / longest);
        const double reach = glm::length(c.at[0]) / size_;
        std::array<std::array<std::int64_t, 2>, 4> cells;
        std::array<int, 4> counts;
        for (int i = 0; i < 4; ++i) {
            const double scale = i < 3 ? kNormalCells : kOffsetCells;
            const double value = plane[i] * scale;
            const double slack = std::min(0.25, scale * (i < 3 ? turn : kCoincidentDistance + reach * turn));
            const auto k = static_cast<std::size_t>(i);
            cells[k] = {std::llround(value - slack), std::llround(value + slack)};
            counts[k] = cells[k][0] == cells[k][1] ? 1 : 2;
        }
        for (int i = 0; i < 16; ++i) {
            std::array<std::int64_t, 4> at;
            bool isOwn = true;
            for (std::size_t k = 0; k < 4; ++k) {
                const auto which = static_cast<std::size_t>((i >> k) & 1);
                isOwn = isOwn && static_cast<int>(which) < counts[k];
                at[k] = cells[k][which];
            }
            if (isOwn) put(hash(at));
        }
    }

    /// A plane has two normals: the cell is the larger of both, so that it does not matter which way a triangle is
    /// wound.
    static std::uint64_t hash(std::array<std::int64_t, 4> cell) {
        std::array<std::int64_t, 4> turned;
        for (std::size_t k = 0; k < 4; ++k) turned[k] = -cell[k];
        std::uint64_t h = 0x9e3779b97f4a7c15u;
        for (const auto value : std::max(cell, turned)) {
            h = (h ^ static_cast<std::uint64_t>(value)) * 0xbf58476d1ce4e5b9u;
            h ^= h >> 29;
        }
        return h;
    }

    std::vector<Record> records() const {
        tbb::enumerable_thread_specific<std::vector<Record>> each;
        tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, count_, 4096), [&](const auto& range) {
            auto& own = each.local();
            for (std::uint32_t i = range.begin(); i != range.end(); ++i)
                cellsOf(corners(i), [&](std::uint64_t cell) { own.push_back({cell, i}); });
        });
        std::vector<Record> all;
        for (const auto& some : each) all.insert(all.end(), some.begin(), some.end());
        tbb::parallel_sort(all.begin(), all.end());
        return all;
    }

    /// All pairs of a group, by a grid over the directions that its plane spans best.
    void compareGroup(std::span<const Record> group, Found& found) const {
        const PlaneGrid plan = flatten(group);
        const auto compareTwo = [&](std::size_t i, std::size_t j, std::vector<Pair>& own) {
            const Flat &a = plan.flats[i], &b = plan.flats[j];
            if (boxesAreApart(a, b) || isApart(a, b) || isApart(b, a)) return;
            const auto [first, second] = std::minmax(group[i].number, group[j].number);
            const Corners c = corners(first), d = corners(second);
            if (isOn(c, d)) own.push_back({first, second, glm::dot(across(c), across(d)) > 0});
        };
        if (group.size() <= kFew) {
            auto& own = found.local();
            for (std::size_t i = 0; i < group.size(); ++i)
                for (std::size_t j = i + 1; j < group.size(); ++j) compareTwo(i, j, own);
            return;
        }
        const auto compareCell = [&](std::size_t cell, std::vector<Pair>& own) {
            for (std::size_t i = plan.starts[cell]; i < plan.starts[cell + 1]; ++i)
                for (std::size_t j = i + 1; j < plan.starts[cell + 1]; ++j) {
                    const Flat &a = plan.flats[plan.grid[i].second], &b = plan.flats[plan.grid[j].second];
                    if (boxesAreApart(a, b)) continue;
                    // Two that meet in several cells are compared in the one where their boxes begin to overlap.
                    if (plan.cellOf(glm::max(a.low, b.low)) == plan.grid[i].first)
                        compareTwo(plan.grid[i].second, plan.grid[j].second, own);
                }
        };
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, plan.starts.size() - 1, 64), [&](const auto& range) {
            auto& own = found.local();
            for (std::size_t cell = range.begin(); cell != range.end(); ++cell) compareCell(cell, own);
        });
        tbb::parallel_for(std::size_t{0}, plan.large.size(), [&](std::size_t i) {
            const auto upTo = plan.large.begin() + static_cast<std::ptrdiff_t>(i) + 1;
            for (std::uint32_t j = 0; j < group.size(); ++j)
                if (!std::binary_search(plan.large.begin(), upTo, j)) compareTwo(plan.large[i], j, found.local());
        });
    }

    /// A group in its plane, and which triangles touch each cell of a grid. Cells are about as large as a triangle.
    PlaneGrid flatten(std::span<const Record> group) const {
        PlaneGrid plan;
        plan.flats.resize(group.size());
        const glm::dvec3 n = glm::abs(across(corners(group.front().number)));
        const int drop = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, group.size(), 1024), [&](const auto& range) {
            for (std::size_t i = range.begin(); i != range.end(); ++i)
                plan.flats[i] = Flat(corners(group[i].number), (drop + 1) % 3, (drop + 2) % 3);
        });
        if (group.size() <= kFew) return plan;
        double sides = 0;
        for (const Flat& flat : plan.flats) {
            plan.low = glm::min(plan.low, flat.low);
            const glm::dvec2 side = flat.high - flat.low;
            sides += std::min(side.x, side.y) + 1e-3 * std::max(side.x, side.y);
        }
        plan.cell = std::max(kCellSides * sides / static_cast<double>(group.size()), 1e-300);
        for (std::uint32_t i = 0; i < group.size(); ++i) {
            const glm::dvec2 from = plan.place(plan.flats[i].low), to = plan.place(plan.flats[i].high);
            if ((to.x - from.x + 1) * (to.y - from.y + 1) > kManyCells) {
                plan.large.push_back(i);
                continue;
            }
            for (double y = from.y; y <= to.y; ++y)
                for (double x = from.x; x <= to.x; ++x) plan.grid.emplace_back(PlaneGrid::number({x, y}), i);
        }
        tbb::parallel_sort(plan.grid.begin(), plan.grid.end());
        for (std::size_t i = 0; i < plan.grid.size(); ++i)
            if (i == 0 || plan.grid[i].first != plan.grid[i - 1].first) plan.starts.push_back(i);
        plan.starts.push_back(plan.grid.size());
        return plan;
    }

    bool boxesAreApart(const Flat& a, const Flat& b) const {
        return a.high.x <= b.low.x + near_ || b.high.x <= a.low.x + near_ || a.high.y <= b.low.y + near_
            || b.high.y <= a.low.y + near_;
    }

    /// Is all of `b` beyond an edge of `a`, or within rounding of it?
    bool isApart(const Flat& a, const Flat& b) const {
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 from = a.at[i], along = a.at[(i + 1) % 3] - from;
            const auto side = [&](const glm::dvec2& p) { return along.x * (p.y - from.y) - along.y * (p.x - from.x); };
            const double inside = side(a.at[(i + 2) % 3]) < 0 ? -1 : 1;
            const double slack = near_ * (std::abs(along.x) + std::abs(along.y));
            if (inside * side(b.at[0]) <= slack && inside * side(b.at[1]) <= slack && inside * side(b.at[2]) <= slack)
                return true;
        }
        return false;
    }

    /// Does the smaller one lie in the plane of the larger one?
    bool isOn(const Corners& a, const Corners& b) const {
        const glm::dvec3 na = across(a), nb = across(b);
        const bool aIsLarger = glm::dot(na, na) >= glm::dot(nb, nb);
        const glm::dvec3 n = glm::normalize(aIsLarger ? na : nb);
        const Corners& small = aIsLarger ? b : a;
        const glm::dvec3 from = aIsLarger ? a.at[0] : b.at[0];
        return std::all_of(
            small.at.begin(), small.at.end(), [&](const auto& p) { return std::abs(glm::dot(p - from, n)) <= near_; });
    }

    std::span<const PlacedTriangles> meshes_;
    std::vector<std::uint32_t> first_;  ///< the number of each mesh's first triangle
    std::uint32_t count_ = 0;
    glm::dvec3 centre_{0};
    double size_ = 0, near_ = 0;  ///< of the scene; below this two points are one
};

/// What is known of a triangle that overlaps another.
struct Standing {
    int level = 0;
    bool isOpposed = false;  ///< another one turns its back here where this one turns its front
};

}  // namespace

std::vector<CoincidentTriangle> findCoincident(std::span<const PlacedTriangles> meshes) {
    const Finder finder(meshes);
    const std::vector<Pair> pairs = finder.pairs();
    std::map<std::uint32_t, Standing> standings;
    for (const Pair& pair : pairs)
        if (!pair.alike) standings[pair.first].isOpposed = standings[pair.second].isOpposed = true;
    // Earlier triangles come first: their levels are settled when those after them look.
    int highest = 0;
    for (const Pair& pair : pairs) {
        if (!pair.alike) continue;
        const Standing above = standings[pair.first];
        Standing& below = standings[pair.second];
        below.level = std::max(below.level, std::min(above.level + 1, kMostLevels));
        below.isOpposed = below.isOpposed || above.isOpposed;
        highest = std::max(highest, below.level);
    }
    std::vector<CoincidentTriangle> found;
    for (const auto& [number, standing] : standings) {
        const std::uint32_t mesh = finder.meshOf(number), triangle = finder.triangleOf(number);
        if (standing.isOpposed) {
            found.push_back({mesh, triangle, Side::front, standing.level});
            found.push_back({mesh, triangle, Side::back, highest + 1 + standing.level});
        } else if (standing.level > 0) {
            found.push_back({mesh, triangle, Side::both, standing.level});
        }
    }
    std::stable_sort(found.begin(), found.end(),
        [](const auto& a, const auto& b) { return std::tie(a.side, a.level) < std::tie(b.side, b.level); });
    return found;
}

std::size_t countCovered(const PlacedTriangles& mesh) {
    std::vector<std::uint32_t> covered;
    for (const Pair& pair : Finder({&mesh, 1}).pairs()) covered.push_back(pair.second);
    std::sort(covered.begin(), covered.end());
    return static_cast<std::size_t>(std::unique(covered.begin(), covered.end()) - covered.begin());
}

}  // namespace limn
