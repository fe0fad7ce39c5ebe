#include "drawing/chains.h"

#include "drawing/segment.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

namespace limn {
namespace {

constexpr std::uint32_t kNothing = ~std::uint32_t{0};

/// What pieces of one line have in common.
using Look = std::tuple<MeshLineSource, bool, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
Look lookOf(const Candidate& candidate) {
    return {
        candidate.source, candidate.isCurve, candidate.record, candidate.instance, candidate.part, candidate.material};
}

/// An end of a piece: 2 · piece + 0 or 1.
using PieceEnd = std::uint32_t;

/// Which end of a piece joins which.
class Links {
public:
    Links(const std::vector<LinePiece>& pieces, std::span<const Candidate> candidates)
        : pieces_(pieces), linked_(2 * pieces.size(), kNothing) {
        // Looks as numbers, so that ends are sorted fast.
        std::map<Look, std::uint32_t> looks;
        struct End {
            std::uint64_t node;
            std::uint32_t look;
            PieceEnd end;
            auto operator<=>(const End&) const = default;
        };
        std::vector<End> ends;
        ends.reserve(2 * pieces.size());
        for (PieceEnd i = 0; i < 2 * pieces.size(); ++i) {
            if (nodeOf(i) == kNoNode) continue;
            const auto known = looks.try_emplace(lookOf(candidates[pieces[i / 2].candidate]), looks.size());
            ends.push_back({nodeOf(i), known.first->second, i});
        }
        tbb::parallel_sort(ends);
        std::vector<PieceEnd> together;
        for (std::size_t i = 0; i < ends.size();) {
            together.clear();
            const End& first = ends[i];
            for (; i < ends.size() && ends[i].node == first.node && ends[i].look == first.look; ++i)
                together.push_back(ends[i].end);
            join(together);
        }
    }

    PieceEnd operator[](PieceEnd end) const { return linked_[end]; }

private:
    std::uint64_t nodeOf(PieceEnd end) const { return pieces_[end / 2].node[end % 2]; }
    /// From the end into the piece.
    glm::dvec2 wayFrom(PieceEnd end) const {
        const auto& piece = pieces_[end / 2];
        const glm::dvec2 way = piece.end[1 - end % 2].place - piece.end[end % 2].place;
        const double length = glm::length(way);
        return length > 0 ? way / length : way;
    }

    /// Joins the ends at one node, two and two, the straightest first.
    void join(std::span<const PieceEnd> ends) {
        if (ends.size() == 2) {
            if (ends[0] / 2 != ends[1] / 2) link(ends[0], ends[1]);
            return;
        }
        constexpr std::size_t kMost = 32;  // beyond that nobody could tell
        if (ends.size() < 2 || ends.size() > kMost) return;
        std::vector<std::tuple<double, PieceEnd, PieceEnd>> pairs;
        for (std::size_t i = 0; i < ends.size(); ++i)
            for (std::size_t j = i + 1; j < ends.size(); ++j)
                pairs.emplace_back(glm::dot(wayFrom(ends[i]), wayFrom(ends[j])), ends[i], ends[j]);
        std::sort(pairs.begin(), pairs.end());
        for (const auto& [cosine, a, b] : pairs)
            if (linked_[a] == kNothing && linked_[b] == kNothing && a / 2 != b / 2) link(a, b);
    }

    void link(PieceEnd a, PieceEnd b) {
        linked_[a] = b;
        linked_[b] = a;
    }

    const std::vector<LinePiece>& pieces_;
    std::vector<PieceEnd> linked_;
};

/// A part of a chain behind equally many faces, or equally hidden.
struct Span {
    int behind = 0;
    std::vector<LinePoint> points;
    double length = 0;

