// Visible surfaces through the hardware's interpolators, under a name of their own.

#include "effects/geometry/outputs.h"

namespace limn {
namespace geometry_plain {

void build(EffectBuilder& graph, const NoParams&) {
    Pass raster;
    raster.name = "plain";
    raster.kind = Pass::Kind::raster;
    raster.isTiedToCanvas = true;
    raster.writes = publishSurfaces(graph);
    raster.writes.push_back({"zBuffer", graph.image("z_buffer", Format::depth32f)});
    raster.defines = surfaceDefines(graph);
    raster.needs = SceneData::positions | SceneData::unifiedVertices;
    graph.cutHoles(raster);
    graph.add(std::move(raster));
}

const Technique kPlain{"geometry", "plain", "Attributes interpolated by the hardware.", {}, build};

}  // namespace geometry_plain
}  // namespace limn
