// Every surface half open: the least that a technique of ambient occlusion can be.
//
// Reads depth; writes ambient_occlusion_raw.

#include "effects/ao/occlusion.h"

namespace limn {
namespace ao_half_open {

struct Params {
    float open = 0.5f;
};
constexpr Field kParams[] = {
    field<&Params::open>("open", {.min = 0, .max = 1}, "How open."),
};

void build(EffectBuilder& graph, const Params& params) {
    const OcclusionInputs inputs = occlusionInputs(graph, Resolution::full);
    const ResourceId result = occlusionImage(graph, inputs);
    Pass pass;
    pass.name = "half_open";
    pass.reads = {{"depth", inputs.depth}};
    pass.writes = {{"result", result}};
    pass.params = paramsBlock(kParams, params);
    graph.add(std::move(pass));
    publishOcclusion(graph, inputs, result);
}

const Technique kHalfOpen{"ao", "half_open", "Every surface half open.", kParams, build};

}  // namespace ao_half_open
}  // namespace limn
