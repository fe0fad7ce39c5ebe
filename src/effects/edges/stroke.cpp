#include "effects/edges/stroke.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace limn {
namespace edges_stroke {

struct Constants {
    float opacity = 1;
};
constexpr Field kConstants[] = {
    field<&Constants::opacity>("opacity", "Of all lines."),
};

struct NearConstants {
    int reach = 1;
};
constexpr Field kNearConstants[] = {
    field<&NearConstants::reach>("reach", {.unit = "tiles"}, "How far lines can matter."),
};

struct PlaceConstants {
    float fade = 0, taper = 0, fadeFrom = 0, fadeScale = 0;
};
constexpr Field kPlaceConstants[] = {
    field<&PlaceConstants::fade>("fade", "Opacity lost far away."),
    field<&PlaceConstants::taper>("taper", "Width lost far away."),
    field<&PlaceConstants::fadeFrom>("fadeFrom", {.unit = "normalized units"}, "Depth where lines begin to lose."),
    field<&PlaceConstants::fadeScale>(
        "fadeScale", {.unit = "1/normalized units"}, "1 over the depth in which they lose it all."),
};

glm::vec4 pack(const LineStyle& style) {
    return {style.color.r, style.color.g, style.color.b, static_cast<float>(style.width / 2)};
}

}  // namespace edges_stroke

void defineSources(Pass& pass) {
    for (std::size_t i = 0; i < kLineSourceCount; ++i)
        pass.defines.emplace_back(kLineSources[i].define, fmt::format("{}u", i + 1));
}

namespace edges_stroke {

/// Adds the passes in order.
class Strokes {
public:
    Strokes(EffectBuilder& graph, const Stroke& stroke, const std::vector<ResourceId>& marks)
        : graph_(graph),
          stroke_(stroke),
          marks_(marks),
          suffix_(graph.layerSuffix()),
          records_(graph.scene().lineRecords) {
        const auto narrower = [](const auto& a, const auto& b) { return a.width < b.width; };
        widest_ = *std::max_element(stroke.styles.begin(), stroke.styles.end(), narrower);
        // In pixels: a line covers pixels up to half a pixel's diagonal beyond it, and its sample may lie half a pixel
        // beside its own pixel's centre.
        const double reach = stroke.side == LineSide::both ? widest_.width / 2 : widest_.width;
        window_ = static_cast<int>(std::ceil(reach + 1));
    }

    void draw(ResourceId sides) {
        findNear(sides);
        placeCrossings(sides);
        joinPieces();
        drawPieces();
    }

private:
    Pass pass(const std::string& name, std::vector<Read> reads, std::vector<Write> writes, std::string note) const {
        Pass made;
        made.name = name + suffix_;
        made.rate = lineRate(graph_);
        made.shader = "effects/edges/" + name;
        defineSources(made);
        made.reads = std::move(reads);
        made.writes = std::move(writes);
        made.note = std::move(note);
        return made;
    }

    /// Marks the tiles with lines and those nearby. Later passes run only there, since lines cover little of a picture.
    void findNear(ResourceId sides) {
        tiles_ = graph_.image("line_tiles" + suffix_, Format::r8, kMaskTile);
        Pass mark = pass("line_tiles", {{"sides", sides, kMaskTile}}, {{"result", tiles_}}, "where there are lines");
        readMarks(mark, kMaskTile);
        graph_.add(std::move(mark));
        const NearConstants constants{(window_ + kMaskTile - 1) / kMaskTile};
        near_ = graph_.image("near_lines" + suffix_, Format::r8, kMaskTile);
        Pass spread = pass("near_lines", {{"tiles", tiles_, (constants.reach + 1) * kMaskTile}}, {{"result", near_}},
            "where lines matter");
        spread.params = paramsBlock(kNearConstants, constants);
        graph_.add(std::move(spread));
    }

