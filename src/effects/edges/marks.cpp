#include "effects/edges/marks.h"

#include "picture/directions.h"
#include "picture/marks.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace limn {
namespace edges_marks {

/// What a mark is drawn with.
struct Look {
    Stroke stroke;
    std::uint32_t marks = static_cast<std::uint32_t>(lineSource("MARK")) + 1,
                  sections = static_cast<std::uint32_t>(lineSource("SECTION")) + 1;
};

/// A mark in the picture. Places count from the centre of the whole picture's first pixel, in pixels: every tile rounds
/// them alike.
struct Projected {
    glm::dvec2 a{0}, b{0};
    double depthA = 1, depthB = 1;  ///< normalized units
};

std::optional<Projected> project(const View& view, const Mark& mark) {
    glm::dvec3 a = view.toView(mark.a), b = view.toView(mark.b);
    if (!view.orthographic) {
        // In front of the eye, by a little of the line's own length.
        const double nearest = std::max(1e-9, 1e-6 * std::max(std::abs(a.z), std::abs(b.z)));
        if (-a.z < nearest && -b.z < nearest) return std::nullopt;
        const glm::dvec3 cut = a.z == b.z ? a : a + (b - a) * ((-nearest - a.z) / (b.z - a.z));
        if (-a.z < nearest) a = cut;
        if (-b.z < nearest) b = cut;
    }
    const auto place = [&](const glm::dvec3& p) {
        const glm::dvec2 ray = view.orthographic ? glm::dvec2(p) : glm::dvec2(p) / -p.z;
        return (ray - view.rayOffset) / view.rayScale - 0.5;
    };
    return Projected{place(a), place(b), -a.z, -b.z};
}

class Drawer {
public:
    Drawer(HostWork& work, const Look& look)
        : view_(*work.view), depth_(work.reads[0]), normal_(work.reads[1]), images_(work.writes), look_(look) {}

    void draw(const Mark& mark, std::size_t image) {
        const LineStyle& style = look_.stroke.styles[(mark.isCut ? look_.sections : look_.marks) - 1];
        const auto line = project(view_, mark);
        if (!line || style.width <= 0) return;
        const glm::dvec2 way = line->b - line->a;
        // The part within the region's cells.
        double from = 0, to = 1;
        for (int i = 0; i < 2; ++i) {
            const double first = view_.region.origin[i], last = first + depth_.size[i] - 1;
            if (way[i] == 0) {
                if (line->a[i] < first || line->a[i] >= last) return;
                continue;
            }
            const double t0 = (first - line->a[i]) / way[i], t1 = (last - line->a[i]) / way[i];
            from = std::max(from, std::min(t0, t1));
            to = std::min(to, std::max(t0, t1));
        }
        while (from < to) {
            const glm::dvec2 inside = line->a + way * std::min(from + 1e-9, to);
            const glm::ivec2 cell(glm::floor(inside));
            double end = to;
            for (int i = 0; i < 2; ++i)
                if (way[i] != 0)
                    if (const double t = (cell[i] + (way[i] > 0 ? 1 : 0) - line->a[i]) / way[i]; t > from + 1e-9)
                        end = std::min(end, t);
            if (isInside(cell)) put(*line, mark, cell, from, end, images_[image]);
            from = std::max(end, from + 1e-9);
        }
    }

private:
    /// Does a cell begin at a pixel of the region?
    bool isInside(const glm::ivec2& cell) const {
        const glm::ivec2 at = cell - view_.region.origin;
        return at.x >= 0 && at.y >= 0 && at.x < depth_.size.x && at.y < depth_.size.y;
    }

    double depthAt(const Projected& line, double t) const {
        if (view_.orthographic) return line.depthA + (line.depthB - line.depthA) * t;
        return 1 / (1 / line.depthA + (1 / line.depthB - 1 / line.depthA) * t);
    }

    glm::dvec3 viewPosition(const glm::dvec2& place, double depth) const {
        const glm::dvec2 ray = (place + 0.5) * view_.rayScale + view_.rayOffset;
        return {view_.orthographic ? ray : ray * depth, -depth};
    }

