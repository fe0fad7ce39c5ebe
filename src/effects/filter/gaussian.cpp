// A 3×3 Gaussian, several times over: pass 3 of Lajzer & Nottingham.
//
// Reads and writes ambient_occlusion. Each application is a pass of its own.

#include "effects/technique.h"

namespace limn {
namespace filter_gaussian {

struct Params {
    int iterations = 3;
};

constexpr Field kParams[] = {
    field<&Params::iterations>("iterations", {.min = 1, .max = 64, .keyable = false, .doc = "How often the 3×3 Gaussian is applied; n times widen it to a standard deviation of sqrt(n/2) pixels."}),
};

void build(EffectBuilder& graph, const Params& params) {
    for (int i = 0; i < params.iterations; ++i) {
        const bool last = i + 1 == params.iterations;
        const ResourceId result = last ? graph.image(aov::ambientOcclusion) : graph.image("ambient_occlusion_blur", Format::r32f);
        Pass pass;
        pass.name = "gaussian_" + std::to_string(i + 1);
        pass.reads = {{"source", graph.read(aov::ambientOcclusion), 1}};
        pass.writes = {{"result", result}};
        pass.note = "9 taps per pixel";
        graph.add(std::move(pass));
        graph.publish(aov::ambientOcclusion, result);
    }
}

const Technique kGaussian{"filter", "gaussian", "A 3×3 Gaussian, several times over (Lajzer & Nottingham).", kParams, build, {{"paper", "As published: the default.", ""}}};

}  // namespace filter_gaussian
}  // namespace limn
