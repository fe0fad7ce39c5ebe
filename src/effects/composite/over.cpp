// The picture: lines over shaded objects over the background (Porter & Duff's "over", premultiplied).

#include "effects/technique.h"

namespace limn {
namespace composite_over {

struct Params {
    Color background{1, 1, 1};
    bool transparent = false;
};

constexpr Field kParams[] = {
    field<&Params::background>("background", "Colour where nothing is."),
    field<&Params::transparent>("transparent", "Leave the background out."),
};

struct Constants {
    glm::vec4 background{0};
};
constexpr Field kConstants[] = {
    field<&Constants::background>("background", "Linear, premultiplied; 0 in alpha for none."),
};

void build(EffectBuilder& graph, const Params& params) {
    const ResourceId result = graph.image(aov::beauty);
    Pass pass;
    pass.name = "over";
    pass.reads = {{"shade", graph.read(aov::shade)}};
    if (const auto edges = graph.find(aov::edges)) {
        pass.reads.push_back({"edges", *edges});
        pass.defines.emplace_back("WITH_EDGES", "");
    }
    if (const auto factor = graph.find(aov::depthTangent)) {
        pass.reads.push_back({"factor", *factor});
        pass.defines.emplace_back("WITH_FACTOR", "");
    }
    pass.writes = {{"result", result}};
    pass.params = paramsBlock(kConstants,
        Constants{params.transparent ? glm::vec4(0)
                                     : glm::vec4(params.background.r, params.background.g, params.background.b, 1)});
    graph.add(std::move(pass));
    graph.publish(aov::beauty, result);
}

const Technique kOver{"composite", "over", "Lines over objects over the background.", kParams, build};

}  // namespace composite_over
}  // namespace limn
