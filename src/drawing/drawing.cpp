#include "drawing/drawing.h"

#include "drawing/segment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace limn {
namespace {

/// Marks the points between two that are needed.
void markNeeded(const std::vector<glm::dvec2>& path, std::size_t first, std::size_t last, double tolerance,
    std::vector<char>& needed) {
    std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
    while (!open.empty()) {
        const auto [from, to] = open.back();
        open.pop_back();
        double farthest = tolerance;
        std::size_t at = 0;
        for (std::size_t i = from + 1; i < to; ++i) {
            const double distance = distanceFromSegment(path[from], path[to], path[i]);
            if (distance > farthest) farthest = distance, at = i;
        }
        if (at == 0) continue;
        needed[at] = true;
        open.emplace_back(from, at);
        open.emplace_back(at, to);
    }
}

std::vector<glm::dvec2> simplified(const std::vector<glm::dvec2>& path, bool isClosed, double tolerance) {
    if (path.size() < 3 || tolerance <= 0) return path;
    std::vector<char> needed(path.size());
    needed.front() = needed.back() = true;
    // A closed path has no ends to keep: it is halved at the point that lies farthest from its first.
    std::size_t middle = 0;
    for (std::size_t i = 1; isClosed && i < path.size(); ++i)
        if (glm::distance(path[i], path[0]) > glm::distance(path[middle], path[0])) middle = i;
    needed[middle] = true;
    if (middle > 0) markNeeded(path, 0, middle, tolerance, needed);
    markNeeded(path, middle, path.size() - 1, tolerance, needed);
    std::vector<glm::dvec2> kept;
    for (std::size_t i = 0; i < path.size(); ++i)
        if (needed[i]) kept.push_back(path[i]);
    return kept;
}

PaperLine paperLine(const Drawing& drawing, const Drawing::Layer& layer, const DrawnLine& line, double simplify) {
    const InkStyle& style = layer.look.of(line);
    PaperLine made;
    made.line = &line;
    made.color = colorOf(line, style, drawing.records);
    double depth = 0;
    for (const auto& point : line.points) depth += point.depth / static_cast<double>(line.points.size());
    const double far =
        std::clamp((depth - layer.look.fadeFrom) / std::max(layer.look.fadeTo - layer.look.fadeFrom, 1e-6), 0.0, 1.0);
    made.width = drawing.millimetres(style.width * (1 - layer.look.taper * far));
    made.opacity = static_cast<double>(layer.look.opacity) * (1 - layer.look.fade * far);
    made.isClosed = line.isClosed && style.dashes.dash <= 0;
    for (const auto& dash : dashesOf(line, style.dashes)) {
        std::vector<glm::dvec2> path;
        path.reserve(dash.size());
        for (const auto& point : dash)
            path.emplace_back(drawing.millimetres(point.place.x), drawing.millimetres(drawing.size.y - point.place.y));
        made.paths.push_back(simplified(path, made.isClosed, simplify));
    }
    return made;
}

}  // namespace

std::vector<PaperGroup> onPaper(const Drawing& drawing, double simplify) {
    std::vector<PaperGroup> all;
    for (const auto& layer : drawing.layers) {
        std::map<std::tuple<bool, double, MeshLineSource>, PaperGroup> groups;
        for (const auto& line : layer.lines) {
            const InkStyle& style = layer.look.of(line);
            if (style.width <= 0) continue;
            PaperGroup& group = groups[{line.behind == 0, style.width, line.source}];
            group.isHidden = line.behind > 0;
            group.source = line.source;
            group.style = style;
            group.style.width = drawing.millimetres(style.width);
            group.opacity = static_cast<double>(layer.look.opacity);
            group.lines.push_back(paperLine(drawing, layer, line, simplify));
        }
        for (auto& [key, group] : groups) all.push_back(std::move(group));
    }
    return all;
}

std::string objectOf(const Drawing& drawing, const DrawnLine& line) {
    const Drawing::Object& object = drawing.objects[line.instance];
    if (object.parts.size() < 2 || line.part >= object.parts.size() || object.parts[line.part].empty())
        return object.name;
    return object.name.empty() ? object.parts[line.part] : object.name + " / " + object.parts[line.part];
}

}  // namespace limn
