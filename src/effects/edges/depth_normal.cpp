// Lines where depth or normal jump: pass 5 of Lajzer & Nottingham, with what drawings need beside: objects, materials,
// sections.
//
// Each pixel is compared with its neighbours at the right and above. Where they differ, the place between them where
// the surface ends, or where two planes meet, is computed from the triangles seen: lines are as straight as the edges
// they stand for. Reads depth and geometric normals, and as asked shading normals, ids, what objects say of their
// lines; writes edges: the lines in their colours, premultiplied, over those of the layers before.
//
// Paper mode: |Δdepth| > 0.05·(1 − depth) on the standard post-projection depth, N·N' < 0.95. (The paper compares with
// eight neighbours, which draws lines two pixels wide and no other width.)
// Default mode: a surface ends in front of another where each pixel's surface lies on the other side of the other's
// tangent plane: bent surfaces have both on one side, so that neither tilt nor curvature draws a false line, and the
// height of a step may be a fraction of a pixel.

#include "effects/edges/stroke.h"

#include <cmath>

namespace limn {
enum class DepthTest { plane, projected };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<DepthTest> = {"plane", "projected"};

namespace edges_depth_normal {

struct Params {
    PictureLength width = PictureLength::pixels(2);
    Color color{0.0103f, 0.0103f, 0.0103f};  // #1a1a1a
    float opacity = 1;
    float silhouettes = 1, creases = 1, objects = 0, materials = 0, sections = 2;
    OptionalColor silhouetteColor, creaseColor, objectColor, materialColor, sectionColor;
    float step = 0.5f;
    float creaseAngle = 40;
    LineSide side = LineSide::both;
    float fade = 0, taper = 0;
    Length fadeFrom = Length::units(0), fadeTo = Length::percent(100);
    DepthTest depthTest = DepthTest::plane;
    float depthThreshold = 0.05f;
};

constexpr Field kParams[] = {
    field<&Params::width>("width", {.unit = "picture", .min = 0, .max = 1000},
        "Width of the lines: pixels, \"0.35mm\" or \"0.2%\" of the image height."),
    field<&Params::color>("color", "Colour of the lines."),
    field<&Params::opacity>(
        "opacity", {.min = 0, .max = 1}, "How much the lines cover; at 0 they are not even computed."),
    field<&Params::silhouettes>("silhouettes", {.unit = "widths", .min = 0, .max = 100},
        "Weight of lines where one surface ends in front of another or of nothing; at 0 there are none."),
    field<&Params::creases>(
        "creases", {.unit = "widths", .min = 0, .max = 100}, "Weight of lines where a surface bends."),
    field<&Params::objects>(
        "objects", {.unit = "widths", .min = 0, .max = 100}, "Weight of lines where objects touch."),
    field<&Params::materials>(
        "materials", {.unit = "widths", .min = 0, .max = 100}, "Weight of lines where materials meet."),
    field<&Params::sections>(
        "sections", {.unit = "widths", .min = 0, .max = 100}, "Weight of lines around the cut faces of sections."),
    field<&Params::silhouetteColor>("silhouette_color", "Colour of those lines, or \"same\" as `color`."),
    field<&Params::creaseColor>("crease_color", "Colour of lines where a surface bends."),
    field<&Params::objectColor>("object_color", "Colour of lines where objects touch."),
    field<&Params::materialColor>("material_color", "Colour of lines where materials meet."),
    field<&Params::sectionColor>("section_color", "Colour of lines around cut faces."),
    field<&Params::step>("step", {.unit = "pixel footprints", .min = 0.05, .max = 1e6},
        "Smallest step between surfaces that is drawn, in widths of a pixel at that depth (depth_test = \"plane\")."),
    field<&Params::creaseAngle>(
        "crease_angle", {.unit = "degrees", .min = 0.1, .max = 180}, "Smallest angle between normals that is drawn."),
    field<&Params::side>("side",
        "Lines lie half on the surface that they bound and half off it (both), wholly on it (inner), or wholly off it "
        "(outer)."),
    field<&Params::fade>("fade", {.min = 0, .max = 1}, "How much of their opacity lines lose with depth."),
    field<&Params::taper>("taper", {.min = 0, .max = 1}, "How much of their width lines lose with depth."),
    field<&Params::fadeFrom>("fade_from", {.unit = "scene units", .min = 0}, "Depth at which they begin to."),
    field<&Params::fadeTo>("fade_to", {.unit = "scene units", .min = 0}, "Depth at which they have."),
    field<&Params::depthTest>(
        "depth_test", "Distances to tangent planes, or difference of projected depths as the paper does."),
    field<&Params::depthThreshold>(
        "depth_threshold", {.min = 0, .max = 1}, "Factor on (1 - depth) (depth_test = \"projected\")."),
};

struct Constants {
    float step = 4, cosine = 0.95f, depthThreshold = 0.05f, near = 0.1f, far = 100;
};
constexpr Field kConstants[] = {
    field<&Constants::step>("step", {.unit = "pixel footprints"}, "Smallest step that is drawn."),
    field<&Constants::cosine>("cosine", "Normals with a smaller cosine between them make a line."),
    field<&Constants::depthThreshold>("depthThreshold", "Factor on (1 - projected depth)."),
    field<&Constants::near>("near", {.unit = "normalized units"}, "Where the projected depth is 0."),
    field<&Constants::far>("far", {.unit = "normalized units"}, "Where the projected depth is 1."),
};

Constants derive(const Params& params, const View& view) {
    Constants c;
    c.step = params.step;
    c.cosine = static_cast<float>(std::cos(glm::radians(static_cast<double>(params.creaseAngle))));
    c.depthThreshold = params.depthThreshold;
    c.far = static_cast<float>(view.far);
    // Our own near distance is far too small for a projected depth to mean anything; a 256th of the far distance is
    // what programs of the paper's time used.
    c.near = static_cast<float>(std::max(view.near, view.far / 256));
    return c;
}

Stroke strokeOf(const Params& params, const EffectBuilder& graph) {
    const double width = graph.view().pixels(params.width);
    const auto style = [&](float weight, const OptionalColor& color) {
        return LineStyle{width * static_cast<double>(weight), color.otherwise(params.color)};
    };
    return {style(params.silhouettes, params.silhouetteColor), style(params.creases, params.creaseColor),
        style(params.objects, params.objectColor), style(params.materials, params.materialColor),
        style(graph.scene().sections ? params.sections : 0, params.sectionColor), params.opacity, params.side,
        static_cast<double>(params.fade), static_cast<double>(params.taper), graph.view().normalized(params.fadeFrom),
        graph.view().normalized(params.fadeTo)};
}

void build(EffectBuilder& graph, const Params& params) {
    const Stroke stroke = strokeOf(params, graph);
    const double widest = std::max({stroke.silhouette.width, stroke.crease.width, stroke.object.width,
        stroke.material.width, stroke.section.width});
    if (params.opacity <= 0 || widest <= 0) return;
    const ResourceId sides = graph.image("line_sides" + graph.layerSuffix(), Format::r32ui);
    Pass pass;
    pass.name = "depth_normal" + graph.layerSuffix();
    pass.rate = lineRate(graph);
    pass.reads = {{"depth", graph.read(aov::depth), 1}, {"normalGeometric", graph.read(aov::normalGeometric), 1}};
    const auto with = [&](bool wanted, const char* define, const char* sampler, const Aov& aov) {
        if (!wanted) return;
        pass.defines.emplace_back(define, "");
        pass.reads.push_back({sampler, graph.read(aov), 1});
    };
    if (stroke.silhouette.width > 0) pass.defines.emplace_back("WITH_SILHOUETTES", "");
    with(stroke.crease.width > 0, "WITH_CREASES", "normal", aov::normal);
    with(stroke.object.width > 0, "WITH_OBJECTS", "objectId", aov::objectId);
    with(stroke.material.width > 0, "WITH_MATERIALS", "materialId", aov::materialId);
    with(graph.scene().lineRecords, "WITH_RECORDS", "lineRecord", aov::lineRecord);
    if (stroke.section.width > 0) pass.defines.emplace_back("WITH_SECTIONS", "");
    if (params.depthTest == DepthTest::projected) pass.defines.emplace_back("PROJECTED_DEPTH", "");
    pass.writes = {{"result", sides}};
    pass.params = paramsBlock(kConstants, derive(params, graph.view()));
    if (graph.scene().lineRecords) pass.needs = SceneData::positions;  // they stand in the scene's words
    pass.note = "2 neighbours per pixel";
    graph.add(std::move(pass));
    strokeLines(graph, sides, stroke);
}

const Technique kDepthNormal{"edges", "depth_normal",
    "Lines where surfaces end, bend, or belong to something else (Lajzer & Nottingham).", kParams, build,
    {{"paper", "As published: projected depth, normals more than 18 degrees apart, black lines two pixels wide.",
        "width = '2px', color = '#000000', crease_angle = 18.1949, depth_test = 'projected', depth_threshold = 0.05"}}};

}  // namespace edges_depth_normal
}  // namespace limn
