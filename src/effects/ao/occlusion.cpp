#include "effects/ao/occlusion.h"

namespace limn {

OcclusionInputs occlusionInputs(EffectBuilder& graph, Resolution resolution) {
    OcclusionInputs inputs{
        graph.read(aov::depth), graph.read(aov::normalGeometric), resolution == Resolution::half ? 2 : 1};
    if (resolution == Resolution::full) return inputs;
    Pass pass;
    pass.name = "halve_depth";
    pass.shader = "effects/ao/halve_depth";
    pass.reads = {{"depth", inputs.depth, 1}};
    inputs.depth = graph.image("depth_half", Format::r32f, 2);
    pass.writes = {{"result", inputs.depth}};
    pass.defines.emplace_back("COARSENESS", "2");
    graph.add(std::move(pass));
    return inputs;
}

ResourceId occlusionImage(EffectBuilder& graph, const OcclusionInputs& inputs) {
    return inputs.coarseness == 1 ? graph.image(aov::ambientOcclusionRaw)
                                  : graph.image("ambient_occlusion_half", Format::r32f, inputs.coarseness);
}

void publishOcclusion(EffectBuilder& graph, const OcclusionInputs& inputs, ResourceId image) {
    if (inputs.coarseness > 1) {
        const ResourceId full = graph.image(aov::ambientOcclusionRaw);
        Pass pass;
        pass.name = "upsample";
        pass.shader = "effects/ao/upsample";
        pass.reads = {{"source", image, inputs.coarseness}, {"coarseDepth", inputs.depth, inputs.coarseness},
            {"depth", graph.read(aov::depth)}, {"normal", inputs.normal}};
        pass.writes = {{"result", full}};
        pass.note = "4 texels per pixel";
        graph.add(std::move(pass));
        image = full;
    }
    graph.publish(aov::ambientOcclusionRaw, image);
    graph.publish(aov::ambientOcclusion, image);
}

void defineOcclusion(Pass& pass, const OcclusionInputs& inputs, Falloff falloff) {
    pass.defines.emplace_back("COARSENESS", std::to_string(inputs.coarseness));
    pass.defines.emplace_back("FALLOFF", std::to_string(static_cast<int>(falloff)));
}

}  // namespace limn
