// Lambert's cosine law with an ambient term a·(1 − m), where 1 − m is ambient occlusion: the shading of Schmitt,
// "Screen Space Ambient Occlusion" (2008). With intensity 0 it is his ambient light alone.
//
// Reads depth, normal, albedo, material_id and, where there is any, ambient_occlusion; writes shade. The author worked
// in display-encoded colour; this is linear light.

#include "effects/shading/lighting.h"

namespace limn {
namespace shading_lambert {

struct Params {
    float ambient = 0.4f;
    float intensity = 0.6f;
    float aoStrength = 1;
};
constexpr Field kParams[] = {
    field<&Params::ambient>("ambient", {.min = 0, .max = 10}, "Light from everywhere, which ambient occlusion dims."),
    field<&Params::intensity>("intensity", {.min = 0, .max = 10}, "Strength of all lights."),
    field<&Params::aoStrength>("ao_strength", {.min = 0, .max = 1},
        "How much of the ambient occlusion is applied; at 0 it is not even computed."),
};

void build(EffectBuilder& graph, const Params& params) {
    addLitShading(graph, "lambert", paramsBlock(kParams, params), params.aoStrength, Highlights::none);
}

const Technique kLambert{"shading", "lambert",
    "Lambert's cosine law, with ambient light dimmed by ambient occlusion (Schmitt).", kParams, build};

}  // namespace shading_lambert
}  // namespace limn
