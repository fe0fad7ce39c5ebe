// A wide filter over the pixel's own plane, for the noise of a few rays: 3×3 taps, then 3×3 taps twice as far apart,
// and so on. The à-trous scheme of Dammertz et al., "Edge-Avoiding À-Trous Wavelet Transform for fast Global
// Illumination Filtering", HPG 2010, with weights by the distance to the pixel's tangent plane and by the angle between
// normals. (3×3 taps leave no more error than the scheme's 5×5 and cost 3/5 of the time: rays are spread evenly over
// 4×4 pixels, which two passes cover.)
//
// Reads ambient_occlusion, depth and normal_geometric; writes ambient_occlusion.

#include "effects/technique.h"

#include <cmath>

namespace limn {
namespace filter_plane_aware {

struct Params {
    int passes = 2;
    float step = 1;
    float angle = 25;
    float difference = 0;
};
constexpr Field kParams[] = {
    field<&Params::passes>("passes", {.min = 1, .max = 5, .accuracy = true, .keyable = false},
        "How often 3×3 taps are taken, each time twice as far apart."),
    field<&Params::step>("step", {.unit = "pixel footprints", .min = 0.01, .max = 1e6},
        "Distance from the pixel's tangent plane at which a tap no longer counts."),
    field<&Params::angle>("angle", {.unit = "degrees", .min = 1, .max = 180},
        "Angle between the normals at which a tap no longer counts."),
    field<&Params::difference>("difference", {.min = 0, .max = 1},
        "Difference in ambient occlusion at which a tap no longer counts: a little more than the noise, where many "
        "rays leave but little; 0 = any counts."),
};

struct Constants {
    float perStep = 1, perTurn = 1, perDifference = 0;
    int spacing = 1;
};
constexpr Field kConstants[] = {
    field<&Constants::perStep>("perStep", "1 over the distance, in pixel footprints, at which a tap no longer counts."),
    field<&Constants::perTurn>(
        "perTurn", "1 over the distance between the tips of normals at which a tap no longer counts, squared."),
    field<&Constants::perDifference>(
        "perDifference", "1 over the difference at which a tap no longer counts; 0: any counts."),
    field<&Constants::spacing>("spacing", {.unit = "pixels"}, "From one tap to the next."),
};

void build(EffectBuilder& graph, const Params& params) {
    const double chord = 2 * std::sin(glm::radians(static_cast<double>(params.angle)) / 2);
    // Packs the data of a tap side by side: one fetch instead of three halves the time of the passes.
    ResourceId packed = graph.image("ambient_occlusion_on_surface", Format::rgba32f);
    Pass gather;
    gather.name = "plane_aware_gather";
    gather.shader = "effects/filter/gather_surface";
    gather.reads = {{"source", graph.read(aov::ambientOcclusion)}, {"depth", graph.read(aov::depth)},
        {"normal", graph.read(aov::normalGeometric)}};
    gather.writes = {{"result", packed}};
    graph.add(std::move(gather));
    for (int i = 0; i < params.passes; ++i) {
        const int spacing = 1 << i;
        const bool last = i + 1 == params.passes;
        const ResourceId result =
            last ? graph.image(aov::ambientOcclusion) : graph.image("ambient_occlusion_on_surface", Format::rgba32f);
        Pass pass;
        pass.name = "plane_aware_" + std::to_string(i + 1);
        pass.reads = {{"surfaces", packed, spacing}};
        pass.writes = {{"result", result}};
        pass.params = paramsBlock(kConstants,
            Constants{1 / params.step, static_cast<float>(1 / (chord * chord)),
                params.difference > 0 ? 1 / params.difference : 0, spacing});
        pass.note = "9 taps per pixel";
        graph.add(std::move(pass));
        packed = result;
    }
    graph.publish(aov::ambientOcclusion, packed);
}

const Technique kPlaneAware{
    "filter", "plane_aware", "Wide, over the pixel's own plane: for the noise of a few rays.", kParams, build};

}  // namespace filter_plane_aware
}  // namespace limn