    void add(const LinePoint& point) {
        if (!points.empty()) length += glm::distance(points.back().place, point.place);
        points.push_back(point);
    }
};

/// 0: visible; 1: hidden, and to be drawn; 2: neither.
int kindOf(const Span& span, int deepest) { return span.behind == 0 ? 0 : span.behind <= deepest ? 1 : 2; }

/// Joins neighbours that are hidden alike.
void joinAlike(std::vector<Span>& spans, int deepest) {
    std::vector<Span> joined;
    for (auto& span : spans) {
        if (joined.empty() || kindOf(joined.back(), deepest) != kindOf(span, deepest)) {
            joined.push_back(std::move(span));
            continue;
        }
        Span& last = joined.back();
        last.behind = std::min(last.behind, span.behind);
        last.length += span.length;
        last.points.insert(last.points.end(), span.points.begin() + 1, span.points.end());
    }
    spans = std::move(joined);
}

/// Hides what is too short between its neighbours to be seen, and shows what is hidden so briefly.
void clean(std::vector<Span>& spans, int deepest, bool isClosed, double shortest) {
    joinAlike(spans, deepest);
    for (const bool hides : {false, true}) {
        const std::size_t count = spans.size();
        for (std::size_t i = 0; i < count; ++i) {
            const bool isInner = isClosed ? count > 1 : i > 0 && i + 1 < count;
            if (!isInner || spans[i].length >= (hides ? shortest : kShortestPart) || (spans[i].behind == 0) != hides)
                continue;
            const Span &before = spans[(i + count - 1) % count], &after = spans[(i + 1) % count];
            if ((before.behind == 0) == hides || (after.behind == 0) == hides) continue;
            spans[i].behind = before.behind;
        }
        joinAlike(spans, deepest);
    }
}

glm::dvec2 wayTo(const LinePoint& a, const LinePoint& b) { return b.place - a.place; }

/// Takes the points away with which a line turns back at its end: beyond a cusp the surface hides it, and the mesh only
/// shows it on because its facets are flat.
void trimHook(std::vector<LinePoint>& points) {
    double length = 0;
    for (std::size_t i = points.size() - 1; i >= 2 && length < kShortestCurve; --i) {
        length += glm::length(wayTo(points[i - 1], points[i]));
        if (length < kShortestCurve
            && glm::dot(wayTo(points[i - 2], points[i - 1]), wayTo(points[i - 1], points[i])) < 0) {
            points.resize(i);
            return;
        }
    }
}

/// Continues a visible line with another one over a fold: without what would go back.
void append(std::vector<LinePoint>& points, const std::vector<LinePoint>& more) {
    std::size_t first = 0;
    if (points.size() > 1) {
        const glm::dvec2 way = wayTo(points[points.size() - 2], points.back());
        const auto isFold = [&](const LinePoint& point) {
            const glm::dvec2 on = wayTo(points.back(), point);
            return glm::dot(on, way) < 0 && glm::length(on) < kLongestFold;
        };
        while (first + 1 < more.size() && isFold(more[first])) ++first;
    }
    points.insert(points.end(), more.begin() + static_cast<std::ptrdiff_t>(first), more.end());
}

/// Contours of a mesh fold where its facets are nearly seen from their edges: pieces of them hide one another, though
/// the surface's own contour runs on. Folds no longer than kLongestFold are bridged, and hooks at cusps left out.
void unfold(std::vector<Span>& spans) {
    std::vector<Span> unfolded;
    for (auto& span : spans) {
        const std::size_t count = unfolded.size();
        const bool bridges = span.behind == 0 && count > 1 && unfolded[count - 1].behind > 0
            && unfolded[count - 2].behind == 0 && unfolded[count - 1].length < 2 * kLongestFold
            && glm::length(wayTo(unfolded[count - 2].points.back(), span.points.front())) < kLongestFold;
        if (!bridges) {
            unfolded.push_back(std::move(span));
            continue;
        }
        unfolded.pop_back();
        append(unfolded.back().points, span.points);
        unfolded.back().length += span.length;
    }
    spans = std::move(unfolded);
    for (std::size_t i = 0; i < spans.size(); ++i) {
        auto& points = spans[i].points;
        if (spans[i].behind > 0) continue;
        if (i + 1 < spans.size()) trimHook(points);
        if (i == 0) continue;
        std::reverse(points.begin(), points.end());
        trimHook(points);
        std::reverse(points.begin(), points.end());
    }
}

double lengthOf(const DrawnLine& line) {
    double length = 0;
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i)
        length += glm::length(wayTo(line.points[i], line.points[i + 1]));
    return length;
}

/// Places near lines, up to kBeside.
class Neighbourhood {
public:
    void add(const DrawnLine& line) {
        for (std::size_t i = 0; i + (line.isClosed ? 0 : 1) < line.points.size(); ++i) {
            const Way way{line.points[i].place, line.points[(i + 1) % line.points.size()].place};
            // Cells along the way, and those beside them that kBeside reaches.
            const int steps = static_cast<int>(glm::distance(way.a, way.b) / (0.5 * kCell)) + 1;
            std::uint64_t last = ~std::uint64_t{0};
            for (int k = 0; k <= steps; ++k) {
                const glm::ivec2 here = cellOf(glm::mix(way.a, way.b, static_cast<double>(k) / steps));
                if (keyOf(here) == last) continue;
                last = keyOf(here);
                for (int y = here.y - 1; y <= here.y + 1; ++y)
                    for (int x = here.x - 1; x <= here.x + 1; ++x) {
                        auto& ways = cells_[keyOf({x, y})];
                        if (ways.empty() || ways.back().a != way.a || ways.back().b != way.b) ways.push_back(way);
                    }
            }
        }
    }
    bool has(const glm::dvec2& p) const {
        const auto cell = cells_.find(keyOf(cellOf(p)));
        return cell != cells_.end() && std::any_of(cell->second.begin(), cell->second.end(), [&](const Way& way) {
            return distanceFromSegment(way.a, way.b, p) <= kBeside;
        });
    }

private:
    static constexpr double kCell = 4;
    struct Way {
        glm::dvec2 a, b;
    };
    static glm::ivec2 cellOf(const glm::dvec2& p) { return glm::ivec2(glm::floor(p / kCell)); }
    static std::uint64_t keyOf(const glm::ivec2& cell) {
        return std::uint64_t{static_cast<std::uint32_t>(cell.y)} << 32 | static_cast<std::uint32_t>(cell.x);
    }
    std::unordered_map<std::uint64_t, std::vector<Way>> cells_;
};

/// Drops short pieces of curves that run beside longer lines: of two facets that cross the contour nearly at once.
void dropEchoes(std::vector<DrawnLine>& lines, const std::vector<char>& isCurve) {
    std::vector<char> isShort(lines.size());
    Neighbourhood longer;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        isShort[i] = isCurve[i] && lines[i].behind == 0 && lengthOf(lines[i]) < kLongestEcho;
        if (!isShort[i] && lines[i].behind == 0) longer.add(lines[i]);
    }
    std::vector<DrawnLine> kept;
    kept.reserve(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const bool isEcho = isShort[i]
            && std::all_of(lines[i].points.begin(), lines[i].points.end(),
                [&](const LinePoint& point) { return longer.has(point.place); });
        if (!isEcho) kept.push_back(std::move(lines[i]));
    }
    lines = std::move(kept);
}

