#include "drawing/ink.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// Side of the squares of pixels that are drawn at once.
constexpr int kSquare = 32;
/// Dashes and gaps that are shorter together are a line to every eye, in pixels.
constexpr double kShortestPeriod = 0.1;
/// A line that turns by more goes around a corner: its cosine.
constexpr double kCorner = 0.866;  // 30 degrees

/// A straight piece of ink. Places count in pixels of the whole picture.
struct InkPiece {
    glm::dvec2 a, b;
    double halfWidth, strength;
    double rank;  ///< half width before it tapers: wider lines lie on top
    glm::vec3 color;
};

/// The share of a pixel on the near side of a straight line at distance s from its centre, towards the far side: the
/// pixel's projection onto the line's normal is a trapezium (as in shaders/effects/edges/stroke.comp).
double shareWithin(double s, const glm::dvec2& normal) {
    const glm::dvec2 side = glm::abs(normal);
    const double longer = std::max({side.x, side.y, 0.7}), shorter = std::max(std::min(side.x, side.y), 1e-4);
    const double rest = std::max(0.5 * (longer + shorter) - std::abs(s), 0.0);
    const double beyond =
        std::abs(s) < 0.5 * (longer - shorter) ? 0.5 - std::abs(s) / longer : rest * rest / (2 * longer * shorter);
    return s > 0 ? 1 - beyond : beyond;
}

double coverageOf(const InkPiece& piece, const glm::dvec2& centre) {
    const glm::dvec2 along = piece.b - piece.a, off = centre - piece.a;
    const double squared = glm::dot(along, along);
    const double t = squared > 0 ? std::clamp(glm::dot(off, along) / squared, 0.0, 1.0) : 0;
    const glm::dvec2 away = off - along * t;
    const double distance = glm::length(away);
    if (distance > piece.halfWidth + 0.71) return 0;
    const glm::dvec2 normal = distance > 1e-4 ? away / distance
        : squared > 0                         ? glm::dvec2(-along.y, along.x) / std::sqrt(squared)
                                              : glm::dvec2(1, 0);
    return shareWithin(piece.halfWidth - distance, normal) - shareWithin(-piece.halfWidth - distance, normal);
}

/// The inks on a pixel: the widest line's, and the strongest of the others.
struct Inks {
    glm::vec4 top{0}, rest{0};
    double rank = 0;

    void add(const InkPiece& piece, double coverage) {
        const glm::vec4 ink(piece.color, static_cast<float>(coverage * piece.strength));
        const bool isSame = piece.rank == rank && glm::vec3(ink) == glm::vec3(top),
                   isWider = ink.a > 0 && piece.rank > rank;
        const glm::vec4 below = isWider ? top : ink;
        if (!isSame && below.a > rest.a) rest = below;
        if (isWider || (isSame && ink.a > top.a)) top = ink;
        if (isWider) rank = piece.rank;
    }
    glm::vec4 color(float opacity) const {
        return opacity * (glm::vec4(glm::vec3(top), 1) * top.a + (1 - top.a) * rest.a * glm::vec4(glm::vec3(rest), 1));
    }
};

std::vector<InkPiece> inkPieces(
    std::span<const DrawnLine> lines, const InkLook& look, std::span<const LineRecord> records) {
    std::vector<InkPiece> pieces;
    for (const auto& line : lines) {
        const InkStyle& style = look.of(line);
        if (style.width <= 0) continue;
        const Color color = colorOf(line, style, records);
        for (const auto& dash : dashesOf(line, style.dashes))
            for (std::size_t i = 0; i + 1 < dash.size(); ++i) {
                const double depth = 0.5 * (dash[i].depth + dash[i + 1].depth),
                             far = std::clamp(
                                 (depth - look.fadeFrom) / std::max(look.fadeTo - look.fadeFrom, 1e-6), 0.0, 1.0);
                pieces.push_back({dash[i].place, dash[i + 1].place, 0.5 * style.width * (1 - look.taper * far),
                    1 - look.fade * far, 0.5 * style.width, {color.r, color.g, color.b}});
            }
    }
    return pieces;
}

/// The line with its first point at its end, where it is closed.
std::vector<LinePoint> pathOf(const DrawnLine& line) {
    std::vector<LinePoint> path = line.points;
    if (line.isClosed && !path.empty()) path.push_back(path.front());
    return path;
}

}  // namespace

double InkLook::widest() const {
    double width = 0;
    for (const auto* styles : {&visible, &hidden})
        for (const auto& style : *styles) width = std::max(width, style.width);
    return width;
}

Color colorOf(const DrawnLine& line, const InkStyle& style, std::span<const LineRecord> records) {
    return line.record < records.size() ? records[line.record].color.otherwise(style.color) : style.color;
}

