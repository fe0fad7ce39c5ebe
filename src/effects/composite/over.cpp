// The picture: lines over shaded objects over the background (Porter & Duff's "over", premultiplied).

#include "effects/technique.h"

namespace limn {
namespace composite_over {

struct Constants {
    glm::vec4 background{0};
};
constexpr Field kConstants[] = {
    field<&Constants::background>("background", "Linear, premultiplied; 0 in alpha for none."),
};

Constants derive(const Background& background) {
    const Color& color = background.color;
    return {background.transparent ? glm::vec4(0) : glm::vec4(color.r, color.g, color.b, 1)};
}

void build(EffectBuilder& graph, const NoParams&) {
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
    pass.params = paramsBlock(kConstants, derive(graph.background()));
    graph.add(std::move(pass));
    graph.publish(aov::beauty, result);
}

const Technique kOver{"composite", "over", "Lines over objects over the background.", {}, build};

}  // namespace composite_over
}  // namespace limn
