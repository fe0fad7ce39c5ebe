// Lines where depth or normals jump: pass 5 of Lajzer & Nottingham. Drawings also need lines of objects, materials and
// sections.
//
// Each pixel is compared with its neighbours at the right and above. Where they differ, the visible triangles give the
// exact place where a surface ends or two planes meet. So lines are as straight as the edges behind them. Reads depth
// and geometric normals, and on demand shading normals, ids and line records. Writes edges: the lines in their colours,
// premultiplied, over those of the layers before.
//
// Paper mode: |Δdepth| > 0.05·(1 − depth) on the standard post-projection depth, N·N' < 0.95. (The paper compares with
// eight neighbours, which draws lines two pixels wide and no other width.)
// Default mode: one surface ends in front of another where the nearer point lies above the other's tangent plane and
// the farther below. On a bent surface both lie on one side, so neither tilt nor curvature draws a false line, and a
// step may be a fraction of a pixel high.

#include "effects/edges/marks.h"
#include "effects/edges/stroke.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace limn {
enum class DepthTest { plane, projected };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<DepthTest> = {"plane", "projected"};

namespace edges_depth_normal {

struct Params {
    PictureLength width = PictureLength::pixels(2);
    Color color{0.0103f, 0.0103f, 0.0103f};  // #1a1a1a
    float opacity = 1;
    PerSource<float> weights = standardWeights();
    PerSource<OptionalColor> colors;
    float step = 0.5f;
    float creaseAngle = 40;
    LineSide side = LineSide::both;
    float fade = 0, taper = 0;
    Length fadeFrom = Length::units(0), fadeTo = Length::percent(100);
    DepthTest depthTest = DepthTest::plane;
    float depthThreshold = 0.05f;
};

template <std::size_t... I>
constexpr auto weightFields(std::index_sequence<I...>) {
    constexpr FieldInfo info{.unit = "widths", .min = 0, .max = 100};
    return std::array{elementField<&Params::weights, I>(kLineSources[I].name, info, kLineSources[I].doc)...};
}

template <std::size_t... I>
constexpr auto colorFields(std::index_sequence<I...>) {
    return std::array{elementField<&Params::colors, I>(kLineSources[I].colorName, {}, kLineSources[I].colorDoc)...};
}

constexpr auto kSources = std::make_index_sequence<kLineSourceCount>();
constexpr std::array kLook = {
    field<&Params::width>("width", {.unit = "picture", .min = 0, .max = 1000},
        "Width of the lines: pixels, \"0.35mm\" or \"0.2%\" of the image height."),
    field<&Params::color>("color", "Colour of the lines."),
    field<&Params::opacity>(
        "opacity", {.min = 0, .max = 1}, "How much the lines cover; at 0 they are not even computed."),
};
constexpr std::array kRest = {
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
constexpr auto kParams = joinFields(kLook, weightFields(kSources), colorFields(kSources), kRest);

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
    // Our own near distance is far too small for a meaningful projected depth. Programs of the paper's time used a
    // 256th of the far distance.
    c.near = static_cast<float>(std::max(view.near, view.far / 256));
    return c;
}

Stroke strokeOf(const Params& params, const View& view, const SceneFacts& scene) {
    Stroke stroke;
    for (std::size_t i = 0; i < kLineSourceCount; ++i) {
        if ((kLineSources[i].only == LineSource::Only::cutOpen && !scene.sections)
            || (kLineSources[i].only == LineSource::Only::withMarks && !scene.marks))
            continue;
        stroke.styles[i] = {view.pixels(params.width) * static_cast<double>(params.weights[i]),
            params.colors[i].otherwise(params.color)};
    }
    stroke.opacity = params.opacity;
    stroke.side = params.side;
    stroke.fade = static_cast<double>(params.fade);
    stroke.taper = static_cast<double>(params.taper);
    stroke.fadeFrom = view.normalized(params.fadeFrom);
    stroke.fadeTo = view.normalized(params.fadeTo);
    return stroke;
}

void build(EffectBuilder& graph, const Params& params) {
    const Stroke stroke = strokeOf(params, graph.view(), graph.scene());
    if (params.opacity <= 0 || stroke.widest() <= 0) return;
    const ResourceId sides = graph.image("line_sides" + graph.layerSuffix(), Format::r32ui);
    Pass pass;
    pass.name = "depth_normal" + graph.layerSuffix();
    pass.rate = lineRate(graph);
    pass.reads = {{"depth", graph.read(aov::depth), 1}, {"normalGeometric", graph.read(aov::normalGeometric), 1}};
    defineSources(pass);
    for (std::size_t i = 0; i < kLineSourceCount; ++i) {
        const LineSource& source = kLineSources[i];
        if (stroke.styles[i].width <= 0) continue;
        pass.defines.emplace_back(fmt::format("WITH_{}", source.define), "");
        if (source.compares) pass.reads.push_back({std::string(source.sampler), graph.read(*source.compares), 1});
    }
    const bool cuts = graph.scene().sections && stroke.styles[lineSource("SECTION")].width > 0;
    if (cuts && stroke.styles[lineSource("MATERIAL")].width <= 0)
        pass.reads.push_back({"materialId", graph.read(aov::materialId), 1});
    if (graph.scene().lineRecords) {
        pass.defines.emplace_back("WITH_RECORDS", "");
        pass.reads.push_back({"lineRecord", graph.read(aov::lineRecord), 1});
        pass.needs = SceneData::positions;  // records are in the scene's words
    }
    if (params.depthTest == DepthTest::projected) pass.defines.emplace_back("PROJECTED_DEPTH", "");
    pass.writes = {{"result", sides}};
    pass.params = paramsBlock(kConstants, derive(params, graph.view()));
    pass.note = "2 neighbours per pixel";
    graph.add(std::move(pass));
    std::vector<ResourceId> marks;
    if (graph.scene().marks)
        for (const ResourceId image : placeMarks(graph, stroke, lineRate(graph))) marks.push_back(image);
    strokeLines(graph, sides, stroke, marks);
}

const Technique kDepthNormal{"edges", "depth_normal",
    "Lines where surfaces end, bend, or belong to something else (Lajzer & Nottingham).", kParams, build,
    {{"paper", "As published: projected depth, normals more than 18 degrees apart, black lines two pixels wide.",
        "width = '2px', color = '#000000', crease_angle = 18.1949, depth_test = 'projected', depth_threshold = 0.05"}}};

}  // namespace edges_depth_normal
}  // namespace limn
