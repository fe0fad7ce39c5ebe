// What techniques make of their parameters: values worked out by hand, read from the constants that shaders get.
// Without GL.

#include "lines/sources.h"
#include "render/pipeline.h"
#include "settings/document.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>

namespace limn {
namespace {

// A scene of 3 × 4 units: its diagonal is 5, and the power of two that brings it to [1, 2) is a quarter. A radius of
// 10 % is 0.5 units, or 0.125 normalized ones. The far distance of 20 units is 5 normalized ones.
constexpr double kRadius = 0.125;
const std::vector<std::string> kParts{"seat", "leg", "back"};

SceneAt scene() {
    SceneAt at;
    at.info.bounds.add({0, 0, 0});
    at.info.bounds.add({3, 4, 0});
    at.camera.position = {1.5, 2, 10};
    at.camera.lookAt = {1.5, 2, 0};
    at.camera.far = 20;
    at.materials = {{.name = ""}, {.name = "oak"}, {.name = "steel", .shininess = 20}};
    DrawInstance chair{0, glm::dmat4(1), {1, 2}, 1, "chair", kParts, {0, 0}};
    at.instances.push_back(chair);
    at.lights.emplace_back();
    return at;
}

/// The passes of a picture of 400 × 300 pixels.
class Built {
public:
    explicit Built(const std::string& config) {
        const RenderConfig parsed = parseRenderConfig(
            parseDocument("scene = '/dev/null'\n" + config + "[image]\nsize = [400, 300]\nsamples = 1\n", "test"),
            "test");
        const SceneFacts facts = sceneFacts(scene_);
        const View view = makeView(scene_.camera, scene_.info, viewRequest(parsed, {}, 1, 0, 0));
        const Aov* wanted[] = {&aov::beauty};
        pipeline_ = buildPipeline(parsed, facts, view, wanted, 1);
    }

    const Pass& pass(const std::string& name) const {
        for (const auto& pass : pipeline_.graph.passes)
            if (pass.name == name) return pass;
        throw std::runtime_error("there is no pass " + name);
    }

    template <class T = float>
    T constant(const std::string& passName, const std::string& member, std::size_t index = 0) const {
        const UniformBlock& block = pass(passName).params;
        for (const auto& known : block.members) {
            if (known.name != member) continue;
            T value;
            if ((index + 1) * sizeof value > known.size) throw std::runtime_error(member + " is shorter than that");
            std::memcpy(&value, block.bytes.data() + known.offset + index * sizeof value, sizeof value);
            return value;
        }
        throw std::runtime_error(passName + " has no constant " + member);
    }

