// The picture's negative.
//
// Reads and writes beauty.

#include "effects/technique.h"

namespace limn {
namespace grade_invert {

void build(EffectBuilder& graph, const NoParams&) {
    const ResourceId result = graph.image("beauty_inverted", aov::beauty.format);
    Pass pass;
    pass.name = "invert";
    pass.reads = {{"source", graph.read(aov::beauty)}};
    pass.writes = {{"result", result}};
    graph.add(std::move(pass));
    graph.publish(aov::beauty, result);
}

const Technique kInvert{"grade", "invert", "The picture's negative.", {}, build};

}  // namespace grade_invert
}  // namespace limn
