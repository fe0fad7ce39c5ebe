// Image-space horizon-based ambient occlusion: march away from the pixel in a few directions and keep the highest rise.
// Bavoil & Sainz, "Image-Space Horizon-Based Ambient Occlusion", SIGGRAPH 2008.
//
// Reads depth and the geometric normal; writes ambient_occlusion_raw.
//
// Paper mode: occlusion is sin h − sin t, averaged over directions (a wall at angle β hides β/π of the light). Horizons
// less than 30 degrees above the surface are ignored. Occluders count 1 − (d/R)². Taps beyond the picture take its
// border.
// Default mode: occlusion is weighted with the cosine, in planes through the line of sight. It tends to the ray-traced
// truth wherever the depth buffer is the whole truth. The bias only covers rounding. It has the falloff of all
// techniques and a guard band.

#include "effects/ao/occlusion.h"

#include <fmt/format.h>

#include <cmath>

namespace limn {
enum class HorizonWeight { cosine, uniform };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<HorizonWeight> = {"cosine", "uniform"};

namespace ao_hbao {

struct Params {
    Length radius = Length::percent(5);
    int directions = 6;
    int steps = 6;
    float angleBias = 0.0057f;
    HorizonWeight weight = HorizonWeight::cosine;
    float stepGrowth = 0.5f;
    Falloff falloff = Falloff::none;
    bool clampTaps = false;
    Resolution resolution = Resolution::full;
    float strength = 1;
};

constexpr Field kParams[] = {
    field<&Params::radius>("radius", {.unit = "scene units", .min = 1e-9}, "Farthest occluder that darkens a point."),
    field<&Params::directions>("directions", {.min = 1, .max = 64, .accuracy = true, .keyable = false},
        "Search directions per pixel and sample."),
    field<&Params::steps>("steps", {.min = 1, .max = 256, .accuracy = true, .keyable = false},
        "Most depths looked at along each direction."),
    field<&Params::angleBias>("angle_bias", {.unit = "degrees", .min = 0, .max = 89},
        "Horizons closer to the surface are ignored: hides the facets of coarse meshes, and real occlusion with them."),
    field<&Params::weight>(
        "weight", "Weigh what is hidden by the cosine, as light does, or count directions alike, as the paper does."),
    field<&Params::stepGrowth>("step_growth", {.min = 0, .max = 1},
        "0: steps evenly spaced; 1: distances grow by the square, denser near the point."),
    field<&Params::falloff>("falloff", "How an occluder's weight falls with its distance, up to the radius."),
    field<&Params::clampTaps>(
        "clamp_taps", "Look no farther than the picture's border, as the paper does, instead of drawing a guard band."),
    field<&Params::resolution>("resolution", {.keyable = false}, "Compute every pixel, or every second one each way."),
    field<&Params::strength>(
        "strength", {.min = 0, .max = 4}, "Exponent on the result: above 1 darker, below 1 lighter."),
};

struct Constants {
    float radius = 0, sinBias = 0, cosBias = 1, stepGrowth = 0, strength = 1;
    glm::vec2 turn{1, 0};
};
constexpr Field kConstants[] = {
    field<&Constants::radius>("radius", {.unit = "normalized units"}, "Farthest occluder."),
    field<&Constants::sinBias>("sinBias", "Sine of the angle above the surface below which horizons are ignored."),
    field<&Constants::cosBias>("cosBias", "Its cosine."),
    field<&Constants::stepGrowth>("stepGrowth", "How much denser the steps are near the point."),
    field<&Constants::strength>("strength", "Exponent on the result."),
    field<&Constants::turn>("turn", "Cosine and sine of the angle between directions."),
};

Constants derive(const Params& params, const View& view) {
    const double bias = glm::radians(static_cast<double>(params.angleBias)),
                 turn = 2 * std::acos(-1.0) / params.directions;
    Constants c;
    c.radius = static_cast<float>(view.normalized(params.radius));
    c.sinBias = static_cast<float>(std::sin(bias));
    c.cosBias = static_cast<float>(std::cos(bias));
    c.stepGrowth = params.stepGrowth;
    c.strength = params.strength;
    c.turn = {std::cos(turn), std::sin(turn)};
    return c;
}

void build(EffectBuilder& graph, const Params& params) {
    const OcclusionInputs inputs = occlusionInputs(graph, params.resolution);
    const ResourceId result = occlusionImage(graph, inputs);
    Pass pass;
    pass.name = "hbao";
    const int halo = params.clampTaps ? 0 : graph.view().haloOf(graph.view().normalized(params.radius));
    pass.reads = {
        {"depth", inputs.depth, halo, params.clampTaps || !graph.view().holds(halo)}, {"normal", inputs.normal}};
    graph.seedNoise(pass);
    pass.writes = {{"result", result}};
    pass.params = paramsBlock(kConstants, derive(params, graph.view()));
    defineOcclusion(pass, inputs, params.falloff);
    if (params.weight == HorizonWeight::uniform) pass.defines.emplace_back("UNIFORM_WEIGHT", "");
    if (params.clampTaps) pass.defines.emplace_back("CLAMP_TAPS", "");
    pass.defines.emplace_back("DIRECTIONS", std::to_string(params.directions));
    pass.defines.emplace_back("STEPS", std::to_string(params.steps));
    pass.note = fmt::format("up to {} taps per pixel", params.directions * params.steps);
    graph.add(std::move(pass));
    publishOcclusion(graph, inputs, result);
}

const Technique kHbao{"ao", "hbao",
    "Horizons of the depth image in a few directions around each pixel (Bavoil & Sainz).", kParams, build,
    {{"paper",
        "As published: uniform weight, a bias of 30 degrees, attenuation 1 - r², even steps, taps clamped to the "
        "border.",
        "directions = 6, steps = 6, angle_bias = 30, weight = 'uniform', step_growth = 0, falloff = 'quadratic', "
        "clamp_taps = true"}}};

}  // namespace ao_hbao
}  // namespace limn