    std::string define(const std::string& passName, const std::string& name) const {
        for (const auto& [known, value] : pass(passName).defines)
            if (known == name) return value;
        return "not defined";
    }

private:
    SceneAt scene_ = scene();
    Pipeline pipeline_;
};

/// Shaders get floats: half an ulp, and the rounding of what they are made of.
void expectNear(double value, double expected) {
    EXPECT_NEAR(value, expected, 2e-7 * std::max(1.0, std::abs(expected)));
}

void hbao() {
    const Built b(
        "ao = { technique = 'hbao', radius = '10%', directions = 4, angle_bias = 30, step_growth = 0.25, strength = 2 "
        "}\n");
    expectNear(b.constant("hbao", "radius"), kRadius);
    expectNear(b.constant("hbao", "sinBias"), 0.5);
    expectNear(b.constant("hbao", "cosBias"), std::sqrt(0.75));
    expectNear(b.constant("hbao", "turn", 0), 0);
    expectNear(b.constant("hbao", "turn", 1), 1);
    expectNear(b.constant("hbao", "stepGrowth"), 0.25);
    expectNear(b.constant("hbao", "strength"), 2);
}

void gtao() {
    const Built b("ao = { technique = 'gtao', radius = 0.5, slices = 4, step_growth = 0.25 }\n");
    expectNear(b.constant("gtao", "radius"), kRadius);
    expectNear(b.constant("gtao", "turn", 0), std::sqrt(0.5));
    expectNear(b.constant("gtao", "turn", 1), std::sqrt(0.5));
    expectNear(b.constant("gtao", "stepGrowth"), 0.25);
}

void visibilityBitmask() {
    const Built b(
        "ao = { technique = 'visibility_bitmask', radius = '10%', slices = 2, thickness = 0.2, join_within = 3 }\n");
    expectNear(b.constant("visibility_bitmask", "radius"), kRadius);
    expectNear(b.constant("visibility_bitmask", "thickness"), 0.2 * kRadius);
    expectNear(b.constant("visibility_bitmask", "joinWithin"), 3);
    expectNear(b.constant("visibility_bitmask", "turn", 0), 0);
    expectNear(b.constant("visibility_bitmask", "turn", 1), 1);
}

void hemisphere() {
    const Built b(
        "ao = { technique = 'hemisphere', radius = '10%', points = 64, bias = 0.1, draw_in = 1, noise_size = 3, power "
        "= 2 }\n");
    expectNear(b.constant("hemisphere", "radius"), kRadius);
    expectNear(b.constant("hemisphere", "bias"), 0.1 * kRadius);
    EXPECT_EQ(b.constant<int>("hemisphere", "noiseSize"), 3);
    expectNear(b.constant("hemisphere", "power"), 2);
    double sum = 0;
    for (std::size_t i = 0; i < 64; ++i) {
        const glm::vec3 p(b.constant("hemisphere", "kernelPoints", 4 * i),
            b.constant("hemisphere", "kernelPoints", 4 * i + 1), b.constant("hemisphere", "kernelPoints", 4 * i + 2));
        EXPECT_GE(p.z, 0) << "above the surface";
        EXPECT_LE(glm::length(p), 1);
        sum += glm::length(p);
    }
    // Even lengths from 0 to 1 of a spread of 0.29: the mean of 64 lies within four of its own spreads of one half.
    EXPECT_NEAR(sum / 64, 0.5, 4 * 0.29 / 8);
    const Built drawnIn("ao = { technique = 'hemisphere', points = 64, draw_in = 0.1 }\n");
    EXPECT_LT(std::abs(drawnIn.constant("hemisphere", "kernelPoints")), 0.1001) << "the first point";
}

void occlusionFunction() {
    const Built b(
        "ao = { technique = 'occlusion_function', radius = '10%', max_distance = 2, offset_in = 'image', "
        "max_offset = 0.05, same_normal = 0.5, same_height = 0.1, function = [[0, 0], [1, 1]] }\n");
    expectNear(b.constant("occlusion_function", "radius"), kRadius);
    expectNear(b.constant("occlusion_function", "perDistance"), 1 / (2 * kRadius));
    expectNear(b.constant("occlusion_function", "offset"), 20);
    expectNear(b.constant("occlusion_function", "sameNormal"), 0.5);
    expectNear(b.constant("occlusion_function", "sameHeight"), 0.1 * kRadius);
    for (const std::size_t i : {0u, 1u, 128u, 255u})
        expectNear(b.constant("occlusion_function", "table", i), static_cast<double>(i) / 255);
    const Built standard("ao = 'occlusion_function'\n");
    expectNear(standard.constant("occlusion_function", "offset"), 0);
    expectNear(standard.constant("occlusion_function", "table", 51), 1);
    // From 1 at 0.3 to 0 at 1: half of that at 0.65, which is between entries 165 and 166.
    EXPECT_NEAR(standard.constant("occlusion_function", "table", 166), 0.5, 0.6 / 255 / 0.7);
}

void toonSsao() {
    const Built b(
        "ao = { technique = 'toon_ssao', radius = '10%', image_radius = 0.05, dead_zone = 3, strength = 2 }\n");
    expectNear(b.constant("toon_ssao", "radius"), kRadius);
    expectNear(b.constant("toon_ssao", "radiusPixels"), 20);
    EXPECT_EQ(b.constant<int>("toon_ssao", "deadZone"), 3);
    expectNear(b.constant("toon_ssao", "strength"), 2);
}

void depthTangent() {
    const Built b(
        "ao = { technique = 'depth_tangent', reach = '3px', range = '10%', contrast = 5, bleach = 0.25, brightness = "
        "0.1 }\n");
    expectNear(b.constant("depth_tangent", "reach"), 3);
    expectNear(b.constant("depth_tangent", "perRange"), 1 / kRadius);
    expectNear(b.constant("depth_tangent", "perBleach"), 4);
    expectNear(b.constant("depth_tangent", "contrast"), 5);
    expectNear(b.constant("depth_tangent", "brightness"), 0.1);
    expectNear(b.constant("depth_tangent", "step", 0), 3.0 / 400);
    expectNear(b.constant("depth_tangent", "step", 1), 3.0 / 300);
    expectNear(b.constant("depth_tangent", "far"), 5);
    // The paper divides squared distances by twice the squared range.
    const Built squared("ao = { technique = 'depth_tangent', range = '10%', depth = 'squared' }\n");
    expectNear(squared.constant("depth_tangent", "perRange"), 1 / (2 * kRadius * kRadius));
    const Built far("ao = { technique = 'depth_tangent', range_in = 'far', far_share = 0.8 }\n");
    expectNear(far.constant("depth_tangent", "perRange"), 1 / (0.8 * 5));
}

void depthTangentLines() {
    const Built b("edges = { technique = 'depth_tangent', reach = '2px', color = [0.5, 0.25, 1], opacity = 0.5 }\n");
    expectNear(b.constant("depth_tangent", "reach"), 2);
    const double expected[] = {0.25, 0.125, 0.5, 0.5};
    for (std::size_t k = 0; k < 4; ++k) expectNear(b.constant("depth_tangent", "color", k), expected[k]);
}

void rayTraced() {
    const Built b("ao = { technique = 'ray_traced', rays = 3 }\n");
    EXPECT_EQ(b.pass("ray_traced").note, "3 rays per pixel")
        << "its constants go to the CPU, which reference_test looks at";
}

std::string filtered(const std::string& filter) {
    return fmt::format("ao = {{ technique = 'hbao', filter = {{ {} }} }}\n", filter);
}

void gaussian() {
    const Built b(filtered("technique = 'gaussian', iterations = 2"));
    // Two times (1 2 1)/4 is (1 4 6 4 1)/16.
    for (const std::string name : {"gaussian_rows", "gaussian_columns"}) {
        expectNear(b.constant(name, "middle"), 6.0 / 16);
        EXPECT_EQ(b.define(name, "TAPS_BESIDE"), "2");
        EXPECT_EQ(b.constant<int>(name, "axis", 0), name == "gaussian_rows");
        EXPECT_EQ(b.constant<int>(name, "axis", 1), name == "gaussian_columns");
    }
}

void box() {
    const Built even(filtered("technique = 'box', size = 4")), odd(filtered("technique = 'box', size = 3")),
        lecture(filtered("technique = 'box', size = 4, centred = false"));
    EXPECT_EQ(even.define("box", "FIRST") + " " + even.define("box", "LAST") + even.define("box", "HALF_ENDS"), "-2 2");
    EXPECT_EQ(odd.define("box", "FIRST") + " " + odd.define("box", "LAST"), "-1 1");
    EXPECT_EQ(odd.define("box", "HALF_ENDS"), "not defined");
    EXPECT_EQ(lecture.define("box", "FIRST") + " " + lecture.define("box", "LAST"), "-2 1");
}

void crossBilateral() {
    const Built b(filtered("technique = 'cross_bilateral', size = 8, step = 4"));
    for (const std::string name : {"cross_bilateral_rows", "cross_bilateral_columns"}) {
        expectNear(b.constant(name, "perStep"), 0.25);
        expectNear(b.constant(name, "weights", 0), 1);
        expectNear(b.constant(name, "weights", 2), std::exp(-0.5));  // one standard deviation off
        EXPECT_EQ(b.define(name, "HALF"), "4");
        EXPECT_EQ(b.constant<int>(name, "axis", 0), name == "cross_bilateral_rows");
    }
}

void planeAware() {
    const Built b(filtered("technique = 'plane_aware', passes = 2, step = 0.5, angle = 60, difference = 0.25"));
    for (const int i : {1, 2}) {
        const std::string name = fmt::format("plane_aware_{}", i);
        expectNear(b.constant(name, "perStep"), 2);
        expectNear(b.constant(name, "perTurn"), 1);  // the tips of two unit vectors 60 degrees apart
        expectNear(b.constant(name, "perDifference"), 4);
        EXPECT_EQ(b.constant<int>(name, "spacing"), i);
    }
    expectNear(Built(filtered("technique = 'plane_aware'")).constant("plane_aware_1", "perDifference"), 0);
}

void smartGaussian() {
    const Built b(filtered("technique = 'smart_gaussian', size = 8, step = 3, angle = 60"));
    expectNear(b.constant("smart_gaussian", "step"), 3);
    expectNear(b.constant("smart_gaussian", "cosine"), 0.5);
    expectNear(b.constant("smart_gaussian", "falloff"), 1.0 / 8);  // 1/(2·2²)
}

void toon() {
    const Built b(
        "shading = { technique = 'toon', bands = 3, ambient = 0.3, extra_ambient = 0.4, specular = 2, edge_softness = "
        "3 }\n");
    expectNear(b.constant("toon_light", "ambient"), 0.3);
    expectNear(b.constant("toon_light", "extraAmbient"), 0.4);
    expectNear(b.constant("toon_light", "specular"), 2);
    expectNear(b.constant("toon_bands", "edgeSoftness"), 3);
    EXPECT_EQ(b.define("toon_bands", "BAND_COUNT"), "3");
    // Even steps to the eye: sRGB's curve at 0, 1/2 and 1, from thresholds at 0, 1/3 and 2/3.
    const auto linear = [](double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); };
    for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_NEAR(b.constant("toon_bands", "bands", 4 * band), linear(static_cast<double>(band) / 2), 1e-6);
        EXPECT_NEAR(b.constant("toon_bands", "bands", 4 * band + 3), linear(static_cast<double>(band) / 3), 1e-6);
    }
    const Built paper("shading = { technique = 'toon', mode = 'paper' }\n");
    for (std::size_t band = 0; band < 16; ++band)  // levels above 1 too
        expectNear(paper.constant("toon_bands", "bands", 4 * band), static_cast<double>(band) / 4);
    const Built ramp("shading = { technique = 'toon', ramp = [[1, 0, 0], [0, 0.5, 0]] }\n");
    EXPECT_EQ(ramp.define("toon_bands", "BAND_COUNT"), "2");
    expectNear(ramp.constant("toon_bands", "bands", 5), 0.5);
}

