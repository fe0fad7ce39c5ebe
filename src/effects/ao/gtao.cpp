// Ground-truth ambient occlusion: horizons in slices through the line of sight, integrated exactly with the cosine's
// weight. Jiménez, Wu, Pesce, Jarabo, "Practical Real-Time Strategies for Accurate Indirect Occlusion", SIGGRAPH 2016
// courses.
//
// Reads depth and the geometric normal; writes ambient_occlusion_raw. Everything behind the visible surface counts as
// solid: thin things hide too much (visibility_bitmask is the remedy).
//
// Departs from the paper in default mode. Radius and falloff are those of all techniques, instead of a fade over the
// outer part. An open plane is exactly open, since the slices' visible parts are divided by their values without
// occluders. There is no fudge for thin things.

#include "effects/ao/occlusion.h"

#include <fmt/format.h>

#include <cmath>

namespace limn {
namespace ao_gtao {

struct Params {
    Length radius = Length::percent(5);
    int slices = 3;
    int steps = 6;
    float stepGrowth = 0.5f;
    Falloff falloff = Falloff::none;
    Resolution resolution = Resolution::full;
    float strength = 1;
};

constexpr Field kParams[] = {
    field<&Params::radius>("radius", {.unit = "scene units", .min = 1e-9}, "Farthest occluder that darkens a point."),
    field<&Params::slices>("slices", {.min = 1, .max = 64, .accuracy = true, .keyable = false},
        "Planes through the line of sight, per pixel and sample."),
    field<&Params::steps>("steps", {.min = 1, .max = 256, .accuracy = true, .keyable = false},
        "Most depths looked at on each side of a slice."),
    field<&Params::stepGrowth>("step_growth", {.min = 0, .max = 1},
        "0: steps evenly spaced; 1: distances grow by the square, denser near the point."),
    field<&Params::falloff>("falloff", "How an occluder's weight falls with its distance, up to the radius."),
    field<&Params::resolution>("resolution", {.keyable = false}, "Compute every pixel, or every second one each way."),
    field<&Params::strength>(
        "strength", {.min = 0, .max = 4}, "Exponent on the result: above 1 darker, below 1 lighter."),
};

struct Constants {
    float radius = 0, stepGrowth = 0, strength = 1;
    glm::vec2 turn{1, 0};
};
constexpr Field kConstants[] = {
    field<&Constants::radius>("radius", {.unit = "normalized units"}, "Farthest occluder."),
    field<&Constants::stepGrowth>("stepGrowth", "How much denser the steps are near the point."),
    field<&Constants::turn>("turn", "Cosine and sine of the angle between slices."),
    field<&Constants::strength>("strength", "Exponent on the result."),
};

void build(EffectBuilder& graph, const Params& params) {
    const OcclusionInputs inputs = occlusionInputs(graph, params.resolution);
    const double radius = graph.view().normalized(params.radius);
    const ResourceId result = occlusionImage(graph, inputs);
    Pass pass;
    pass.name = "gtao";
    const int halo = graph.view().haloOf(radius);
    pass.reads = {{"depth", inputs.depth, halo, !graph.view().holds(halo)}, {"normal", inputs.normal}};
    graph.seedNoise(pass);
    pass.writes = {{"result", result}};
    const double turn = std::acos(-1.0) / params.slices;
    pass.params = paramsBlock(kConstants,
        Constants{static_cast<float>(radius), params.stepGrowth, params.strength, {std::cos(turn), std::sin(turn)}});
    defineOcclusion(pass, inputs, params.falloff);
    pass.defines.emplace_back("SLICES", std::to_string(params.slices));
    pass.defines.emplace_back("STEPS", std::to_string(params.steps));
    pass.note = fmt::format("up to {} taps per pixel", 2 * params.slices * params.steps);
    graph.add(std::move(pass));
    publishOcclusion(graph, inputs, result);
}

const Technique kGtao{"ao", "gtao",
    "Horizons in slices through the line of sight, integrated with the cosine's weight (Jiménez et al.).", kParams,
    build,
    {{"fast", "For previews, with a filter.", "slices = 1, steps = 4, resolution = 'half'"},
        {"fine", "Nearly converged.", "slices = 8, steps = 24"}}};

}  // namespace ao_gtao
}  // namespace limn