    /// Where an image has a pixel of the whole picture.
    std::size_t placeOf(const glm::ivec2& pixel, const HostImage& image) const {
        const glm::ivec2 at = pixel - view_.region.origin;
        return static_cast<std::size_t>(at.y) * static_cast<std::size_t>(image.size.x) + static_cast<std::size_t>(at.x);
    }

    /// Is a point within a cell hidden at all four of its corners, the pixels around it?
    bool isHidden(const glm::ivec2& cell, const glm::dvec2& place, double depth) const {
        const glm::dvec3 point = viewPosition(place, depth);
        const double footprint = view_.rayScale.x * (view_.orthographic ? 1 : depth);
        for (int corner = 0; corner < 4; ++corner) {
            const glm::ivec2 last = view_.region.origin + depth_.size - 1,
                             pixel = glm::min(cell + glm::ivec2(corner % 2, corner / 2), last);
            const std::size_t at = placeOf(pixel, depth_);
            const float seen = depth_.values[at];
            if (seen == kBackgroundDepth || static_cast<double>(seen) >= depth) return false;
            const glm::vec3 normal = decodeDirection({normal_.values[2 * at], normal_.values[2 * at + 1]});
            const glm::dvec3 surface = viewPosition(glm::dvec2(pixel), static_cast<double>(seen));
            if (glm::dot(point - surface, glm::dvec3(normal)) >= -0.5 * footprint) return false;
        }
        return true;
    }

    void put(
        const Projected& line, const Mark& mark, const glm::ivec2& cell, double from, double to, HostImage& image) {
        const glm::dvec2 way = line.b - line.a, middle = line.a + way * (0.5 * (from + to));
        const double depth = depthAt(line, 0.5 * (from + to));
        if (isHidden(cell, middle, depth)) return;
        const double far = std::clamp(
            (depth - look_.stroke.fadeFrom) / std::max(look_.stroke.fadeTo - look_.stroke.fadeFrom, 1e-6), 0.0, 1.0);
        const auto share = [](double value) { return static_cast<std::uint32_t>(std::lround(value * 63)); };
        const std::uint32_t code = (mark.isCut ? look_.sections : look_.marks) | (mark.record << 3)
            | (share(1 - look_.stroke.taper * far) << 11) | (share(1 - look_.stroke.fade * far) << 17);
        // Whole numbers below 2^24, which floats hold.
        const auto packed = [&](double t) {
            const glm::dvec2 at = glm::clamp(line.a + way * t - glm::dvec2(cell), 0.0, 1.0) * 4095.0 + 0.5;
            return static_cast<float>(static_cast<int>(at.x) * 4096 + static_cast<int>(at.y));
        };
        const float values[4] = {packed(from), packed(to), static_cast<float>(code), 0};
        std::copy(values, values + 4, image.values.begin() + static_cast<std::ptrdiff_t>(4 * placeOf(cell, image)));
    }

    const View& view_;
    const HostImage &depth_, &normal_;
    std::vector<HostImage>& images_;
    const Look& look_;
};

}  // namespace edges_marks

MarkImages placeMarks(EffectBuilder& graph, const Stroke& stroke, int rate) {
    const std::string suffix = graph.layerSuffix();
    const MarkImages images{
        graph.image("marks" + suffix, Format::rgba32f), graph.image("marks_beside" + suffix, Format::rgba32f)};
    Pass pass;
    pass.name = "marks" + suffix;
    pass.kind = Pass::Kind::host;
    pass.rate = rate;
    pass.reads = {{"depth", graph.read(aov::depth)}, {"normalGeometric", graph.read(aov::normalGeometric)}};
    pass.writes = {{"marks", images[0]}, {"marks_beside", images[1]}};
    pass.needs = SceneData::marks;
    pass.work = [look = edges_marks::Look{stroke}](HostWork& work) {
        edges_marks::Drawer drawer(work, look);
        for (std::size_t i = 0; i < work.marks.size(); ++i) drawer.draw(work.marks[i], i % 2);
    };
    pass.note = "the scene's own lines";
    graph.add(std::move(pass));
    return images;
}

}  // namespace limn