void blinnPhong() {
    const Built b(
        "shading = { technique = 'blinn_phong', ambient = 0.25, exponent = 16, linear = 0.5, quadratic = 0.125 }\n");
    expectNear(b.constant("blinn_phong", "ambient"), 0.25);
    expectNear(b.constant("blinn_phong", "exponent"), 16);
    expectNear(b.constant("blinn_phong", "linear"), 0.5);
    expectNear(b.constant("blinn_phong", "quadratic"), 0.125);
}

void lambert() {
    const Built b("shading = { technique = 'lambert', ambient = 0.25, intensity = 0.5, ao_strength = 0.75 }\n");
    expectNear(b.constant("lambert", "ambient"), 0.25);
    expectNear(b.constant("lambert", "intensity"), 0.5);
    expectNear(b.constant("lambert", "ao_strength"), 0.75);
}

void clay() {
    const Built b("shading = { technique = 'clay', color = [0.5, 0.25, 1] }\n");
    const double expected[] = {0.5, 0.25, 1};
    for (std::size_t k = 0; k < 3; ++k) expectNear(b.constant("clay", "color", k), expected[k]);
}

void flat() {
    expectNear(Built("shading = { technique = 'flat', ao_strength = 0.5 }\n").constant("flat", "aoStrength"), 0.5);
}

