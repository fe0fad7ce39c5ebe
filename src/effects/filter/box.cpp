// The mean of a square of pixels, which removes noise that repeats in tiles of that size. Lawonn, "Screen-Space Ambient
// Occlusion", lecture.
//
// Reads and writes ambient_occlusion. Paper mode sums from −size/2 to size/2 − 1, which moves the picture by half a
// pixel; by default the square is centred, and its outer rows count half where the size is even.

#include "effects/technique.h"

namespace limn {
namespace filter_box {

struct Params {
    int size = 4;
    bool centred = true;
};
constexpr Field kParams[] = {
    field<&Params::size>("size", {.unit = "pixels", .min = 1, .max = 64, .keyable = false}, "Side of the square."),
    field<&Params::centred>(
        "centred", "Centre the square on the pixel; false: half a pixel off, as the lecture has it for even sizes."),
};

void build(EffectBuilder& graph, const Params& params) {
    const ResourceId result = graph.image(aov::ambientOcclusion);
    Pass pass;
    pass.name = "box";
    pass.reads = {{"source", graph.read(aov::ambientOcclusion), params.size / 2}};
    pass.writes = {{"result", result}};
    const bool halves = params.centred && params.size % 2 == 0;
    pass.defines = {{"FIRST", std::to_string(-(params.size / 2))},
        {"LAST", std::to_string(halves || params.size % 2 == 1 ? params.size / 2 : params.size / 2 - 1)},
        {"SIZE", std::to_string(params.size)}};
    if (halves) pass.defines.emplace_back("HALF_ENDS", "");
    pass.note = std::to_string(params.size) + "×" + std::to_string(params.size) + " pixels";
    graph.add(std::move(pass));
    graph.publish(aov::ambientOcclusion, result);
}

const Technique kBox{"filter", "box", "The mean of a square of pixels (Lawonn's lecture).", kParams, build,
    {{"paper", "As taught: 4×4, half a pixel off.", "size = 4, centred = false"}}};

}  // namespace filter_box
}  // namespace limn
