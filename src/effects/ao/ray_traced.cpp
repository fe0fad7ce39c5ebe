// Ambient occlusion by ray tracing (Embree), from the visible surfaces' positions and geometric normals. It includes
// occluders that the camera does not see. With many rays it is the study's ground truth; with a few, and the filter
// "plane_aware", it is a technique like the others.
//
// Reads depth and normal_geometric; writes ambient_occlusion_raw and, when asked, ambient_occlusion_error. Runs on the
// CPU's threads, only for pixels that show a surface.

#include "effects/technique.h"
#include "rays/ambient_occlusion.h"

namespace limn {
namespace ao_ray_traced {

const Aov kError{"ambient_occlusion_error", Format::r32f, {"Y"}, AovKind::numbers, AovUse::mean,
    "Standard error of one sample's ambient_occlusion_raw, as the ray tracer estimates it.", "ray_traced"};

struct Params {
    Length radius = Length::percent(5);
    int rays = 4;
    Falloff falloff = Falloff::none;
};

constexpr Field kParams[] = {
    field<&Params::radius>("radius", {.unit = "scene units", .min = 1e-9}, "Farthest occluder that darkens a point."),
    field<&Params::rays>(
        "rays", {.min = 1, .max = 65536, .accuracy = true, .keyable = false}, "Rays per pixel and sample."),
    field<&Params::falloff>("falloff", "How an occluder's weight falls with its distance, up to the radius."),
};

void build(EffectBuilder& graph, const Params& params) {
    const ResourceId result = graph.image(aov::ambientOcclusionRaw), error = graph.image(kError);
    Pass pass;
    pass.name = "ray_traced";
    pass.kind = Pass::Kind::host;
    pass.reads = {{"depth", graph.read(aov::depth)}, {"normal", graph.read(aov::normalGeometric)}};
    pass.writes = {{"result", result}, {"error", error}};
    pass.needs = SceneData::rays;
    const OcclusionQuery query{graph.view().normalized(params.radius), params.falloff, params.rays};
    pass.work = [query](HostWork& work) {
        traceAmbientOcclusion(static_cast<const RayScene&>(*work.scene.rays), *work.view,
            {work.reads[0].values, work.reads[1].values}, query, work.part, work.writes[0].values,
            work.writes[1].values);
    };
    pass.note = std::to_string(params.rays) + (params.rays == 1 ? " ray per pixel" : " rays per pixel");
    graph.add(std::move(pass));
    graph.publish(aov::ambientOcclusionRaw, result);
    graph.publish(aov::ambientOcclusion, result);
    graph.publish(kError, error);
}

const Technique kRayTraced{
    "ao", "ray_traced", "Rays against the scene's triangles: the truth, at a price.", kParams, build};

}  // namespace ao_ray_traced
}  // namespace limn