void paper() {
    const Built b("shading = { technique = 'paper', color = [0.5, 0.25, 1], tint = 0.5, wash_color = [0, 0, 0.25] }\n");
    expectNear(b.constant("paper", "color", 1), 0.25);
    expectNear(b.constant("paper", "tint"), 0.5);
    expectNear(b.constant("paper", "wash_color", 2), 0.25);
}

void depthNormal() {
    const Built b(
        "edges = { technique = 'depth_normal', width = '3px', silhouettes = 2, creases = 0.5, step = 4, "
        "crease_angle = 60, depth_threshold = 0.1, crease_color = [1, 0, 0.5], opacity = 0.5 }\n");
    expectNear(b.constant("depth_normal", "step"), 4);
    expectNear(b.constant("depth_normal", "cosine"), 0.5);
    expectNear(b.constant("depth_normal", "depthThreshold"), 0.1);
    expectNear(b.constant("depth_normal", "far"), 5);
    expectNear(b.constant("depth_normal", "near"), 5.0 / 256);
    // Half of the width times the weight; sources that are not drawn look like the widest.
    for (const auto& [source, half] :
        {std::pair("SILHOUETTE", 3.0), std::pair("CREASE", 0.75), std::pair("OBJECT", 3.0)})
        expectNear(b.constant("stroke", "styles", 4 * lineSource(source) + 3), half);
    expectNear(b.constant("stroke", "styles", 4 * lineSource("CREASE") + 2), 0.5);
    expectNear(b.constant("stroke", "opacity"), 0.5);
    EXPECT_EQ(b.define("stroke", "WINDOW"), "4") << "half of six pixels, and one";
    const Built fading(
        "edges = { technique = 'depth_normal', fade = 0.5, taper = 0.25, fade_from = '10%', fade_to = '50%' }\n");
    expectNear(fading.constant("line_places", "fade"), 0.5);
    expectNear(fading.constant("line_places", "taper"), 0.25);
    expectNear(fading.constant("line_places", "fadeFrom"), kRadius);
    expectNear(fading.constant("line_places", "fadeScale"), 1 / (4 * kRadius));
}

