// Ambient shading from depth alone, by how a surface bends between a pixel and its neighbours: after a paper on one
// post-processing shader for both edges and ambient shading, published in Pixel Bender and AGAL.
//
// Reads depth only. Writes ambient_occlusion_raw or edges. In both slots it writes one image, depth_tangent, which
// cannot be split and multiplies the picture. Per neighbour p = Δdepth/range, b = p·(2 − p/bleach), s = ½·max(b +
// brightness, 0), o = mean of 1/(1 + s²), result o^contrast. The check of range: b grows to `bleach` at p = bleach and
// falls again beyond.
//
// Paper mode: each of four neighbours by itself; a plane seen at a slant darkens, and flat regions are grey by
// `brightness`.
// Default mode: opposite neighbours in pairs, Δ = z − 2/(1/z₁ + 1/z₂) (orthographic: z minus their mean), which is 0 on
// every plane. Only concave places darken. Brightness 0 keeps flat regions white. Neighbours lie in several rings, so
// that edges cast no ghosts of themselves at the reach. The reach is in output units and the range in the scene's, so
// that the picture does not depend on resolution.

#include "effects/ao/occlusion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limn {
enum class TangentPairs { opposite, single };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<TangentPairs> = {"opposite", "single"};
enum class TangentNeighbours { diagonal, axial };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<TangentNeighbours> = {"diagonal", "axial"};
enum class TangentKind { raw, normalized };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<TangentKind> = {"raw", "normalized"};
enum class TangentDepth { linear, squared };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<TangentDepth> = {"linear", "squared"};
enum class TangentRange { scene, far };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<TangentRange> = {"scene", "far"};
enum class TangentBends { concave, all };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<TangentBends> = {"concave", "all"};

