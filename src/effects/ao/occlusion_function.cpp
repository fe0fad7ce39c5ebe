// Ambient occlusion by a function of depth differences: a few neighbours in the cardinal and intercardinal directions,
// each at a random distance. Schmitt, "Screen Space Ambient Occlusion", 2008.
//
// Reads depth and the geometric normal; writes ambient_occlusion_raw. Per neighbour Δ = (depth here − depth
// there)/max_distance goes through `function`: 0 where the neighbour lies behind, rising quickly where it lies in
// front, falling again where it is too far to matter. The result is 1 − the mean.
//
// Paper mode: neighbours up to a share of the picture away. Those with a normal too like the pixel's are rejected, and
// with them a card that stands parallel to a wall.
// Default mode: neighbours up to the radius' image away, more than eight of them if asked, spread evenly. Those that do
// not stand above the pixel's own plane are rejected, so that planes are open at every tilt and the card still counts.

#include "effects/ao/occlusion.h"

#include <algorithm>
#include <cmath>

namespace limn {
enum class SamePlane { plane, normals };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<SamePlane> = {"plane", "normals"};
enum class OffsetIn { scene, image };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<OffsetIn> = {"scene", "image"};

namespace ao_occlusion_function {

struct Params {
    Length radius = Length::percent(5);
    OffsetIn offsetIn = OffsetIn::scene;
    float maxOffset = 0.03f;
    float maxDistance = 1;
    int samples = 8;
    std::vector<glm::dvec2> function{{0, 0}, {0.05, 1}, {0.3, 1}, {1, 0}};
    SamePlane samePlane = SamePlane::plane;
    float sameNormal = 0.95f;
    float sameHeight = 0.01f;
    float strength = 1;
};

constexpr Field kParams[] = {
    field<&Params::radius>("radius", {.unit = "scene units", .min = 1e-9},
        "How far off neighbours lie at most, and the unit of max_distance."),
    field<&Params::offsetIn>("offset_in",
        "Neighbours up to the radius away in the scene, or up to max_offset in the picture as in the paper."),
    field<&Params::maxOffset>("max_offset", {.unit = "image widths", .min = 0, .max = 1},
        "Farthest neighbour in the picture when offset_in = \"image\"."),
    field<&Params::maxDistance>(
        "max_distance", {.unit = "radii", .min = 1e-6, .max = 1e6}, "Difference of depth at which the function ends."),
    field<&Params::samples>(
        "samples", {.min = 1, .max = 128, .accuracy = true, .keyable = false}, "Neighbours looked at."),
    field<&Params::function>(
        "function", "Points [difference, occlusion], both 0 to 1, differences rising; straight in between."),
    field<&Params::samePlane>(
        "same_plane", "Throw out neighbours in the pixel's plane, or with a normal like the pixel's as in the paper."),
    field<&Params::sameNormal>(
        "same_normal", {.min = -1, .max = 1}, "Cosine above which normals are alike (same_plane = \"normals\")."),
    field<&Params::sameHeight>("same_height", {.unit = "radii", .min = 0, .max = 1},
        "Neighbours no higher above the plane lie in it (same_plane = \"plane\")."),
    field<&Params::strength>(
        "strength", {.min = 0, .max = 4}, "Exponent on the result: above 1 darker, below 1 lighter."),
};

constexpr int kTable = 256;

struct Constants {
    std::array<glm::vec4, kTable / 4> table{};
    float radius = 0, perDistance = 1, offset = 0, sameNormal = 1, sameHeight = 0, strength = 1;
};
constexpr Field kConstants[] = {
    field<&Constants::table>("table", "The occlusion function at 256 even differences, four to a vector."),
    field<&Constants::radius>("radius", {.unit = "normalized units"}, "Farthest neighbour in the scene."),
    field<&Constants::perDistance>(
        "perDistance", "1 over the difference at which the function ends, in normalized units."),
    field<&Constants::offset>("offset", {.unit = "pixels"}, "Farthest neighbour in the picture; 0: by the radius."),
    field<&Constants::sameNormal>("sameNormal", "Cosine above which normals are alike."),
    field<&Constants::sameHeight>(
        "sameHeight", {.unit = "normalized units"}, "Height up to which a neighbour lies in the plane."),
    field<&Constants::strength>("strength", "Exponent on the result."),
};

/// The function through its control points: constant before the first and after the last.
double evaluate(const std::vector<glm::dvec2>& points, double x) {
    if (points.empty()) return 0;
    if (x <= points.front().x) return points.front().y;
    for (std::size_t i = 1; i < points.size(); ++i)
        if (x <= points[i].x) {
            const double width = points[i].x - points[i - 1].x;
            return width > 0 ? points[i - 1].y + (points[i].y - points[i - 1].y) * (x - points[i - 1].x) / width
                             : points[i].y;
        }
    return points.back().y;
}

Constants derive(const Params& params, const View& view) {
    Constants c;
    c.radius = static_cast<float>(view.normalized(params.radius));
    c.perDistance = 1 / (params.maxDistance * c.radius);
    c.offset = params.offsetIn == OffsetIn::image ? params.maxOffset * static_cast<float>(view.imageSize.x) : 0;
    c.sameNormal = params.sameNormal;
    c.sameHeight = params.sameHeight * c.radius;
    c.strength = params.strength;
    for (int i = 0; i < kTable; ++i)
        c.table[static_cast<std::size_t>(i / 4)][i % 4] =
            static_cast<float>(std::clamp(evaluate(params.function, i / (kTable - 1.0)), 0.0, 1.0));
    return c;
}

void build(EffectBuilder& graph, const Params& params) {
    for (std::size_t i = 1; i < params.function.size(); ++i)
        if (params.function[i].x < params.function[i - 1].x)
            throw Error(ExitCode::usage, {}, "the 'function' of [ao] (occlusion_function) turns back",
                "sort its points by their first number");
    const OcclusionInputs inputs = occlusionInputs(graph, Resolution::full);
    const bool inScene = params.offsetIn == OffsetIn::scene;
    const int halo = inScene ? graph.view().haloOf(graph.view().normalized(params.radius)) : 0;
    const ResourceId result = occlusionImage(graph, inputs);
    Pass pass;
    pass.name = "occlusion_function";
    pass.reads = {{"depth", inputs.depth, halo, inScene},
        {"normal", inputs.normal, params.samePlane == SamePlane::normals ? halo : 0,
            params.samePlane == SamePlane::normals && inScene}};
    graph.seedNoise(pass);
    pass.writes = {{"result", result}};
    pass.params = paramsBlock(kConstants, derive(params, graph.view()));
    defineOcclusion(pass, inputs, Falloff::none);
    if (!inScene) pass.defines.emplace_back("OFFSET_IN_IMAGE", "");
    if (params.samePlane == SamePlane::normals) pass.defines.emplace_back("COMPARE_NORMALS", "");
    pass.defines.emplace_back("SAMPLES", std::to_string(params.samples));
    pass.note = std::to_string(params.samples) + " neighbours per pixel";
    graph.add(std::move(pass));
    publishOcclusion(graph, inputs, result);
}

const Technique kOcclusionFunction{"ao", "occlusion_function",
    "Depth differences to a few neighbours, through a function that says how much each hides (Schmitt).", kParams,
    build,
    {{"paper", "As published: eight directions, offsets in the picture, neighbours with a like normal thrown out.",
        "samples = 8, offset_in = 'image', max_offset = 0.03, same_plane = 'normals', same_normal = 0.95"}}};

}  // namespace ao_occlusion_function
}  // namespace limn