void meshLines() {
    TechniqueChoice choice = defaultChoice("edges", "mesh_lines");
    applySettings(choice,
        "width = '3px', contours = 2, creases = 0.5, materials = 0, crease_angle = 60, crease_color = [1, 0, 0.5], "
        "hidden = 4, hidden_weight = 0.25, hidden_dash = '25.4mm', hidden_gap = '10%', fade = 0.5, taper = 0.25, "
        "fade_from = '10%'");
    const SceneAt at = scene();
    const RenderConfig config = parseRenderConfig(
        parseDocument("scene = '/dev/null'\n[image]\nsize = [400, 300]\ndpi = 100\n", "test"), "test");
    const View view = makeView(at.camera, at.info, viewRequest(config, {}, 1, 0, 0));
    const auto [request, look] = choice.technique->vectorLines(view, choice.at(1).get());
    const auto of = [](const auto& values, MeshLineSource source) { return values[static_cast<std::size_t>(source)]; };
    expectNear(request.creaseCosine, 0.5);
    EXPECT_EQ(request.deepest, 4);
    EXPECT_TRUE(of(request.wanted, MeshLineSource::creases));
    EXPECT_FALSE(of(request.wanted, MeshLineSource::materials));
    expectNear(of(look.visible, MeshLineSource::contours).width, 6);
    expectNear(of(look.visible, MeshLineSource::creases).width, 1.5);
    expectNear(static_cast<double>(of(look.visible, MeshLineSource::creases).color.b), 0.5);
    expectNear(of(look.hidden, MeshLineSource::contours).width, 1.5);
    expectNear(of(look.hidden, MeshLineSource::contours).dashes.dash, 100);
    expectNear(of(look.hidden, MeshLineSource::contours).dashes.gap, 30);
    expectNear(of(look.visible, MeshLineSource::contours).dashes.dash, 0);
    expectNear(look.fade, 0.5);
    expectNear(look.taper, 0.25);
    expectNear(look.fadeFrom, kRadius);
}