namespace ao_depth_tangent {

struct Params {
    PictureLength reach = PictureLength::pixels(7);
    Length range = Length::percent(2);
    TangentRange rangeIn = TangentRange::scene;
    float farShare = 0.8f;
    float contrast = 64;
    float bleach = 0.3f;
    float brightness = 0;
    TangentPairs pairs = TangentPairs::opposite;
    TangentNeighbours neighbours = TangentNeighbours::diagonal;
    int rings = 4;
    TangentKind tangent = TangentKind::raw;
    TangentDepth depth = TangentDepth::linear;
    TangentBends bends = TangentBends::concave;
    bool cut = true;
};

struct LineParams : Params {
    Color color{0, 0, 0};
    float opacity = 1;
    LineParams() {
        reach = PictureLength::pixels(1);
        range = Length::percent(0.2);
        contrast = 26;
        bleach = 1;
        rings = 1;
        bends = TangentBends::all;
        cut = false;
    }
};

constexpr Field kParams[] = {
    field<&Params::reach>("reach", {.unit = "picture", .min = 0, .max = 1000},
        "How far off the neighbours lie (the paper's r): pixels, millimetres or percent of the height."),
    field<&Params::range>("range", {.unit = "scene units", .min = 1e-9},
        "Depth that differences are measured by: smaller brings out small details."),
    field<&Params::rangeIn>("range_in", "Measure by `range`, or by a share of the far distance as the paper does."),
    field<&Params::farShare>("far_share", {.min = 1e-6, .max = 100}, "That share."),
    field<&Params::contrast>("contrast", {.min = 0, .max = 1000}, "Exponent on the result."),
    field<&Params::bleach>("bleach", {.min = 1e-6, .max = 100},
        "Difference that darkens most, as a share of the range; at twice as much nothing is left."),
    field<&Params::brightness>(
        "brightness", {.min = -10, .max = 10}, "Added to every difference: above 0 flat regions turn grey."),
    field<&Params::pairs>("pairs",
        "Compare with opposite neighbours together, so that planes are open at every tilt, or with each by itself."),
    field<&Params::neighbours>(
        "neighbours", "On the diagonals as in the paper's listing, or along the axes as in its figure."),
    field<&Params::rings>("rings", {.min = 1, .max = 16, .accuracy = true, .keyable = false},
        "How many distances up to the reach, each with neighbours between those of the last; the paper's one leaves "
        "ghosts of every edge (opposite pairs only)."),
    field<&Params::tangent>("tangent",
        "The difference itself as in the listing, or the third component of the unit tangent as in the text (single "
        "pairs only)."),
    field<&Params::depth>("depth", "Distances, or their squares as the paper packs them (single pairs only)."),
    field<&Params::bends>("bends", "What darkens: concave places alone, or convex ones too (opposite pairs only)."),
    field<&Params::cut>("cut",
        "Differences beyond the bleach lose their effect again, the paper's check of range; false: they keep the "
        "most."),
};

constexpr Field kLineFields[] = {
    field<&LineParams::color>("color", "Colour of the lines."),
    field<&LineParams::opacity>(
        "opacity", {.min = 0, .max = 1}, "How much the lines cover; at 0 they are not even computed."),
};
constexpr auto kLineParams = [] {
    std::array<Field, std::size(kParams) + std::size(kLineFields)> all{};
    std::copy(std::begin(kParams), std::end(kParams), all.begin());
    std::copy(std::begin(kLineFields), std::end(kLineFields), all.begin() + std::size(kParams));
    return all;
}();

struct Constants {
    float reach = 1;
    float perRange = 1, contrast = 1, perBleach = 1, brightness = 0;
    glm::vec2 step{0};
    float far = 1;
    glm::vec4 color{0};
};
constexpr Field kConstants[] = {
    field<&Constants::reach>("reach", {.unit = "pixels"}, "Of the farthest neighbours."),
    field<&Constants::perRange>("perRange", "1 over the range: normalized units, or their square."),
    field<&Constants::contrast>("contrast", "Exponent on the result."),
    field<&Constants::perBleach>("perBleach", "1 over the bleach."),
    field<&Constants::brightness>("brightness", "Added to every difference."),
    field<&Constants::step>(
        "step", {.unit = "picture sizes"}, "The neighbours' offset as the normalized tangent sees it."),
    field<&Constants::far>("far", {.unit = "normalized units"}, "Distance that stands for the background."),
    field<&Constants::color>("color", "Of lines: linear, premultiplied by the opacity."),
};

struct LineConstants {
    glm::vec4 color{0};
};

Constants derive(const Params& params, const View& view) {
    Constants c;
    c.reach = std::max(1.0f, static_cast<float>(view.pixels(params.reach)));
    const double range = params.rangeIn == TangentRange::far ? static_cast<double>(params.farShare) * view.far
                                                             : view.normalized(params.range);
    // The paper divides squared distances by twice the far distance squared.
    c.perRange = static_cast<float>(params.depth == TangentDepth::squared ? 1 / (2 * range * range) : 1 / range);
    c.contrast = params.contrast;
    c.perBleach = 1 / params.bleach;
    c.brightness = params.brightness;
    c.step = glm::vec2(c.reach) / glm::vec2(view.imageSize);
    c.far = static_cast<float>(view.far);
    return c;
}

/// Adds the pass under the name of its result.
ResourceId addPass(EffectBuilder& graph, const Params& params, const std::string& resultName, bool tellsAbsence,
    std::vector<std::pair<std::string, std::string>> defines = {}, const LineConstants* line = nullptr) {
    const ResourceId result = graph.image(resultName, line ? aov::edges.format : Format::r32f);
    Constants constants = derive(params, graph.view());
    if (line) constants.color = line->color;
    Pass pass;
    pass.name = "depth_tangent" + graph.layerSuffix();
    pass.shader = "effects/ao/depth_tangent";
    pass.reads = {{"depth", graph.read(aov::depth), static_cast<int>(std::ceil(constants.reach))}};
    pass.writes = {{"result", result}};
    pass.params = paramsBlock(kConstants, constants);
    pass.defines = std::move(defines);
    const auto define = [&](bool on, const char* name) {
        if (on) pass.defines.emplace_back(name, "");
    };
    define(params.pairs == TangentPairs::single, "SINGLE");
    define(params.neighbours == TangentNeighbours::axial, "AXIAL");
    define(params.tangent == TangentKind::normalized, "NORMALIZED_TANGENT");
    define(params.depth == TangentDepth::squared, "SQUARED_DEPTH");
    define(params.bends == TangentBends::all, "ALL_BENDS");
    define(params.cut, "CUT");
    define(tellsAbsence, "ABSENCE_IS_FAR");
    pass.defines.emplace_back("RINGS", std::to_string(params.rings));
    pass.note = params.pairs == TangentPairs::single ? "4 neighbours per pixel"
                                                     : std::to_string(4 * params.rings) + " neighbours per pixel";
    if (line)
        if (const auto below = graph.find(aov::edges)) {
            pass.reads.push_back({"layersBelow", *below});
            pass.defines.emplace_back("LAYERS_BELOW", "");
        }
    graph.add(std::move(pass));
    return result;
}

// The technique stands in two slots; where both are filled they share one image.
extern const Technique kDepthTangent, kDepthTangentLines;

void build(EffectBuilder& graph, const Params& params) {
    graph.useEverySample();  // its occlusion is as sharp as lines
    if (const auto* lines = graph.chosen(kDepthTangentLines)) {
        // Both slots share one image, so the lines' table may not set its parameters.
        const LineParams defaults;
        for (const auto& f : kLineParams)
            if (f.type().text(f.constMember(lines->params.get())) != f.type().text(f.constMember(&defaults)))
                throw Error(ExitCode::usage, {},
                    fmt::format("depth_tangent stands in [ao] and in [[edges]], as one image, but [[edges]] sets '{}' "
                                "for itself",
                        f.name),
                    "leave its settings to [ao]");
        Params both = params;
        both.bends = TangentBends::all;
        graph.publish(aov::depthTangent, addPass(graph, both, "depth_tangent", true));
        return;
    }
    const ResourceId result = addPass(graph, params, "ambient_occlusion_raw", false);
    graph.publish(aov::ambientOcclusionRaw, result);
    graph.publish(aov::ambientOcclusion, result);
}

void buildLines(EffectBuilder& graph, const LineParams& params) {
    if (graph.chosen(kDepthTangent) || params.opacity <= 0) return;
    const LineConstants line{glm::vec4(params.color.r, params.color.g, params.color.b, 1) * params.opacity};
    graph.publish(aov::edges, addPass(graph, params, "edges" + graph.layerSuffix(), true, {{"AS_LINES", ""}}, &line));
}

const Technique kDepthTangent{"ao", "depth_tangent",
    "How surfaces bend between a pixel and its neighbours, from depth alone.", kParams, build,
    {{"paper", "As published, for ambient shading: contrast 64, r 7, bleach 0.05, brightness 0.1.",
         "reach = '7px', range_in = 'far', far_share = 0.8, contrast = 64, bleach = 0.05, brightness = 0.1, pairs = "
         "'single', rings = 1, neighbours = 'diagonal', tangent = 'raw'"},
        {"paper_edges", "As published, for edges: contrast 26, r 1, bleach 1, brightness 0.",
            "reach = '1px', range_in = 'far', far_share = 0.8, contrast = 26, bleach = 1, brightness = 0, pairs = "
            "'single', rings = 1, neighbours = 'diagonal', tangent = 'raw'"},
        {"paper_both", "The real-time settings for both at once: r 1.5 and a low brightness.",
            "reach = '1.5px', range_in = 'far', far_share = 0.8, contrast = 3, bleach = 0.3, brightness = 0.2, pairs = "
            "'single', rings = 1, neighbours = 'diagonal', tangent = 'raw'"},
        {"paper_real_time",
            "The real-time settings for ambient shading: r 5, bleach 0.3, brightness 1, contrast 30 read as an "
            "exponent of 3.",
            "reach = '5px', range_in = 'far', far_share = 0.8, contrast = 3, bleach = 0.3, brightness = 1, pairs = "
            "'single', rings = 1, neighbours = 'diagonal', tangent = 'raw'"}}};

const Technique kDepthTangentLines{"edges", "depth_tangent",
    "Lines where the depth image bends, from depth alone; with ao = \"depth_tangent\" both in one pass.", kLineParams,
    buildLines,
    {{"paper", "As published, for edges: contrast 26, r 1, bleach 1, brightness 0.",
         "reach = '1px', range_in = 'far', far_share = 0.8, contrast = 26, bleach = 1, brightness = 0, pairs = "
         "'single', rings = 1, neighbours = 'diagonal', tangent = 'raw', bends = 'concave', cut = true"},
        {"paper_real_time",
            "The real-time settings for edges: r 1, bleach 0.2, brightness 0.5, contrast 30 read as an exponent of 3.",
            "reach = '1px', range_in = 'far', far_share = 0.8, contrast = 3, bleach = 0.2, brightness = 0.5, pairs = "
            "'single', rings = 1, neighbours = 'diagonal', tangent = 'raw', bends = 'concave', cut = true"}}};

}  // namespace ao_depth_tangent
}  // namespace limn
