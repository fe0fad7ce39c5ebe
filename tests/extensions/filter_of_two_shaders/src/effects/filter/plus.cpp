// The mean of a pixel's neighbours in its row, then of those in its column: a filter of two shaders.
//
// Reads and writes ambient_occlusion.

#include "effects/technique.h"

namespace limn {
namespace filter_plus {

void build(EffectBuilder& graph, const NoParams&) {
    for (const char* name : {"plus_rows", "plus_columns"}) {
        const ResourceId result = graph.image(std::string("ambient_occlusion_") + name, Format::r32f);
        Pass pass;
        pass.name = name;
        pass.shader = std::string("effects/filter/") + name;
        pass.reads = {{"source", graph.read(aov::ambientOcclusion), 1}};
        pass.writes = {{"result", result}};
        graph.add(std::move(pass));
        graph.publish(aov::ambientOcclusion, result);
    }
}

const Technique kPlus{"filter", "plus", "The mean of the neighbours left and right, then above and below.", {}, build};

}  // namespace filter_plus
}  // namespace limn
