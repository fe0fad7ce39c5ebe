// No line twice: pieces that lie on others in the picture are cut away.

#include "drawing/chains.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace limn {
namespace {

/// Lines closer than this all along are one, in pixels: far below what any picture or plotter shows.
constexpr double kSame = 0.02;
/// Shorter pieces are left alone: they are parts of curves.
constexpr double kShortest = 1;
/// Side of the cells in which pieces are compared, in pixels.
constexpr double kCell = 8;

/// A part of a piece that is drawn by another one; in shares of the piece.
struct Covered {
    std::uint32_t piece;
    double from, to;
    auto operator<=>(const Covered&) const = default;
};

struct CellEntry {
    std::uint64_t cell;
    std::uint32_t rank;  ///< in the order in which pieces are kept
    auto operator<=>(const CellEntry&) const = default;
};

class Overlaps {
public:
    Overlaps(const std::vector<LinePiece>& pieces, std::span<const Candidate> candidates, int deepest)
        : pieces_(pieces) {
        for (std::uint32_t i = 0; i < pieces.size(); ++i)
            if (pieces[i].behind <= deepest && lengthOf(pieces[i]) >= kShortest) order_.push_back(i);
        const auto keyOf = [&](std::uint32_t i) {
            const auto source = candidates[pieces[i].candidate].source;
            const auto priority = std::find(kMeshLinePriority.begin(), kMeshLinePriority.end(), source);
            return std::tuple(pieces[i].behind > 0, priority - kMeshLinePriority.begin(), i);
        };
        tbb::parallel_sort(order_, [&](std::uint32_t a, std::uint32_t b) { return keyOf(a) < keyOf(b); });
    }

    /// Sorted by piece.
    std::vector<Covered> find() {
        fillCells();
        std::vector<std::pair<std::size_t, std::size_t>> runs;
        for (std::size_t i = 0; i < cells_.size();) {
            std::size_t end = i;
            while (end < cells_.size() && cells_[end].cell == cells_[i].cell) ++end;
            if (end - i > 1) runs.emplace_back(i, end);
            i = end;
        }
        std::vector<std::vector<Covered>> found(runs.size());
        tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t run) {
            for (std::size_t j = runs[run].first + 1; j < runs[run].second; ++j)
                for (std::size_t i = runs[run].first; i < j; ++i)
                    compare(order_[cells_[i].rank], order_[cells_[j].rank], found[run]);
        });
        std::vector<Covered> all;
        for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        return all;
    }

private:
    static double lengthOf(const LinePiece& piece) { return glm::distance(piece.end[0].place, piece.end[1].place); }

    void fillCells() {
        for (std::uint32_t rank = 0; rank < order_.size(); ++rank) {
            const LinePiece& piece = pieces_[order_[rank]];
            const glm::dvec2 a = piece.end[0].place, way = piece.end[1].place - a;
            // Cells along the piece, a little too many.
            const int steps = static_cast<int>(std::ceil(glm::length(way) / (0.5 * kCell))) + 1;
            std::uint64_t last = ~std::uint64_t{0};
            for (int i = 0; i <= steps; ++i) {
                const glm::dvec2 at = a + way * (static_cast<double>(i) / steps);
                // Beside the boundary of a cell, a line that is the same may lie in the next one.
                for (const double side : {-2 * kSame, 2 * kSame}) {
                    const glm::dvec2 cell = glm::clamp(glm::floor((at + side) / kCell) + 65536.0, 0.0, 4e9);
                    const std::uint64_t key =
                        static_cast<std::uint64_t>(cell.y) << 32 | static_cast<std::uint64_t>(cell.x);
                    if (key != last) cells_.push_back({key, rank});
                    last = key;
                }
            }
        }
        tbb::parallel_sort(cells_);
        cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
    }

    /// The part of `other` that lies on `kept`.
    void compare(std::uint32_t kept, std::uint32_t other, std::vector<Covered>& found) const {
        const glm::dvec2 a = pieces_[kept].end[0].place, b = pieces_[kept].end[1].place,
                         p = pieces_[other].end[0].place, q = pieces_[other].end[1].place;
        const double length = glm::length(b - a);
        const glm::dvec2 along = (b - a) / length;
        const auto across = [&](const glm::dvec2& x) { return along.x * (x.y - a.y) - along.y * (x.x - a.x); };
        const double atP = across(p), atQ = across(q);
        if (std::min(atP, atQ) > kSame || std::max(atP, atQ) < -kSame) return;
        const double fromP = glm::dot(p - a, along), fromQ = glm::dot(q - a, along);
        if (std::abs(fromQ - fromP) < 0.5 * kShortest) return;
        double from = (0 - fromP) / (fromQ - fromP), to = (length - fromP) / (fromQ - fromP);
        if (from > to) std::swap(from, to);
        from = std::max(from, 0.0);
        to = std::min(to, 1.0);
        // What is left uncovered is longer than any rounding.
        const double least = kSame / glm::length(q - p);
        if (to - from < least) return;
        const auto offset = [&](double t) { return std::abs(atP + (atQ - atP) * t); };
        if (offset(from) > kSame || offset(to) > kSame) return;
        found.push_back({other, from < least ? 0 : from, to > 1 - least ? 1 : to});
    }

    const std::vector<LinePiece>& pieces_;
    std::vector<std::uint32_t> order_;
    std::vector<CellEntry> cells_;
};

LinePiece partOf(const LinePiece& piece, double from, double to) {
    LinePiece part = piece;
    const auto at = [&](double t) {
        LinePoint point;
        point.place = glm::mix(piece.end[0].place, piece.end[1].place, t);
        point.depth = glm::mix(piece.end[0].depth, piece.end[1].depth, t);
        return point;
    };
    if (from > 0) part.end[0] = at(from), part.node[0] = kNoNode;
    if (to < 1) part.end[1] = at(to), part.node[1] = kNoNode;
    return part;
}

}  // namespace

void removeOverlaps(std::vector<LinePiece>& pieces, std::span<const Candidate> candidates, int deepest) {
    const std::vector<Covered> covered = Overlaps(pieces, candidates, deepest).find();
    if (covered.empty()) return;
    std::vector<LinePiece> kept;
    kept.reserve(pieces.size());
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        double from = 0;
        for (; next < covered.size() && covered[next].piece == i; ++next) {
            if (covered[next].from > from) kept.push_back(partOf(pieces[i], from, covered[next].from));
            from = std::max(from, covered[next].to);
        }
        if (from < 1) kept.push_back(partOf(pieces[i], from, 1));
    }
    pieces = std::move(kept);
}

}  // namespace limn
