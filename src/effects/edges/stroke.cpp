#include "effects/edges/stroke.h"

#include <fmt/format.h>

#include <cmath>

namespace limn {
namespace edges_stroke {

struct Constants {
    glm::vec4 color{0};
    float reach = 1;
    int window = 1;
};
constexpr Field kConstants[] = {
    field<&Constants::color>("color", {.doc = "Linear, premultiplied by the opacity."}),
    field<&Constants::reach>("reach", {.unit = "pixels", .doc = "Half of the lines' width."}),
    field<&Constants::window>("window", {.unit = "pixels", .doc = "How far lines can matter."}),
};

}  // namespace edges_stroke

void strokeLines(EffectBuilder& graph, ResourceId sides, const Stroke& stroke) {
    edges_stroke::Constants constants;
    constants.color = glm::vec4(stroke.color.r, stroke.color.g, stroke.color.b, 1) * stroke.opacity;
    constants.reach = static_cast<float>(graph.view().pixels(stroke.width) / 2);
    // Sides lie at half pixels, and lines fade out half a pixel beyond their reach.
    constants.window = static_cast<int>(std::ceil(constants.reach));

    const std::string note = fmt::format("{} taps per pixel", 2 * constants.window + 1);
    Pass rows;
    rows.name = "stroke_rows" + graph.layerSuffix();
    rows.shader = "frame/stroke_rows";
    rows.reads = {{"sides", sides, constants.window}};
    const ResourceId perRow = graph.image("stroke_rows" + graph.layerSuffix(), Format::rg32f);
    rows.writes = {{"result", perRow}};
    rows.params = paramsBlock(edges_stroke::kConstants, constants);
    rows.note = note;
    graph.add(std::move(rows));

    Pass draw;
    draw.name = "stroke" + graph.layerSuffix();
    draw.shader = "frame/stroke";
    draw.reads = {{"rows", perRow, constants.window}};
    draw.note = note;
    if (const auto below = graph.find(aov::edges)) {
        draw.reads.push_back({"layersBelow", *below});
        draw.defines.emplace_back("LAYERS_BELOW", "");
    }
    const ResourceId result = graph.image("edges" + graph.layerSuffix(), aov::edges.format);
    draw.writes = {{"result", result}};
    draw.params = paramsBlock(edges_stroke::kConstants, constants);
    graph.add(std::move(draw));
    graph.publish(aov::edges, result);
}

}  // namespace limn
