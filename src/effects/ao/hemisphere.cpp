// Ambient occlusion from points in the hemisphere over each pixel, compared with the depth buffer.
// Lawonn, "Screen-Space Ambient Occlusion", lecture Computer Graphics II.
//
// Reads depth and the geometric normal; writes ambient_occlusion_raw.
//
// The kernel is the lecture's: directions from the normalized half cube and random lengths, drawn towards the centre so
// that the mean distance is about a fifth of the radius. (Its listing also stores each point before drawing it in; that
// error is left out.)
// Paper mode: kernel turned by one of 4×4 tiled vectors, points compared at their
// own depth with an absolute bias.
// Default mode: kernel turned by a low-discrepancy angle per pixel, with a bias that is a share of the radius. Points
// are compared at their own height above the surface, over the pixel they fall on, so that planes are open at every
// tilt.

#include "effects/ao/occlusion.h"

#include <cmath>
#include <random>

namespace limn {
enum class KernelTurn { perPixel, tiled };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<KernelTurn> = {"per_pixel", "tiled"};
enum class CompareAt { height, depth };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<CompareAt> = {"height", "depth"};

namespace ao_hemisphere {

constexpr int kMaxPoints = 256;

struct Params {
    Length radius = Length::percent(5);
    int points = 64;
    float bias = 0.002f;
    KernelTurn turn = KernelTurn::perPixel;
    int noiseSize = 4;
    CompareAt compareAt = CompareAt::height;
    float drawIn = 0.1f;
    bool rangeCheck = true;
    bool clampTaps = false;
    Falloff falloff = Falloff::none;
    Resolution resolution = Resolution::full;
    float power = 1;
};

constexpr Field kParams[] = {
    field<&Params::radius>("radius", {.unit = "scene units", .min = 1e-9}, "Of the hemisphere."),
    field<&Params::points>("points", {.min = 1, .max = kMaxPoints, .accuracy = true, .keyable = false},
        "Kernel size: points compared per pixel and sample."),
    field<&Params::bias>(
        "bias", {.unit = "radii", .min = 0, .max = 1}, "How much nearer than a point the surface must be to hide it."),
    field<&Params::turn>("turn",
        "Turn the kernel by another angle at every pixel, or by a small tile of vectors that repeats, as the lecture "
        "does."),
    field<&Params::noiseSize>(
        "noise_size", {.unit = "pixels", .min = 1, .max = 64, .keyable = false}, "Side of that tile."),
    field<&Params::compareAt>("compare_at",
        "Compare the surface with a point at its height above the pixel it falls on, or with the point's own depth."),
    field<&Params::drawIn>("draw_in", {.min = 0, .max = 1},
        "Length of the first points; the others grow to 1 by the square of their number. 1: not drawn in at all."),
    field<&Params::rangeCheck>("range_check", "Surfaces farther in front than the radius hide less."),
    field<&Params::clampTaps>(
        "clamp_taps", "Look no farther than the picture's border, instead of drawing a guard band."),
    field<&Params::falloff>("falloff", "How an occluder's weight falls with its distance, up to the radius."),
    field<&Params::resolution>("resolution", {.keyable = false}, "Compute every pixel, or every second one each way."),
    field<&Params::power>("power", {.min = 0, .max = 8}, "Exponent on the result: above 1 darker, below 1 lighter."),
};

struct Constants {
    std::array<glm::vec4, kMaxPoints> kernelPoints{};
    float radius = 0, bias = 0, power = 1;
    int noiseSize = 4;
};
constexpr Field kConstants[] = {
    field<&Constants::kernelPoints>("kernelPoints", "Points over the unit disk, z along the normal; in xyz."),
    field<&Constants::radius>("radius", {.unit = "normalized units"}, "Of the hemisphere."),
    field<&Constants::bias>("bias", {.unit = "normalized units"}, "How much nearer the surface must be."),
    field<&Constants::power>("power", "Exponent on the result."),
    field<&Constants::noiseSize>("noiseSize", {.unit = "pixels"}, "Side of the tile of turns."),
};

Constants derive(const Params& params, const View& view) {
    Constants c;
    c.radius = static_cast<float>(view.normalized(params.radius));
    c.bias = params.bias * c.radius;
    c.power = params.power;
    c.noiseSize = params.noiseSize;
    // mt19937 gives the same numbers everywhere; the library's distributions need not.
    std::mt19937 generator(1);
    const auto random = [&] { return static_cast<double>(generator()) * 0x1p-32; };
    for (int i = 0; i < params.points; ++i) {
        glm::dvec3 p(random() * 2 - 1, random() * 2 - 1, random());
        const double length = random(), share = static_cast<double>(i) / params.points;
        p = glm::normalize(p + glm::dvec3(0, 0, 1e-9)) * length * (params.drawIn + (1 - params.drawIn) * share * share);
        c.kernelPoints[static_cast<std::size_t>(i)] = glm::vec4(glm::vec3(p), 0);
    }
    return c;
}

void build(EffectBuilder& graph, const Params& params) {
    const OcclusionInputs inputs = occlusionInputs(graph, params.resolution);
    const ResourceId result = occlusionImage(graph, inputs);
    Pass pass;
    pass.name = "hemisphere";
    const int halo = params.clampTaps ? 0 : graph.view().haloOf(graph.view().normalized(params.radius));
    pass.reads = {
        {"depth", inputs.depth, halo, params.clampTaps || !graph.view().holds(halo)}, {"normal", inputs.normal}};
    graph.seedNoise(pass);
    pass.writes = {{"result", result}};
    pass.params = paramsBlock(kConstants, derive(params, graph.view()));
    defineOcclusion(pass, inputs, params.falloff);
    const auto define = [&](bool on, const char* name) {
        if (on) pass.defines.emplace_back(name, "");
    };
    define(params.turn == KernelTurn::tiled, "TILED_TURN");
    define(params.compareAt == CompareAt::height, "COMPARE_HEIGHT");
    define(params.rangeCheck, "RANGE_CHECK");
    define(params.clampTaps, "CLAMP_TAPS");
    pass.defines.emplace_back("POINT_COUNT", std::to_string(params.points));
    pass.note = std::to_string(params.points) + " points per pixel";
    graph.add(std::move(pass));
    publishOcclusion(graph, inputs, result);
}

const Technique kHemisphere{"ao", "hemisphere",
    "Points in the hemisphere over each pixel, compared with the depth buffer (Lawonn's lecture).", kParams, build,
    {{"paper",
        "As taught: 64 points, 4×4 tiled turns, points compared at their own depth, bias 0.025 of a radius of 1.",
        "points = 64, bias = 0.025, turn = 'tiled', noise_size = 4, compare_at = 'depth', draw_in = 0.1, range_check = "
        "true, clamp_taps = true"}}};

}  // namespace ao_hemisphere
}  // namespace limn
