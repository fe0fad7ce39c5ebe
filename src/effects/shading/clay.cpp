// Ambient occlusion alone, as if everything were of one pale clay under an even sky.
//
// Reads depth and, where there is any, ambient_occlusion; writes shade.

#include "effects/technique.h"

namespace limn {
namespace shading_clay {

struct Params {
    Color color{1, 1, 1};
};
constexpr Field kParams[] = {
    field<&Params::color>("color", "Of the clay where it is open."),
};

void build(EffectBuilder& graph, const Params& params) {
    const ResourceId result = graph.image(aov::shade);
    Pass pass;
    pass.name = "clay";
    pass.reads = {{"depth", graph.read(aov::depth)}};
    if (const auto ao = graph.find(aov::ambientOcclusion)) {
        pass.reads.push_back({"ambientOcclusion", *ao});
        pass.defines.emplace_back("WITH_AO", "");
    }
    pass.writes = {{"result", result}};
    pass.params = paramsBlock(kParams, params);
    graph.add(std::move(pass));
    graph.publish(aov::shade, result);
}

const Technique kClay{"shading", "clay", "Ambient occlusion alone, on pale clay.", kParams, build};

}  // namespace shading_clay
}  // namespace limn