void laplacian() {
    const Built b("edges = { technique = 'laplacian', ids = [2], materials = ['steel'] }\n");
    // Bit n of the words stands for number n: object 2, and material 3, which counts from 1.
    EXPECT_EQ(b.constant<unsigned>("laplacian", "chosen", 0), 1u << 2);
    const auto first = static_cast<std::size_t>(b.constant<int>("laplacian", "firstMaterialWord"));
    EXPECT_EQ(b.constant<unsigned>("laplacian", "chosen", first), 1u << 3);
    const Built named("edges = { technique = 'laplacian', objects = ['l?g'] }\n");
    EXPECT_EQ(named.constant<unsigned>("laplacian", "chosen", 0), 1u << 2) << "the second part";
}

void over() {
    RenderConfig config =
        parseRenderConfig(parseDocument("scene = '/dev/null'\n[image]\nbackground = [1, 0.5, 0.25]\n", "test"), "test");
    const SceneAt at = scene();
    const View view = makeView(at.camera, at.info, viewRequest(config, {}, 1, 0, 0));
    const Aov* wanted[] = {&aov::beauty};
    for (const bool transparent : {false, true}) {
        config.image.transparent = transparent;
        const Pipeline pipeline = buildPipeline(config, sceneFacts(at), view, wanted, 1);
        std::array<float, 4> color{};
        std::memcpy(color.data(), pipeline.graph.passes.back().params.bytes.data(), sizeof color);
        EXPECT_EQ(color, transparent ? (std::array{0.0f, 0.0f, 0.0f, 0.0f}) : (std::array{1.0f, 0.5f, 0.25f, 1.0f}));
    }
}

void exact() {
    const Built b("accuracy = 'exact'\n");
    // One instance takes four of the 32 bits of a number that names it and its triangle.
    EXPECT_EQ(b.define("visibility", "TRIANGLE_BITS"), "28");
    EXPECT_EQ(b.define("resolve", "TRIANGLE_BITS"), "28");
}

void fast() {
    const Built b("accuracy = 'fast'\n");
    EXPECT_TRUE(b.pass("gbuffer").isTiedToCanvas);
    EXPECT_TRUE(has(b.pass("gbuffer").needs, SceneData::unifiedVertices));
}

const std::map<std::string, std::function<void()>> kTests{{"ao hbao", hbao}, {"ao gtao", gtao},
    {"ao visibility_bitmask", visibilityBitmask}, {"ao hemisphere", hemisphere},
    {"ao occlusion_function", occlusionFunction}, {"ao toon_ssao", toonSsao}, {"ao depth_tangent", depthTangent},
    {"ao ray_traced", rayTraced}, {"filter gaussian", gaussian}, {"filter box", box},
    {"filter cross_bilateral", crossBilateral}, {"filter plane_aware", planeAware},
    {"filter smart_gaussian", smartGaussian}, {"shading toon", toon}, {"shading blinn_phong", blinnPhong},
    {"shading lambert", lambert}, {"shading clay", clay}, {"shading flat", flat}, {"shading paper", paper},
    {"edges depth_normal", depthNormal}, {"edges mesh_lines", meshLines}, {"edges laplacian", laplacian},
    {"edges depth_tangent", depthTangentLines}, {"composite over", over}, {"geometry exact", exact},
    {"geometry fast", fast}};

class Derive : public testing::TestWithParam<const Technique*> {};
INSTANTIATE_TEST_SUITE_P(Every, Derive, testing::ValuesIn(allTechniques()),
    [](const auto& instance) { return fmt::format("{}_{}", instance.param->slot, instance.param->name); });

TEST_P(Derive, makesWhatIsWorkedOutByHand) {
    const auto known = kTests.find(fmt::format("{} {}", GetParam()->slot, GetParam()->name));
    ASSERT_NE(known, kTests.end()) << "a new technique needs values of its own here";
    known->second();
}

}  // namespace
}  // namespace limn