/// The dashes of one run between corners.
static void addDashes(
    std::span<const LinePoint> run, const Dashes& dashes, std::vector<std::vector<LinePoint>>& found) {
    double length = 0;
    for (std::size_t i = 0; i + 1 < run.size(); ++i) length += glm::distance(run[i].place, run[i + 1].place);
    // n dashes and n − 1 gaps.
    const double gap = std::max(dashes.gap, 0.0), period = dashes.dash + gap,
                 count = std::max(1.0, std::round((length + gap) / period)),
                 scale = length / (count * dashes.dash + (count - 1) * gap);
    double at = 0;
    std::size_t i = 0;
    double before = 0, here = run.size() > 1 ? glm::distance(run[0].place, run[1].place) : 0;
    const auto pointAt = [&](double along) {
        while (i + 2 < run.size() && before + here < along) {
            before += here;
            ++i;
            here = glm::distance(run[i].place, run[i + 1].place);
        }
        const double t = here > 0 ? std::clamp((along - before) / here, 0.0, 1.0) : 0;
        return LinePoint{glm::mix(run[i].place, run[i + 1].place, t), glm::mix(run[i].depth, run[i + 1].depth, t)};
    };
    for (int n = 0; n < static_cast<int>(count); ++n, at += period * scale) {
        std::vector<LinePoint> dash{pointAt(at)};
        const std::size_t first = i;
        const LinePoint end = pointAt(at + dashes.dash * scale);
        for (std::size_t k = first + 1; k <= i; ++k) dash.push_back(run[k]);
        dash.push_back(end);
        found.push_back(std::move(dash));
    }
}

std::vector<std::vector<LinePoint>> dashesOf(const DrawnLine& line, const Dashes& dashes) {
    const std::vector<LinePoint> path = pathOf(line);
    if (path.size() < 2) return {};
    if (dashes.dash + std::max(dashes.gap, 0.0) < kShortestPeriod || dashes.dash <= 0) return {path};
    std::vector<std::vector<LinePoint>> found;
    std::size_t from = 0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        if (i + 1 < path.size()) {
            const glm::dvec2 in = path[i].place - path[i - 1].place, out = path[i + 1].place - path[i].place;
            if (glm::dot(in, out) >= kCorner * glm::length(in) * glm::length(out)) continue;
        }
        addDashes(std::span(path).subspan(from, i - from + 1), dashes, found);
        from = i;
    }
    return found;
}

void drawInk(std::span<const DrawnLine> lines, const InkLook& look, std::span<const LineRecord> records,
    glm::ivec2 origin, const PixelRect& part, const HostImage* below, HostImage& image) {
    const std::vector<InkPiece> pieces = inkPieces(lines, look, records);
    const glm::ivec2 squares = (part.size + kSquare - 1) / kSquare;
    const glm::ivec2 start = origin + part.origin;
    std::vector<std::vector<std::uint32_t>> inSquare(static_cast<std::size_t>(squares.x) * squares.y);
    // The pixels whose area a piece may reach, counted within the part.
    const auto pixelsOf = [&](const InkPiece& piece) {
        const double reach = piece.halfWidth + 1;
        const glm::dvec2 low = glm::min(piece.a, piece.b) - reach - glm::dvec2(start),
                         high = glm::max(piece.a, piece.b) + reach - glm::dvec2(start);
        const glm::dvec2 most(part.size - 1);
        return std::pair(glm::ivec2(glm::clamp(glm::floor(low), glm::dvec2(0), most + 1.0)),
            glm::ivec2(glm::clamp(glm::floor(high), glm::dvec2(-1), most)));
    };
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        const auto [low, high] = pixelsOf(pieces[i]);
        if (low.x > high.x || low.y > high.y) continue;
        for (int y = low.y / kSquare; y <= high.y / kSquare; ++y)
            for (int x = low.x / kSquare; x <= high.x / kSquare; ++x)
                inSquare[static_cast<std::size_t>(y) * squares.x + x].push_back(i);
    }
    tbb::parallel_for(std::size_t{0}, inSquare.size(), [&](std::size_t square) {
        const glm::ivec2 first = kSquare * glm::ivec2(square % squares.x, square / squares.x),
                         end = glm::min(first + kSquare, part.size);
        std::vector<Inks> inks(inSquare[square].empty() ? 0 : kSquare * kSquare);
        for (const std::uint32_t i : inSquare[square]) {
            const InkPiece& piece = pieces[i];
            const auto [low, high] = pixelsOf(piece);
            for (int y = std::max(low.y, first.y); y <= std::min(high.y, end.y - 1); ++y)
                for (int x = std::max(low.x, first.x); x <= std::min(high.x, end.x - 1); ++x) {
                    const double coverage = coverageOf(piece, glm::dvec2(start + glm::ivec2(x, y)) + 0.5);
                    if (coverage <= 0) continue;
                    inks[static_cast<std::size_t>((y - first.y) * kSquare + x - first.x)].add(piece, coverage);
                }
        }
        for (int y = first.y; y < end.y; ++y)
            for (int x = first.x; x < end.x; ++x) {
                glm::vec4 color(0);
                if (!inks.empty())
                    color = inks[static_cast<std::size_t>((y - first.y) * kSquare + x - first.x)].color(look.opacity);
                const std::size_t at =
                    4 * (static_cast<std::size_t>(part.origin.y + y) * image.size.x + part.origin.x + x);
                for (std::size_t c = 0; c < 4; ++c)
                    image.values[at + c] =
                        color[static_cast<int>(c)] + (below ? below->values[at + c] * (1 - color.a) : 0);
            }
    });
}

}  // namespace limn
