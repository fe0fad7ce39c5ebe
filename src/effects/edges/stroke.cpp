#include "effects/edges/stroke.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {
namespace edges_stroke {

struct Constants {
    glm::vec4 silhouette{0}, crease{0}, object{0}, material{0}, section{0};
    float opacity = 1;
};
constexpr Field kConstants[] = {
    field<&Constants::silhouette>("silhouette",
        "Linear colour, and half of the width in pixels, of lines where one surface ends in front of another."),
    field<&Constants::crease>("crease", "The same where a surface bends."),
    field<&Constants::object>("object", "The same where objects meet."),
    field<&Constants::material>("material", "The same where materials meet."),
    field<&Constants::section>("section", "The same around the cut faces of sections."),
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

void strokeLines(EffectBuilder& graph, ResourceId sides, const Stroke& stroke) {
    using namespace edges_stroke;
    const bool records = graph.scene().lineRecords;
    // Lines of one colour, or even of one width, need less sorting. Styles that are not drawn look as any other.
    std::array<LineStyle, 5> styles{stroke.silhouette, stroke.crease, stroke.object, stroke.material, stroke.section};
    const LineStyle widest =
        *std::max_element(styles.begin(), styles.end(), [](const auto& a, const auto& b) { return a.width < b.width; });
    for (auto& style : styles)
        if (style.width <= 0) style = widest;
    const bool oneColor = !records
        && std::all_of(styles.begin(), styles.end(), [&](const auto& style) { return style.color == widest.color; });
    const bool oneLook =
        !records && std::all_of(styles.begin(), styles.end(), [&](const auto& style) { return style == widest; });
    // In pixels: a line covers pixels up to half a pixel's diagonal beyond it, and may be seen from half a pixel beside
    // the centre of its own.
    const int window =
        static_cast<int>(std::ceil((stroke.side == LineSide::both ? widest.width / 2 : widest.width) + 1));
    const std::string suffix = graph.layerSuffix();
    const auto pass = [&](std::string name, std::vector<Read> reads, std::vector<Write> writes, std::string note) {
        Pass made;
        made.name = name + suffix;
        made.rate = lineRate(graph);
        made.shader = "effects/edges/" + name;
        made.reads = std::move(reads);
        made.writes = std::move(writes);
        made.note = std::move(note);
        return made;
    };

    // Lines cover little of a picture: what follows runs only in the tiles that have some, or lie near those.
    const ResourceId tiles = graph.image("line_tiles" + suffix, Format::r8, kMaskTile);
    graph.add(pass("line_tiles", {{"sides", sides, kMaskTile}}, {{"result", tiles}}, "where there are lines"));
    const NearConstants nearConstants{(window + kMaskTile - 1) / kMaskTile};
    const ResourceId near = graph.image("near_lines" + suffix, Format::r8, kMaskTile);
    Pass spread = pass("near_lines", {{"tiles", tiles, (nearConstants.reach + 1) * kMaskTile}}, {{"result", near}},
        "where lines matter");
    spread.params = paramsBlock(kNearConstants, nearConstants);
    graph.add(std::move(spread));
    const Read mask{"nearLines", near, kMaskTile};

    const ResourceId crossings = graph.image("line_crossings" + suffix, Format::rg32ui);
    Pass place = pass("line_places",
        {{"lineTiles", tiles, kMaskTile}, {"sides", sides}, {"depth", graph.read(aov::depth), 1},
            {"normalGeometric", graph.read(aov::normalGeometric), 1}},
        {{"result", crossings}}, "to 1/256 pixel");
    place.mask = 0;
    if (const auto visibility = graph.find(aov::visibility)) {
        place.defines.emplace_back("WITH_TRIANGLES", "");
        graph.defineSeen(place);
        place.reads.push_back({"visibility", *visibility, 2});
    }
    if (records) {
        place.defines.emplace_back("WITH_RECORDS", "");
        place.reads.push_back({"lineRecord", graph.read(aov::lineRecord), 1});
    }
    place.params = paramsBlock(kPlaceConstants,
        PlaceConstants{static_cast<float>(stroke.fade), static_cast<float>(stroke.taper),
            static_cast<float>(stroke.fadeFrom),
            static_cast<float>(1 / std::max(stroke.fadeTo - stroke.fadeFrom, 1e-6))});
    place.needs = SceneData::positions;
    if (graph.find(aov::visibility)) graph.cutHoles(place);
    graph.add(std::move(place));

    const ResourceId first = graph.image("line_pieces" + suffix, Format::rg32ui),
                     second = graph.image("line_pieces_beside" + suffix, Format::rg32ui);
    Pass join = pass(
        "line_pieces", {mask, {"crossings", crossings, 2}}, {{"first", first}, {"second", second}}, "crossings joined");
    join.mask = 0;
    graph.add(std::move(join));

    Pass draw = pass("stroke", {mask, {"first", first, window}, {"second", second, window}}, {},
        fmt::format("{} cells per pixel near lines", 4 * window * window));
    draw.defines.emplace_back("WINDOW", std::to_string(window));
    if (oneColor) draw.defines.emplace_back("ONE_COLOR", "");
    if (oneLook) draw.defines.emplace_back("ONE_LOOK", "");
    if (stroke.side != LineSide::both)
        draw.defines.emplace_back("ONE_SIDE", stroke.side == LineSide::inner ? "1" : "-1");
    if (records) {
        draw.defines.emplace_back("WITH_RECORDS", "");
        draw.needs = SceneData::positions;
    }
    draw.params = paramsBlock(kConstants,
        Constants{pack(styles[0]), pack(styles[1]), pack(styles[2]), pack(styles[3]), pack(styles[4]), stroke.opacity});
    if (const auto below = graph.find(aov::edges)) {
        // Away from this layer's lines the layers below must stay.
        draw.reads.push_back({"layersBelow", *below});
        draw.defines.emplace_back("LAYERS_BELOW", "");
    } else {
        draw.mask = 0;
    }
    const ResourceId result = graph.image("edges" + suffix, aov::edges.format);
    draw.writes = {{"result", result}};
    graph.add(std::move(draw));
    graph.publish(aov::edges, result);
}

}  // namespace limn
