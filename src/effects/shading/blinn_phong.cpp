// Ambient, diffuse and Blinn-Phong light of the deferred renderer in Lawonn's lecture "Screen-Space Ambient Occlusion":
// ambient occlusion dims the ambient part alone; diffuse and specular light fall with 1/(1 + l·d + q·d²), d in scene
// units.
//
// Reads depth, normal, albedo, material_id and, where there is any, ambient_occlusion; writes shade. The lecture's
// exponent serves all materials; give exponent 0 to take each material's own.

#include "effects/shading/lighting.h"

namespace limn {
namespace shading_blinn_phong {

struct Params {
    float ambient = 0.3f;
    float exponent = 8;
    float specular = 1;
    float linear = 0;
    float quadratic = 0;
    float aoStrength = 1;
};
constexpr Field kParams[] = {
    field<&Params::ambient>("ambient", {.min = 0, .max = 10}, "Light from everywhere, which ambient occlusion dims."),
    field<&Params::exponent>("exponent", {.min = 0, .max = 4096}, "Of highlights; 0: each material's own."),
    field<&Params::specular>("specular", {.min = 0, .max = 10}, "Strength of all highlights."),
    field<&Params::linear>(
        "linear", {.unit = "1 / scene unit", .min = 0, .max = 1000}, "How lights with a place weaken with distance."),
    field<&Params::quadratic>(
        "quadratic", {.unit = "1 / square scene unit", .min = 0, .max = 1000}, "How they weaken with its square."),
    field<&Params::aoStrength>("ao_strength", {.min = 0, .max = 1},
        "How much of the ambient occlusion is applied; at 0 it is not even computed."),
};

void build(EffectBuilder& graph, const Params& params) {
    addLitShading(graph, "blinn_phong", paramsBlock(kParams, params), params.aoStrength,
        params.specular <= 0       ? Highlights::none
            : params.exponent == 0 ? Highlights::ofMaterials
                                   : Highlights::alike);
}

const Technique kBlinnPhong{"shading", "blinn_phong",
    "Ambient, diffuse and specular light that weakens with distance (Lawonn's lecture).", kParams, build,
    {{"paper", "As taught: ambient 0.3, exponent 8, attenuation for lights 50 units away.",
        "ambient = 0.3, exponent = 8, linear = 0.09, quadratic = 0.032"}}};

}  // namespace shading_blinn_phong
}  // namespace limn
