// Lines from the mesh's own edges: exact, however thin what they belong to. Visibility is Appel's quantitative
// invisibility (1967), found exactly along every edge (drawing/occluders.h); contours are those of the mesh, where
// visibility holds without tolerances (Bénard & Hertzmann 2019, "Line Drawings from 3D Models", chapter 4).
//
// Reads the scene's triangles, no image. Writes edges: the lines in their colours, premultiplied, over those of the
// layers before. Runs on the CPU, once per frame: the ink is the line's area in each pixel, so that samples would
// agree.

#include "drawing/ink.h"
#include "drawing/scene_lines.h"
#include "effects/technique.h"

#include <array>
#include <cmath>
#include <utility>

namespace limn {
namespace edges_mesh_lines {

struct SourceInfo {
    float weight;
    std::string_view doc, colorName, colorDoc;
};

/// In the order of MeshLineSource.
constexpr std::array<SourceInfo, kMeshLineSources> kSources = {{
    {1, "Weight of outlines: edges beyond which the surface turns away; at 0 there are none.", "contour_color",
        "Colour of outlines, or \"same\" as `color`."},
    {1, "Weight of lines where a surface bends.", "crease_color", "Colour of lines where a surface bends."},
    {1, "Weight of the rims of open surfaces.", "border_color", "Colour of rims."},
    {0, "Weight of lines where materials meet.", "material_color", "Colour of lines where materials meet."},
    {0, "Weight of lines where parts of a mesh meet.", "object_color", "Colour of lines where parts of a mesh meet."},
    {1, "Weight of lines where surfaces pass through one another.", "intersection_color",
        "Colour of lines where surfaces pass through one another."},
    {1, "Weight of lines that mesh files draw themselves (an OBJ's l).", "mark_color",
        "Colour of lines that mesh files draw."},
    {2, "Weight of lines around the cut faces of sections.", "section_color", "Colour of lines around cut faces."},
}};

constexpr PerMeshSource<float> standardWeights() {
    PerMeshSource<float> weights{};
    for (std::size_t i = 0; i < kMeshLineSources; ++i) weights[i] = kSources[i].weight;
    return weights;
}

struct Params {
    PictureLength width = PictureLength::pixels(2);
    Color color{0.0103f, 0.0103f, 0.0103f};  // #1a1a1a
    float opacity = 1;
    PerMeshSource<float> weights = standardWeights();
    PerMeshSource<OptionalColor> colors;
    float creaseAngle = 40;
    PictureLength dash = PictureLength::pixels(0), gap = PictureLength::pixels(0);
    int hidden = 0;
    float hiddenWeight = 0.5f;
    OptionalColor hiddenColor;
    PictureLength hiddenDash = PictureLength::pixels(6), hiddenGap = PictureLength::pixels(4);
    float fade = 0, taper = 0;
    Length fadeFrom = Length::units(0), fadeTo = Length::percent(100);
};

template <std::size_t... I>
constexpr auto weightFields(std::index_sequence<I...>) {
    constexpr FieldInfo info{.unit = "widths", .min = 0, .max = 100};
    return std::array{elementField<&Params::weights, I>(enumNames<MeshLineSource>[I], info, kSources[I].doc)...};
}

template <std::size_t... I>
constexpr auto colorFields(std::index_sequence<I...>) {
    return std::array{elementField<&Params::colors, I>(kSources[I].colorName, {}, kSources[I].colorDoc)...};
}

constexpr auto kEach = std::make_index_sequence<kMeshLineSources>();
constexpr FieldInfo kPictureLength{.unit = "picture", .min = 0, .max = 1000};
constexpr std::array kLook = {
    field<&Params::width>(
        "width", kPictureLength, "Width of the lines: pixels, \"0.35mm\" or \"0.2%\" of the image height."),
    field<&Params::color>("color", "Colour of the lines."),
    field<&Params::opacity>(
        "opacity", {.min = 0, .max = 1}, "How much the lines cover; at 0 they are not even computed."),
};
constexpr std::array kRest = {
    field<&Params::creaseAngle>(
        "crease_angle", {.unit = "degrees", .min = 0.1, .max = 180}, "Smallest angle between normals that is drawn."),
    field<&Params::dash>("dash", kPictureLength, "Length of dashes; 0: lines are whole."),
    field<&Params::gap>("gap", kPictureLength, "Length of the gaps between dashes."),
    field<&Params::hidden>("hidden", {.unit = "faces", .min = 0, .max = 1000},
        "Lines behind at most so many faces are drawn too; 0: only visible ones."),
    field<&Params::hiddenWeight>(
        "hidden_weight", {.unit = "widths", .min = 0, .max = 100}, "Factor on the weight of hidden lines."),
    field<&Params::hiddenColor>("hidden_color", "Colour of hidden lines, or \"same\" as they have where visible."),
    field<&Params::hiddenDash>("hidden_dash", kPictureLength, "Length of the dashes of hidden lines; 0: whole lines."),
    field<&Params::hiddenGap>("hidden_gap", kPictureLength, "Length of the gaps of hidden lines."),
    field<&Params::fade>("fade", {.min = 0, .max = 1}, "How much of their opacity lines lose with depth."),
    field<&Params::taper>("taper", {.min = 0, .max = 1}, "How much of their width lines lose with depth."),
    field<&Params::fadeFrom>("fade_from", {.unit = "scene units", .min = 0}, "Depth at which they begin to."),
    field<&Params::fadeTo>("fade_to", {.unit = "scene units", .min = 0}, "Depth at which they have."),
};
constexpr auto kParams = joinFields(kLook, weightFields(kEach), colorFields(kEach), kRest);

InkLook lookOf(const Params& params, const View& view) {
    InkLook look;
    for (std::size_t i = 0; i < kMeshLineSources; ++i) {
        const double width = view.pixels(params.width) * static_cast<double>(params.weights[i]);
        const Color color = params.colors[i].otherwise(params.color);
        look.visible[i] = {width, color, {view.pixels(params.dash), view.pixels(params.gap)}};
        if (params.hidden > 0)
            look.hidden[i] = {width * static_cast<double>(params.hiddenWeight), params.hiddenColor.otherwise(color),
                {view.pixels(params.hiddenDash), view.pixels(params.hiddenGap)}};
    }
    look.opacity = params.opacity;
    look.fade = static_cast<double>(params.fade);
    look.taper = static_cast<double>(params.taper);
    look.fadeFrom = view.normalized(params.fadeFrom);
    look.fadeTo = view.normalized(params.fadeTo);
    return look;
}

MeshLineRequest requestOf(const Params& params, const InkLook& look) {
    MeshLineRequest request;
    for (std::size_t i = 0; i < kMeshLineSources; ++i) request.wanted[i] = look.visible[i].width > 0;
    request.creaseCosine = std::cos(glm::radians(static_cast<double>(params.creaseAngle)));
    request.deepest = params.hidden;
    // Beyond the guard band as well: all tiles of a picture ask for the same.
    request.margin = std::ceil(look.widest() / 2 + 1) + 4;
    return request;
}

LineLayer linesOf(const View& view, const void* settings) {
    const Params& params = *static_cast<const Params*>(settings);
    const InkLook look = lookOf(params, view);
    return {requestOf(params, look), look};
}

void build(EffectBuilder& graph, const Params& params) {
    const auto [request, look] = linesOf(graph.view(), &params);
    if (graph.keepsVectors() || params.opacity <= 0 || look.widest() <= 0) return;
    const ResourceId result = graph.image("edges" + graph.layerSuffix(), aov::edges.format);
    Pass pass;
    pass.name = "mesh_lines" + graph.layerSuffix();
    pass.kind = Pass::Kind::host;
    pass.rate = graph.view().isBlurred ? kEverySample : 1;
    pass.writes = {{"result", result}};
    pass.needs = SceneData::triangles;
    for (const auto source : {MeshLineSource::contours, MeshLineSource::creases})
        if (request.wanted[static_cast<std::size_t>(source)]) pass.needs = pass.needs | SceneData::normals;
    if (graph.scene().cutouts) pass.needs = pass.needs | SceneData::uvs;
    const auto below = graph.find(aov::edges);
    if (below) pass.reads = {{"layersBelow", *below}};
    pass.work = [look = look, request = request, hasBelow = below.has_value()](HostWork& work) {
        const auto& scene = static_cast<const SceneLines&>(*work.scene.triangles);
        drawInk(scene.lines(*work.view, request), look, scene.records(), work.view->region.origin, work.part,
            hasBelow ? work.reads.data() : nullptr, work.writes[0]);
    };
    pass.note = "edges of the mesh";
    graph.add(std::move(pass));
    graph.publish(aov::edges, result);
}

const Technique kMeshLines{"edges", "mesh_lines",
    "Lines from the mesh's own edges: no dots however thin, hidden lines, and drawings as vectors.", kParams, build,
    linesOf,
    {{"iso", "Line weights of ISO 128: cut 0.7, outlines 0.35, edges 0.25, hidden 0.18 millimetres.",
        "width = '0.35mm', sections = 2, contours = 1, borders = 1, creases = 0.714, objects = 0.714, intersections = "
        "0.714, materials = 0.514, marks = 0.714, hidden_weight = 0.514, hidden_dash = '3mm', hidden_gap = '1.5mm'"}}};

}  // namespace edges_mesh_lines
}  // namespace limn
