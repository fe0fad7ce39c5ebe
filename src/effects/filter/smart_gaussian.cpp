// A Gaussian that leaves out other surfaces than the pixel's: the future work of Schmitt, "Screen Space Ambient
// Occlusion" (2008), after Filion & McNaughton.
//
// Reads ambient_occlusion, depth and normal_geometric; writes ambient_occlusion. A tap's weight drops to 0 where it
// lies too far off the pixel's tangent plane, or where its normal differs too much. (The text says "depth difference";
// on a tilted plane every neighbour has one.)

#include "effects/technique.h"

#include <cmath>

namespace limn {
namespace filter_smart_gaussian {

struct Params {
    int size = 7;
    float step = 2;
    float angle = 25;
};
constexpr Field kParams[] = {
    field<&Params::size>("size", {.unit = "pixels", .min = 1, .max = 31, .accuracy = true, .keyable = false},
        "Side of the square; the Gaussian's standard deviation is a quarter of it."),
    field<&Params::step>("step", {.unit = "pixel footprints", .min = 0.01, .max = 1e6},
        "Pixels farther off the pixel's tangent plane are left out."),
    field<&Params::angle>(
        "angle", {.unit = "degrees", .min = 0, .max = 180}, "Pixels whose normals differ by more are left out."),
};

struct Constants {
    float step = 2, cosine = 0.9f, falloff = 0.1f;
};
constexpr Field kConstants[] = {
    field<&Constants::step>("step", {.unit = "pixel footprints"}, "Largest distance off the plane."),
    field<&Constants::cosine>("cosine", "Smallest cosine between normals."),
    field<&Constants::falloff>("falloff", "1 / (2 sigma²)."),
};

void build(EffectBuilder& graph, const Params& params) {
    const int half = params.size / 2;
    const ResourceId result = graph.image(aov::ambientOcclusion);
    Pass pass;
    pass.name = "smart_gaussian";
    pass.reads = {{"source", graph.read(aov::ambientOcclusion), half}, {"depth", graph.read(aov::depth), half},
        {"normal", graph.read(aov::normalGeometric), half}};
    pass.writes = {{"result", result}};
    const double sigma = params.size / 4.0;
    pass.params = paramsBlock(kConstants,
        Constants{params.step, static_cast<float>(std::cos(glm::radians(static_cast<double>(params.angle)))),
            static_cast<float>(1 / (2 * sigma * sigma))});
    pass.defines = {{"HALF", std::to_string(half)}};
    pass.note = std::to_string((2 * half + 1) * (2 * half + 1)) + " taps per pixel";
    graph.add(std::move(pass));
    graph.publish(aov::ambientOcclusion, result);
}

const Technique kSmartGaussian{"filter", "smart_gaussian",
    "A Gaussian over the pixel's own surface (Schmitt, Filion & McNaughton).", kParams, build};

}  // namespace filter_smart_gaussian
}  // namespace limn
