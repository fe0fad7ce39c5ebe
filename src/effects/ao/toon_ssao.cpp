// Screen-space ambient occlusion of "Combining Screen-Space Ambient Occlusion and Cartoon Rendering" (Lajzer &
// Nottingham), pass 2.
//
// A few fixed points around each pixel, reflected about a random vector, are compared with the depth buffer.
// Reads depth (and, for a hemisphere, the geometric normal); writes ambient_occlusion_raw: 1 open, 0 closed, background
// 1.
//
// Departs from the paper in default mode, each time by a parameter. The points fill a hemisphere over the surface
// instead of a flat disk at the pixel's depth. Occluders beyond the radius do not count. There is no dead zone.
// Occlusion grows with the count instead of its square. A point is compared at the centre of the pixel it falls on, at
// its own height above the surface: a plane is open at every tilt.

#include "effects/technique.h"

#include <fmt/format.h>

#include <cmath>

namespace limn {
enum class ToonKernel { sphere, hemisphere };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<ToonKernel> = {"sphere", "hemisphere"};
enum class SampleDepth { pixel, point };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<SampleDepth> = {"pixel", "point"};
enum class RadiusIn { scene, image };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<RadiusIn> = {"scene", "image"};
enum class CountMapping { linear, quadratic };
template <>
inline constexpr std::array<std::string_view, 2> enumNames<CountMapping> = {"linear", "quadratic"};

namespace ao_toon_ssao {

constexpr int kMaxPoints = 64;

struct Params {
    int points = 8;
    Length radius = Length::percent(5);
    RadiusIn radiusIn = RadiusIn::scene;
    float imageRadius = 16.0f / 512;
    ToonKernel kernel = ToonKernel::hemisphere;
    SampleDepth sampleDepth = SampleDepth::point;
    bool rangeCheck = true;
    int deadZone = 0;
    CountMapping mapping = CountMapping::linear;
    float strength = 1;
};

constexpr Field kParams[] = {
    field<&Params::points>("points", {.min = 1, .max = kMaxPoints, .accuracy = true, .keyable = false},
        "Points compared per pixel and sample."),
    field<&Params::radius>("radius", {.unit = "scene units", .min = 1e-9}, "Farthest occluder that darkens a point."),
    field<&Params::radiusIn>("radius_in",
        "Measure the reach in the scene (radius) or in the picture (image_radius), as the paper does; points then keep "
        "the pixel's depth."),
    field<&Params::imageRadius>("image_radius", {.unit = "image widths", .min = 0, .max = 1},
        "Reach in the picture when radius_in = \"image\"."),
    field<&Params::kernel>("kernel", "Points all around the pixel, or only above its surface."),
    field<&Params::sampleDepth>(
        "sample_depth", "Compare the depth buffer with the pixel's own depth (the paper) or with each point's."),
    field<&Params::rangeCheck>("range_check", "Ignore occluders much nearer than the radius."),
    field<&Params::deadZone>("dead_zone", {.min = 0, .max = kMaxPoints},
        "Counts below this are not occlusion: hides what a whole sphere wrongly finds on flat surfaces."),
    field<&Params::mapping>("mapping", "How the share of hidden points becomes occlusion."),
    field<&Params::strength>(
        "strength", {.min = 0, .max = 4}, "Exponent on the result: above 1 darker, below 1 lighter."),
};

struct Constants {
    float radius = 0, radiusPixels = 0;
    int deadZone = 0;
    float strength = 1;
};

constexpr Field kConstants[] = {
    field<&Constants::radius>("radius", {.unit = "normalized units"}, "Reach in the scene."),
    field<&Constants::radiusPixels>(
        "radiusPixels", {.unit = "pixels"}, "Reach in the picture, for radius_in = \"image\"."),
    field<&Constants::deadZone>("deadZone", "Counts below this are no occlusion."),
    field<&Constants::strength>("strength", "Exponent on the result."),
};

Constants derive(const Params& params, const View& view) {
    return {static_cast<float>(view.normalized(params.radius)),
        params.imageRadius * static_cast<float>(view.imageSize.x), params.deadZone, params.strength};
}

/// GLSL that sums the macro `visit` over the kernel's points. Directions on a Fibonacci spiral and lengths in an order
/// unrelated to it, so that the few points fill the unit ball evenly.
std::string sumOverKernel(int count) {
    std::string sum;
    const double golden = std::acos(-1.0) * (3 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i) {
        const double z = 1 - 2 * (i + 0.5) / count, ring = std::sqrt(1 - z * z), angle = golden * i;
        const double volume = std::fmod((i + 0.5) * 0.6180339887498949, 1.0);
        const glm::vec3 point(glm::dvec3(ring * std::cos(angle), ring * std::sin(angle), z) * std::cbrt(volume));
        sum += fmt::format("{}visit(vec3({:.9e}, {:.9e}, {:.9e}))", i > 0 ? " + " : "", point.x, point.y, point.z);
    }
    return sum;
}

void build(EffectBuilder& graph, const Params& params) {
    const ResourceId result = graph.image(aov::ambientOcclusionRaw);
    Pass pass;
    pass.name = "toon_ssao";
    // The paper clamps taps to the picture's border.
    const int halo =
        params.radiusIn == RadiusIn::image ? 0 : graph.view().haloOf(graph.view().normalized(params.radius));
    pass.reads = {
        {"depth", graph.read(aov::depth), halo, params.radiusIn == RadiusIn::image || !graph.view().holds(halo)}};
    if (params.kernel == ToonKernel::hemisphere) pass.reads.push_back({"normal", graph.read(aov::normalGeometric)});
    graph.seedNoise(pass);
    pass.writes = {{"result", result}};
    pass.params = paramsBlock(kConstants, derive(params, graph.view()));
    const auto define = [&](bool on, const char* name) {
        if (on) pass.defines.emplace_back(name, "");
    };
    define(params.kernel == ToonKernel::hemisphere, "HEMISPHERE");
    define(params.sampleDepth == SampleDepth::point, "POINT_DEPTH");
    define(params.radiusIn == RadiusIn::image, "RADIUS_IN_IMAGE");
    define(params.rangeCheck, "RANGE_CHECK");
    define(params.mapping == CountMapping::quadratic, "QUADRATIC");
    pass.defines.emplace_back("POINT_COUNT", std::to_string(params.points));
    pass.defines.emplace_back("SUM_OVER_KERNEL(visit)", sumOverKernel(params.points));
    pass.note = std::to_string(params.points) + " points per pixel";
    graph.add(std::move(pass));
    graph.publish(aov::ambientOcclusionRaw, result);
    graph.publish(aov::ambientOcclusion, result);
}

const Technique kToonSsao{"ao", "toon_ssao",
    "A few fixed points around each pixel, compared with the depth buffer (Lajzer & Nottingham).", kParams, build,
    {{"paper", "As published: a flat disk of points, no range check, counts below 5 of 8 ignored, squared.",
        "points = 8, radius_in = 'image', image_radius = 0.03125, kernel = 'sphere', sample_depth = 'pixel', "
        "range_check = false, dead_zone = 5, mapping = 'quadratic'"}}};

}  // namespace ao_toon_ssao
}  // namespace limn
