// Ambient occlusion by visibility bitmasks: each slice through the line of sight keeps one bit per sector of its
// angles. So light also gets past the far side of thin things.
// Therrien, Levesque, Gilet, "Screen Space Indirect Lighting with Visibility Bitmask", The Visual Computer 2023.
//
// Reads depth and the geometric normal; writes ambient_occlusion_raw.
//
// Departs from the paper in default mode. Sectors hold equal shares of the cosine-weighted slice instead of equal
// angles. Two neighbouring taps on one surface also hide the sectors between them (join), so that `thickness` only
// stands for what the picture cannot show, the depth of things behind their fronts. Partly covered sectors count with
// that probability. Steps stay evenly spaced.

#include "effects/ao/occlusion.h"

#include <fmt/format.h>

#include <cmath>

namespace limn {
enum class SectorMeasure { cosine, angle };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<SectorMeasure> = {"cosine", "angle"};

namespace ao_visibility_bitmask {

struct Params {
    Length radius = Length::percent(5);
    int slices = 3;
    int steps = 8;
    float thickness = 0.03f;
    bool join = true;
    float joinWithin = 1;
    SectorMeasure sectors = SectorMeasure::cosine;
    float stepGrowth = 0;
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
    field<&Params::thickness>("thickness", {.unit = "radii", .min = 0, .max = 100},
        "How far things are taken to reach behind what is seen of them."),
    field<&Params::join>("join", "Hide what lies between neighbouring taps of one surface; reads a normal per tap."),
    field<&Params::joinWithin>("join_within", {.unit = "pixel footprints", .min = 0, .max = 100},
        "Taps are of one surface where one lies on the other's tangent plane to within this, times the square root of "
        "the step in pixels."),
    field<&Params::sectors>("sectors", "Sectors of equal cosine-weighted share, or of equal angle as in the paper."),
    field<&Params::stepGrowth>("step_growth", {.min = 0, .max = 1},
        "0: steps evenly spaced; 1: distances grow by the square, denser near the point."),
    field<&Params::falloff>("falloff",
        "How an occluder's weight falls with its distance, up to the radius: as the probability that it counts."),
    field<&Params::resolution>("resolution", {.keyable = false}, "Compute every pixel, or every second one each way."),
    field<&Params::strength>(
        "strength", {.min = 0, .max = 4}, "Exponent on the result: above 1 darker, below 1 lighter."),
};

struct Constants {
    float radius = 0, thickness = 0, joinWithin = 0, stepGrowth = 0, strength = 1;
    glm::vec2 turn{1, 0};
};
constexpr Field kConstants[] = {
    field<&Constants::radius>("radius", {.unit = "normalized units"}, "Farthest occluder."),
    field<&Constants::thickness>("thickness", {.unit = "normalized units"}, "Depth of things behind their fronts."),
    field<&Constants::joinWithin>(
        "joinWithin", {.unit = "pixel footprints"}, "How flat a surface is between two taps."),
    field<&Constants::stepGrowth>("stepGrowth", "How much denser the steps are near the point."),
    field<&Constants::strength>("strength", "Exponent on the result."),
    field<&Constants::turn>("turn", "Cosine and sine of the angle between slices."),
};

void build(EffectBuilder& graph, const Params& params) {
    const OcclusionInputs inputs = occlusionInputs(graph, params.resolution);
    const double radius = graph.view().normalized(params.radius);
    const int halo = graph.view().haloOf(radius);
    const ResourceId result = occlusionImage(graph, inputs);
    Pass pass;
    pass.name = "visibility_bitmask";
    pass.reads = {{"depth", inputs.depth, halo, !graph.view().holds(halo)},
        {"normal", inputs.normal, params.join ? halo : 0, params.join && !graph.view().holds(halo)}};
    graph.seedNoise(pass);
    pass.writes = {{"result", result}};
    const double turn = std::acos(-1.0) / params.slices;
    pass.params = paramsBlock(kConstants,
        Constants{static_cast<float>(radius), static_cast<float>(params.thickness * radius), params.joinWithin,
            params.stepGrowth, params.strength, {std::cos(turn), std::sin(turn)}});
    defineOcclusion(pass, inputs, params.falloff);
    if (params.join) pass.defines.emplace_back("JOIN", "");
    if (params.thickness > 0) pass.defines.emplace_back("THICK", "");
    if (params.sectors == SectorMeasure::angle) pass.defines.emplace_back("EQUAL_ANGLES", "");
    pass.defines.emplace_back("SLICES", std::to_string(params.slices));
    pass.defines.emplace_back("STEPS", std::to_string(params.steps));
    pass.note = fmt::format("up to {} taps per pixel", 2 * params.slices * params.steps);
    graph.add(std::move(pass));
    publishOcclusion(graph, inputs, result);
}

const Technique kVisibilityBitmask{"ao", "visibility_bitmask",
    "Bits for the sectors of slices through the line of sight, so that thin things hide no more than they do (Therrien "
    "et al.).",
    kParams, build,
    {{"paper", "As published: equal angles, and every tap a thing of one thickness.",
         "sectors = 'angle', join = false, thickness = 0.25"},
        {"fine", "Nearly converged.", "slices = 8, steps = 32"}}};

}  // namespace ao_visibility_bitmask
}  // namespace limn