class Chainer {
public:
    Chainer(const std::vector<LinePiece>& pieces, std::span<const Candidate> candidates, int deepest)
        : pieces_(pieces),
          candidates_(candidates),
          deepest_(deepest),
          links_(pieces, candidates),
          isTaken_(pieces.size()) {}

    std::vector<DrawnLine> all() {
        for (PieceEnd end = 0; end < 2 * pieces_.size(); ++end)
            if (!isTaken_[end / 2] && links_[end] == kNothing) walk(end, false);
        for (PieceEnd end = 0; end < 2 * pieces_.size(); end += 2)
            if (!isTaken_[end / 2]) walk(end, true);
        if (std::any_of(isCurve_.begin(), isCurve_.end(), [](char is) { return is; })) dropEchoes(lines_, isCurve_);
        return std::move(lines_);
    }

private:
    void walk(PieceEnd start, bool isClosed) {
        std::vector<Span> spans;
        PieceEnd end = start;
        do {
            const LinePiece& piece = pieces_[end / 2];
            isTaken_[end / 2] = true;
            if (spans.empty() || spans.back().behind != piece.behind) {
                spans.push_back({piece.behind, {}, 0});
                spans.back().add(piece.end[end % 2]);
            }
            spans.back().add(piece.end[1 - end % 2]);
            end = links_[end ^ 1u];
        } while (end != kNothing && end != start);
        const bool isCurve = candidates_[pieces_[start / 2].candidate].isCurve;
        clean(spans, deepest_, isClosed, isCurve ? kShortestCurve : kShortestPart);
        if (isCurve && spans.size() > 1) {
            if (isClosed) beginWithLongest(spans);
            unfold(spans);
            joinAlike(spans, deepest_);
        }
        if (isCurve && isClosed && spans.size() == 1 && spans[0].length < kLongestFold) return;  // a dimple of facets
        if (isClosed && spans.size() > 1) turn(spans);
        for (auto& span : spans)
            if (span.behind <= deepest_) put(std::move(span), start, isClosed && spans.size() == 1);
    }

    static void beginWithLongest(std::vector<Span>& spans) {
        const auto isShorter = [](const Span& a, const Span& b) { return a.length < b.length; };
        std::rotate(spans.begin(), std::max_element(spans.begin(), spans.end(), isShorter), spans.end());
    }

    /// Lets a closed chain begin where its look changes.
    void turn(std::vector<Span>& spans) const {
        if (kindOf(spans.front(), deepest_) != kindOf(spans.back(), deepest_)) return;
        Span& last = spans.back();
        Span& first = spans.front();
        last.points.insert(last.points.end(), first.points.begin() + 1, first.points.end());
        last.length += first.length;
        last.behind = std::min(first.behind, last.behind);
        spans.erase(spans.begin());
    }

    void put(Span&& span, PieceEnd start, bool isClosed) {
        const Candidate& candidate = candidates_[pieces_[start / 2].candidate];
        DrawnLine line{candidate.source, candidate.record, candidate.instance, candidate.part, candidate.material,
            span.behind, isClosed, std::move(span.points)};
        if (isClosed) line.points.pop_back();
        lines_.push_back(std::move(line));
        isCurve_.push_back(candidate.isCurve);
    }

    const std::vector<LinePiece>& pieces_;
    std::span<const Candidate> candidates_;
    int deepest_;
    Links links_;
    std::vector<char> isTaken_;
    std::vector<DrawnLine> lines_;
    std::vector<char> isCurve_;  ///< parallel to them
};

}  // namespace

std::vector<DrawnLine> chain(const std::vector<LinePiece>& pieces, std::span<const Candidate> candidates, int deepest) {
    return Chainer(pieces, candidates, deepest).all();
}

}  // namespace limn
