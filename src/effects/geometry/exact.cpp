// Visible surfaces, exact: a visibility buffer (triangle ids at raster time) and one analytic evaluation per visible
// pixel.
//
// After Burns & Hunt, "The Visibility Buffer", JCGT 2013; vertices are snapped to the rasterizer's grid in
// whole-picture pixels, and the plane of each visible triangle is intersected with the pixel's ray in double precision.
// Depth error: half an ulp of float.

#include "effects/geometry/outputs.h"

namespace limn {
namespace geometry_exact {

void build(EffectBuilder& graph, const NoParams&) {
    const ResourceId visibility =
        graph.fineImage("visibility", graph.scene().triangleBits > 0 ? Format::r32ui : Format::rg32ui);
    const ResourceId zBuffer = graph.fineImage("z_buffer", Format::depth32f);
    Pass raster;
    raster.name = "visibility";
    raster.kind = Pass::Kind::raster;
    raster.rate = graph.view().sampling.subFrames;
    raster.writes = {{"visibility", visibility}, {"zBuffer", zBuffer}};
    raster.needs = SceneData::positions;
    if (graph.scene().polygons) raster.needs = raster.needs | SceneData::coincidence;
    raster.note = "triangle ids only";
    graph.cutHoles(raster);
    graph.defineSeen(raster);
    graph.add(std::move(raster));
    graph.publish(aov::visibility, visibility);

    Pass resolve;
    resolve.name = "resolve";
    resolve.reads = {{"visibility", visibility}};
    resolve.writes = publishSurfaces(graph);
    const ResourceId motion = graph.image(aov::motion);
    resolve.writes.push_back({std::string(aov::motion.name), motion, SceneData::previous});
    graph.publish(aov::motion, motion);
    const ResourceId place = graph.image(aov::surfacePlace);
    resolve.writes.push_back({std::string(aov::surfacePlace.name), place});
    graph.publish(aov::surfacePlace, place);
    resolve.defines = surfaceDefines(graph);
    graph.defineSeen(resolve);
    resolve.needs = SceneData::positions;
    resolve.note = "analytic, once per visible sample";
    graph.add(std::move(resolve));
}

const Technique kExact{"geometry", "exact",
    "Triangle ids at raster time, then exact evaluation of just what is read, once per visible sample.", {}, build};

}  // namespace geometry_exact
}  // namespace limn
