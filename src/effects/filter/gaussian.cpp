// A 3×3 Gaussian, several times over: pass 3 of Lajzer & Nottingham.
//
// Reads and writes ambient_occlusion. The kernel (1 2 1)⊗(1 2 1)/16, n times, equals the binomial weights of 2n once
// along rows and once along columns: two passes of 2n + 1 taps instead of n passes of 9.

#include "effects/technique.h"

#include <fmt/format.h>

namespace limn {
namespace filter_gaussian {

struct Params {
    int iterations = 3;
};

constexpr Field kParams[] = {
    field<&Params::iterations>("iterations", {.min = 1, .max = 64, .keyable = false},
        "How often the 3×3 Gaussian is applied; n times widen it to a standard deviation of sqrt(n/2) pixels."),
};

struct Constants {
    glm::ivec2 axis{1, 0};
    float middle = 0.5f;
};
constexpr Field kConstants[] = {
    field<&Constants::axis>("axis", {.unit = "pixels"}, "From one tap to the next."),
    field<&Constants::middle>("middle", "Weight of the tap in the middle."),
};

void build(EffectBuilder& graph, const Params& params) {
    const int n = params.iterations;
    double middle = 1;  // C(2n, n)/4^n
    for (int k = 1; k <= n; ++k) middle *= (2.0 * k - 1) / (2.0 * k);
    for (const bool isLast : {false, true}) {
        const ResourceId result =
            isLast ? graph.image(aov::ambientOcclusion) : graph.image("ambient_occlusion_rows", Format::r32f);
        Pass pass;
        pass.name = isLast ? "gaussian_columns" : "gaussian_rows";
        pass.defines = {{"TAPS_BESIDE", std::to_string(n)}};
        // Columns need rows n pixels above and below the picture. Of these rows they need only the picture's columns.
        pass.reads = {{"source", graph.read(aov::ambientOcclusion), isLast ? n : 0}};
        pass.writes = {{"result", result}};
        pass.params = paramsBlock(
            kConstants, Constants{isLast ? glm::ivec2(0, 1) : glm::ivec2(1, 0), static_cast<float>(middle)});
        pass.note = fmt::format("{} taps per pixel", 2 * n + 1);
        graph.add(std::move(pass));
        graph.publish(aov::ambientOcclusion, result);
    }
}

const Technique kGaussian{"filter", "gaussian", "A 3×3 Gaussian, several times over (Lajzer & Nottingham).", kParams,
    build, {{"paper", "As published: the default.", ""}}};

}  // namespace filter_gaussian
}  // namespace limn
