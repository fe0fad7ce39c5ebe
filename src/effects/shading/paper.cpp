// A drawing on paper: everything has the sheet's colour and a tint of its own, and ambient occlusion darkens it like a
// wash.
//
// Reads depth, albedo where there is a tint, ambient_occlusion where there is any; writes shade. Cut faces of sections
// keep their fill, without shade: they are drawn, not seen.

#include "effects/technique.h"

namespace limn {
namespace shading_paper {

struct Params {
    Color color{1, 1, 1};
    float tint = 0;
    Color washColor{0, 0, 0};
    float aoStrength = 1;
};
constexpr Field kParams[] = {
    field<&Params::color>("color", "Of the paper."),
    field<&Params::tint>("tint", {.min = 0, .max = 1}, "How much of their own colours objects show."),
    field<&Params::washColor>("wash_color", "Colour that ambient occlusion leads to, where nothing is open."),
    field<&Params::aoStrength>("ao_strength", {.min = 0, .max = 1},
        "How much of the ambient occlusion is applied; at 0 it is not even computed."),
};

void build(EffectBuilder& graph, const Params& params) {
    const ResourceId result = graph.image(aov::shade);
    Pass pass;
    pass.name = "paper";
    pass.reads = {{"depth", graph.read(aov::depth)}};
    const auto with = [&](bool wanted, const char* define, const char* sampler, std::optional<ResourceId> image) {
        if (!wanted || !image) return;
        pass.defines.emplace_back(define, "");
        pass.reads.push_back({sampler, *image});
    };
    with(params.tint > 0 || graph.scene().sections, "WITH_ALBEDO", "albedo", graph.find(aov::albedo));
    with(params.aoStrength > 0, "WITH_AO", "ambientOcclusion", graph.find(aov::ambientOcclusion));
    with(graph.scene().sections, "WITH_SECTIONS", "lineRecord", graph.find(aov::lineRecord));
    pass.needs = graph.scene().sections ? SceneData::positions : SceneData::none;
    pass.writes = {{"result", result}};
    pass.params = paramsBlock(kParams, params);
    graph.add(std::move(pass));
    graph.publish(aov::shade, result);
}

const Technique kPaper{
    "shading", "paper", "Paper, tinted by the objects' colours and washed with ambient occlusion.", kParams, build};

}  // namespace shading_paper
}  // namespace limn
