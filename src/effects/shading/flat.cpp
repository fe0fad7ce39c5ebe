// Flat colours: the objects' own, without light, times ambient occlusion where there is any.

#include "effects/technique.h"

namespace limn {
namespace shading_flat {

struct Params {
    float aoStrength = 1;
};

constexpr Field kParams[] = {
    field<&Params::aoStrength>("ao_strength", {.min = 0, .max = 1},
        "How much of the ambient occlusion is applied; at 0 it is not even computed."),
};

struct Constants {
    float aoStrength = 1;
};
constexpr Field kConstants[] = {
    field<&Constants::aoStrength>("aoStrength", "0 none, 1 all of the ambient occlusion."),
};

void build(EffectBuilder& graph, const Params& params) {
    const ResourceId result = graph.image(aov::shade);
    Pass pass;
    pass.name = "flat";
    pass.reads = {{"albedo", graph.read(aov::albedo)}};
    if (const auto ao = graph.find(aov::ambientOcclusion); ao && params.aoStrength > 0) {
        pass.reads.push_back({"ambientOcclusion", *ao});
        pass.defines = {{"WITH_AO", ""}};
    }
    pass.writes = {{"result", result}};
    pass.params = paramsBlock(kConstants, Constants{params.aoStrength});
    graph.add(std::move(pass));
    graph.publish(aov::shade, result);
}

const Technique kFlat{
    "shading", "flat", "The objects' own colours, without lights; ambient occlusion multiplies.", kParams, build};

}  // namespace shading_flat
}  // namespace limn
