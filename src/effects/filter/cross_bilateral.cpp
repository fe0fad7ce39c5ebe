// A depth-dependent Gaussian, first along rows, then along columns. Bavoil & Sainz, "Image-Space Horizon-Based Ambient
// Occlusion", 2008, after Petschnigg et al. and Eisemann & Durand (2004).
//
// Reads ambient_occlusion, depth and (by default) normal_geometric; writes ambient_occlusion. Paper mode weighs taps by
// their difference of depth, which keeps steep ground noisy; by default by their distance from the pixel's tangent
// plane.

#include "effects/technique.h"

#include <cmath>

namespace limn {
enum class BilateralBy { plane, depth };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<BilateralBy> = {"plane", "depth"};

namespace filter_cross_bilateral {

struct Params {
    int size = 15;
    BilateralBy by = BilateralBy::plane;
    float step = 2;
};
constexpr Field kParams[] = {
    field<&Params::size>("size", {.unit = "pixels", .min = 1, .max = 63, .accuracy = true, .keyable = false},
        "Taps along each row and column; the Gaussian's standard deviation is a quarter of it."),
    field<&Params::by>("by",
        "Weigh taps by their distance from the pixel's tangent plane, or by their difference of depth as in the "
        "paper."),
    field<&Params::step>("step", {.unit = "pixel footprints", .min = 0.01, .max = 1e6},
        "Distance or difference at which a tap no longer counts."),
};

struct Constants {
    std::array<glm::vec4, 16> weights{};
    float perStep = 1;
    glm::ivec2 axis{1, 0};
};
constexpr Field kConstants[] = {
    field<&Constants::weights>("weights", "The Gaussian at 0, 1, 2 … pixels, four to a vector, over its middle."),
    field<&Constants::perStep>("perStep", "1 over the distance, in pixel footprints, at which a tap no longer counts."),
    field<&Constants::axis>("axis", "Along which taps lie."),
};

void build(EffectBuilder& graph, const Params& params) {
    const int half = params.size / 2;
    Constants constants;
    constants.perStep = 1 / params.step;
    const double sigma = params.size / 4.0;
    for (int i = 0; i <= half; ++i)
        constants.weights[static_cast<std::size_t>(i / 4)][i % 4] =
            static_cast<float>(std::exp(-i * i / (2 * sigma * sigma)));
    for (const bool rows : {true, false}) {
        const ResourceId result =
            rows ? graph.image("ambient_occlusion_rows", Format::r32f) : graph.image(aov::ambientOcclusion);
        Pass pass;
        pass.name = rows ? "cross_bilateral_rows" : "cross_bilateral_columns";
        pass.shader = "effects/filter/cross_bilateral";
        pass.reads = {{"source", graph.read(aov::ambientOcclusion), half}, {"depth", graph.read(aov::depth), half}};
        if (params.by == BilateralBy::plane) {
            pass.reads.push_back({"normal", graph.read(aov::normalGeometric)});
            pass.defines.emplace_back("BY_PLANE", "");
        }
        pass.writes = {{"result", result}};
        constants.axis = rows ? glm::ivec2(1, 0) : glm::ivec2(0, 1);
        pass.params = paramsBlock(kConstants, constants);
        pass.defines.emplace_back("HALF", std::to_string(half));
        pass.note = std::to_string(2 * half + 1) + " taps per pixel";
        graph.add(std::move(pass));
        graph.publish(aov::ambientOcclusion, result);
    }
}

const Technique kCrossBilateral{"filter", "cross_bilateral",
    "A depth-dependent Gaussian along rows, then columns (Bavoil & Sainz).", kParams, build,
    {{"paper", "As published: 15×15, by depth.", "size = 15, by = 'depth', step = 8"}}};

}  // namespace filter_cross_bilateral
}  // namespace limn
