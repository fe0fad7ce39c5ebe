// Visible surfaces, fast: a classic G-buffer through the hardware's interpolators (Saito & Takahashi, SIGGRAPH 1990).
//
// No second pass over the pixels, but every attribute is computed for hidden fragments too; depth is right to about
// 4e-7, and the picture depends on how the driver interpolates.

#include "effects/geometry/outputs.h"

namespace limn {
namespace geometry_fast {

void build(EffectBuilder& graph, const NoParams&) {
    Pass raster;
    raster.name = "gbuffer";
    raster.kind = Pass::Kind::raster;
    raster.isTiedToCanvas = true;
    raster.writes = publishSurfaces(graph);
    raster.writes.push_back({"zBuffer", graph.image("z_buffer", Format::depth32f)});
    raster.defines = surfaceDefines(graph);
    raster.needs = SceneData::positions | SceneData::unifiedVertices;
    graph.cutHoles(raster);
    raster.note = "interpolated by the hardware";
    graph.add(std::move(raster));
}

const Technique kFast{"geometry", "fast", "Attributes interpolated by the hardware: the classic G-buffer.", {}, build};

}  // namespace geometry_fast
}  // namespace limn