    void placeCrossings(ResourceId sides) {
        crossings_ = graph_.image("line_crossings" + suffix_, Format::rg32ui);
        Pass place = pass("line_places",
            {{"lineTiles", tiles_, kMaskTile}, {"sides", sides}, {"depth", graph_.read(aov::depth), 1},
                {"normalGeometric", graph_.read(aov::normalGeometric), 1}},
            {{"result", crossings_}}, "to 1/256 pixel");
        place.mask = 0;
        if (const auto visibility = graph_.find(aov::visibility)) {
            place.defines.emplace_back("WITH_TRIANGLES", "");
            graph_.defineSeen(place);
            place.reads.push_back({"visibility", *visibility, 2});
            seams_ = graph_.image("line_seams" + suffix_, Format::r8);
            place.writes.push_back({"seams", *seams_});
        }
        if (records_) {
            place.defines.emplace_back("WITH_RECORDS", "");
            place.reads.push_back({"lineRecord", graph_.read(aov::lineRecord), 1});
        }
        const double depths = std::max(stroke_.fadeTo - stroke_.fadeFrom, 1e-6);
        place.params = paramsBlock(kPlaceConstants,
            PlaceConstants{static_cast<float>(stroke_.fade), static_cast<float>(stroke_.taper),
                static_cast<float>(stroke_.fadeFrom), static_cast<float>(1 / depths)});
        place.needs = SceneData::positions;
        if (graph_.find(aov::visibility)) graph_.cutHoles(place);
        graph_.add(std::move(place));
    }

    void joinPieces() {
        first_ = graph_.image("line_pieces" + suffix_, Format::rg32ui);
        second_ = graph_.image("line_pieces_beside" + suffix_, Format::rg32ui);
        Pass join = pass("line_pieces", {mask(), {"crossings", crossings_, 2}},
            {{"first", first_}, {"second", second_}}, "crossings joined");
        join.mask = 0;
        if (seams_) {
            join.defines.emplace_back("WITH_SEAMS", "");
            join.reads.push_back({"seams", *seams_, 3});
        }
        graph_.add(std::move(join));
    }

    void drawPieces() {
        Pass draw = pass("stroke", {mask(), {"first", first_, window_}, {"second", second_, window_}}, {},
            fmt::format("{} cells per pixel near lines", 4 * window_ * window_));
        draw.defines.emplace_back("WINDOW", std::to_string(window_));
        if (stroke_.side != LineSide::both)
            draw.defines.emplace_back("ONE_SIDE", stroke_.side == LineSide::inner ? "1" : "-1");
        if (records_) {
            draw.defines.emplace_back("WITH_RECORDS", "");
            draw.needs = SceneData::positions;
        }
        readMarks(draw, window_);
        addStyles(draw);
        if (const auto below = graph_.find(aov::edges)) {
            // Where this layer has no lines, the layers below must stay.
            draw.reads.push_back({"layersBelow", *below});
            draw.defines.emplace_back("LAYERS_BELOW", "");
        } else {
            draw.mask = 0;
        }
        const ResourceId result = graph_.image("edges" + suffix_, aov::edges.format);
        draw.writes = {{"result", result}};
        graph_.add(std::move(draw));
        graph_.publish(aov::edges, result);
    }

    void readMarks(Pass& pass, int halo) const {
        if (marks_.empty()) return;
        pass.defines.emplace_back("WITH_MARKS", "");
        pass.reads.push_back({"marks", marks_[0], halo});
        pass.reads.push_back({"marksBeside", marks_[1], halo});
    }

    void addStyles(Pass& draw) const {
        // Lines of one colour, or even of one width, need less sorting. Styles that are not drawn take the widest one's
        // look.
        PerSource<LineStyle> styles = stroke_.styles;
        for (auto& style : styles)
            if (style.width <= 0) style = widest_;
        const auto all = [&](const auto& is) { return !records_ && std::all_of(styles.begin(), styles.end(), is); };
        if (all([&](const LineStyle& style) { return style.color == widest_.color; }))
            draw.defines.emplace_back("ONE_COLOR", "");
        if (all([&](const LineStyle& style) { return style == widest_; })) draw.defines.emplace_back("ONE_LOOK", "");
        draw.params = paramsBlock(kConstants, Constants{stroke_.opacity});
        // Per source: linear colour, and half of the width in pixels.
        std::vector<glm::vec4> packed;
        for (const auto& style : styles) packed.push_back(pack(style));
        appendVectors(draw.params, "styles", packed);
    }

    Read mask() const { return {"nearLines", near_, kMaskTile}; }

    EffectBuilder& graph_;
    const Stroke& stroke_;
    const std::vector<ResourceId>& marks_;
    std::string suffix_;
    bool records_;
    LineStyle widest_;
    int window_ = 1;  ///< pixels: the distance up to which lines matter to a pixel
    std::optional<ResourceId> seams_;
    ResourceId tiles_, near_, crossings_, first_, second_;
};

}  // namespace edges_stroke

void strokeLines(EffectBuilder& graph, ResourceId sides, const Stroke& stroke, const std::vector<ResourceId>& marks) {
    edges_stroke::Strokes(graph, stroke, marks).draw(sides);
}

}  // namespace limn
