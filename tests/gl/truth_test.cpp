// Analytic truth through the whole pipeline: what a plane, a sphere and a wall must look like.

#include "settings/color.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace limn::test {
namespace {

/// A parallelogram through (0, 0, −z), leaning away by `slope` (tangent of the tilt), just large enough to fill the
/// view. The steepest is 59.8 degrees.
std::string leaningPlane(double z, double slope) {
    // Corners are short binary fractions of z: uploading them as floats loses nothing, and what is measured is the
    // renderer's own error. Nearer than the eye the plane stays below it: v from −1/(2·slope) keeps it in front.
    const double down = slope > 0.75 ? 0.25 : 1, across = 1;
    const auto at = [&](double u, double v) { return glm::dvec3(u * across * z, v * z, -z - v * slope * z); };
    return quadObj(at(-1, -down), at(1, -down), at(1, 1), at(-1, 1));
}

double worstDepthError(const char* accuracy, double z, double slope) {
    const LoadedScene scene =
        makeScene("[[mesh]]\nname = 'p'\nfile = 'p.obj'\n" + cameraToml({0, 0, 0}, {0, 0, -z}, "fov = 40"),
            {{"p.obj", leaningPlane(z, slope)}});
    const RenderConfig config = makeConfig(
        fmt::format("accuracy = '{}'\n[image]\nsize = [160, 120]\nsamples = 1\n[output]\naovs = ['depth']", accuracy));
    const Picture picture = draw(config, scene);
    const Image& depth = picture.aov("depth");
    double worst = 0;
    const double width = 2 * std::tan(glm::radians(40.0) / 2), scale = width / 160;
    int hits = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
            const double value = *depth.at(x, y);
            if (!std::isfinite(value)) continue;
            const double ray = (60 - (y + 0.5)) * scale;
            // Depth d, height d·ray: d = z + slope·d·ray.
            const double truth = z / (1 - slope * ray);
            worst = std::max(worst, std::abs(value - truth) / truth);
            ++hits;
        }
    EXPECT_GT(hits, 160 * 120 / 3) << "z " << z << " slope " << slope;
    return worst;
}

// Tolerances: half an ulp of float is 6e-8; 2.5e-7 allows the ray's two float roundings besides. The interpolated depth
// adds those of the rasterizer's plane equation, which grow with the tilt.
TEST(Depth, exactEverywhere) {
    for (const double z : {0.15625, 1.0, 10.0, 100.0, 1e3, 9e3, 1e5, 1e6})
        for (const double slope : {0.0, 0.5, 1.0, 1.71875})
            EXPECT_LE(worstDepthError("exact", z, slope), 2.5e-7) << "z " << z << " slope " << slope;
}

TEST(Depth, fastUpToSixtyDegrees) {
    for (const double z : {0.15625, 1.0, 10.0, 100.0, 1e3, 9e3, 1e5, 1e6})
        for (const double slope : {0.0, 0.5, 1.0, 1.71875})
            EXPECT_LE(worstDepthError("fast", z, slope), 4e-7) << "z " << z << " slope " << slope;
}

TEST(Depth, oneGroundFromTheFeetToTheHorizon) {
    // A single quad from 0.15 to a million units: the hardest case for any arithmetic that starts at the corners.
    const LoadedScene scene =
        makeScene("[[mesh]]\nname = 'p'\nfile = 'p.obj'\n" + cameraToml({0, 0.125, 0}, {0, 0.125, -1}, "fov = 80"),
            {{"p.obj", quadObj({-1048576, 0, 0}, {1048576, 0, 0}, {1048576, 0, -1048576}, {-1048576, 0, -1048576})}});
    const Picture picture =
        draw(makeConfig("[image]\nsize = [64, 2048]\nsamples = 1\n[output]\naovs = ['depth']"), scene);
    const double scale = 2 * std::tan(glm::radians(80.0) / 2) / 64;
    for (int y = 0; y < 2048; ++y) {
        const double value = *picture.aov("depth").at(32, y), ray = (y + 0.5 - 1024) * scale;
        if (!std::isfinite(value)) continue;
        EXPECT_NEAR(value * ray / 0.125, 1, 2.5e-7) << y;
    }
}

TEST(AmbientOcclusion, openPlaneIsOpenAtEveryTilt) {
    for (const char* lens : {"fov = 50", "orthographic_height = 4"})
        for (const double degrees : {0.0, 30.0, 60.0, 80.0, 85.0, 89.0, 89.9}) {
            const double r = glm::radians(degrees);
            const glm::dvec3 eye(0, std::cos(r) * 3, std::sin(r) * 3);
            const LoadedScene scene = makeScene("[[mesh]]\nname = 'p'\nfile = 'p.obj'\n"
                    + cameraToml(eye, {0, 0, 0}, lens, degrees < 1 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0)),
                {{"p.obj", quadObj({-40, 0, 40}, {40, 0, 40}, {40, 0, -40}, {-40, 0, -40})}});
            const Picture picture =
                draw(makeConfig("[image]\nsize = [96, 64]\nsamples = 1\n[ao]\ntechnique = 'toon_ssao'\nradius = "
                                "0.5\npoints = 32\n[output]\naovs = ['ambient_occlusion']"),
                    scene);
            const auto& pixels = picture.aov("ambient_occlusion").pixels;
            EXPECT_EQ(*std::min_element(pixels.begin(), pixels.end()), 1) << degrees << " " << lens;
        }
}

TEST(AmbientOcclusion, cornersAreDarkerThanOpenGround) {
    const LoadedScene scene =
        makeScene("[[mesh]]\nname = 'm'\nfile = 'm.obj'\n" + cameraToml({3, 4, 6}, {0, 0.5, -1}, "fov = 60"),
            {{"m.obj", mixedObj()}});
    const Picture picture = draw(makeConfig("[image]\nsize = [160, 120]\n[ao]\ntechnique = 'toon_ssao'\nradius = "
                                            "0.6\n[output]\naovs = ['ambient_occlusion']"),
        scene);
    const auto& pixels = picture.aov("ambient_occlusion").pixels;
    EXPECT_LT(*std::min_element(pixels.begin(), pixels.end()), 0.75f);
    EXPECT_EQ(*std::max_element(pixels.begin(), pixels.end()), 1.0f);
}

TEST(Outline, ofASphereIsACircleOfTheRightRadius) {
    const double distance = 4, focal = 200 / (2 * std::tan(glm::radians(45.0) / 2));
    const double radius = std::tan(std::asin(1 / distance)) * focal;  // in pixels, of the silhouette cone
    const LoadedScene scene =
        makeScene("[[mesh]]\nname = 's'\nfile = 's.obj'\n" + cameraToml({0, 0, distance}, {0, 0, 0}, "fov = 45"),
            {{"s.obj", sphereObj(1, 256)}});
    const Picture picture =
        draw(makeConfig("[image]\nsize = [200, 200]\nsamples = 16\n[[edges]]\ntechnique = 'depth_normal'\nwidth = "
                        "'2px'\ncrease_angle = 120\n[output]\naovs = ['edges', 'object_id']"),
            scene);
    double insideMost = 1e9, outsideMost = 0, sum = 0, weight = 0;
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 200; ++x) {
            const double r = std::hypot(x + 0.5 - 100, y + 0.5 - 100);
            // The mask, at pixel centres: right up to the facets' sagitta, 1e-4 of the radius.
            const bool inside = *picture.aov("object_id").at(x, y) > 0;
            if (std::abs(r - radius) > 0.02) { EXPECT_EQ(inside, r < radius) << x << "," << y; }
            const double alpha = picture.aov("edges").at(x, y)[3];
            if (alpha > 0.5) {
                insideMost = std::min(insideMost, r);
                outsideMost = std::max(outsideMost, r);
            }
            sum += alpha * r;
            weight += alpha;
        }
    EXPECT_NEAR(sum / weight, radius, 0.25) << "the line runs along the silhouette";
    EXPECT_GT(insideMost, radius - 2);  // half the width, and the pixel's own half diagonal
    EXPECT_LT(outsideMost, radius + 2);
}

TEST(Outline, groundPlaneHasNoFalseLineAtAnyGrazingAngle) {
    for (const double degrees : {0.5, 1.0, 2.0, 5.0, 15.0, 45.0, 90.0})
        for (const int samples : {1, 4}) {
            const double r = glm::radians(degrees);
            const glm::dvec3 eye(0, std::sin(r) * 10, std::cos(r) * 10);
            const LoadedScene scene = makeScene("[[mesh]]\nname = 'p'\nfile = 'p.obj'\n"
                    + cameraToml(eye, {0, 0, 0}, "fov = 30", degrees > 80 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0)),
                {{"p.obj", quadObj({-5000, 0, 5000}, {5000, 0, 5000}, {5000, 0, -5000}, {-5000, 0, -5000})}});
            const Picture picture =
                draw(makeConfig(fmt::format("[image]\nsize = [128, 512]\nsamples = {}\n[[edges]]\ntechnique = "
                                            "'depth_normal'\nwidth = '2px'\n[output]\naovs = ['edges', 'depth']",
                         samples)),
                    scene);
            int checked = 0, wrong = 0;
            for (int y = 4; y < 508; ++y)
                for (int x = 4; x < 124; ++x) {
                    bool ground = true;  // all around: the horizon itself is a true line
                    for (int dy = -3; dy <= 3; ++dy)
                        ground = ground && std::isfinite(*picture.aov("depth").at(x, y + dy));
                    if (!ground) continue;
                    ++checked;
                    wrong += picture.aov("edges").at(x, y)[3] > 0;
                }
            EXPECT_GT(checked, 10000) << degrees;
            EXPECT_EQ(wrong, 0) << degrees << " degrees, " << samples << " samples";
        }
}

TEST(Outline, aStepIsDrawnIfItIsHighEnough) {
    const auto lineLength = [](double height) {
        const LoadedScene scene =
            makeScene("[[mesh]]\nname = 'a'\nfile = 'a.obj'\n[[mesh]]\nname = 'b'\nfile = 'b.obj'\n"
                    + cameraToml({0, 0, 10}, {0, 0, 0}, "orthographic_height = 10"),
                {{"a.obj", quadObj({-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0})},
                    {"b.obj", quadObj({-2, -2, height}, {2, -2, height}, {2, 2, height}, {-2, 2, height})}});
        const Picture picture = draw(makeConfig("[image]\nsize = [100, 100]\nsamples = 1\n[[edges]]\ntechnique = "
                                                "'depth_normal'\nwidth = '2px'\nstep = 4\n[output]\naovs = ['edges']"),
            scene);
        double sum = 0;
        for (std::size_t i = 3; i < picture.aov("edges").pixels.size(); i += 4) sum += picture.aov("edges").pixels[i];
        return sum / 2;  // pixels of length at two pixels' width
    };
    // A pixel is 0.1 units wide: steps from 0.4 on are lines.
    EXPECT_EQ(lineLength(0.39), 0);
    EXPECT_NEAR(lineLength(0.41), 160, 4);
}

TEST(Outline, isAsWideAsAskedForInEveryDirection) {
    // One straight edge across the picture, the edge of a square turned about the view axis: the lines' area over their
    // length.
    const double pi = std::acos(-1.0);
    for (const double turn : {0.0, 20.0, 45.0, 70.0, 90.0}) {
        const LoadedScene scene = makeScene(
            "[[mesh]]\nname = 'q'\nfile = 'q.obj'\n[[camera]]\nposition = [0, 0, 5]\nlook_at = [0, 0, "
            "0]\northographic_height = 2\n"
                + fmt::format("[[instance]]\nmesh = 'q'\nrotate = [0, 0, {}]\n", turn),
            {{"q.obj", "v 0 -9 0\nv 18 -9 0\nv 18 9 0\nv 0 9 0\nf 1 2 3 4\n"}});
        for (const double width : {0.5, 1.0, 2.0, 3.5, 9.0, 16.0})
            for (const int samples : {1, 9}) {
                const Picture p =
                    draw(makeConfig(fmt::format("[image]\nsize = [101, 101]\nsamples = {}\n[[edges]]\ntechnique = "
                                                "'depth_normal'\nwidth = '{}px'\n[output]\naovs = ['edges']\n",
                             samples, width)),
                        scene);
                double area = 0;
                for (std::size_t i = 3; i < p.aov("edges").pixels.size(); i += 4)
                    area += static_cast<double>(p.aov("edges").pixels[i]);
                const double angle = turn * pi / 180,
                             length = 101 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
                // From corner to corner the picture's corners cut off what lies beside the diagonal.
                const double cut = turn == 45 ? width * width / 2 : 0;
                // The line runs where the edge does, to 1/256 pixel; alpha is a half float. Its ends leave the picture
                // at a slant.
                EXPECT_NEAR((area + cut) / length, width, 0.01 * width)
                    << turn << " degrees, " << samples << " samples, " << width;
            }
    }
}

TEST(BlinnPhong, isWhatItsFormulaSays) {
    // A plane tilted from a parallel view, with the sun behind the eye: N·L and N·H are both the cosine of the tilt.
    for (const double degrees : {0.0, 20.0, 50.0}) {
        const double turn = glm::radians(degrees), cosine = std::cos(turn);
        const glm::dvec3 across(9, 0, 0), up(0, 9 * cosine, 9 * std::sin(turn));
        const LoadedScene scene = makeScene(
            "[[mesh]]\nname = 'p'\nfile = 'p.obj'\n[[instance]]\nmesh = 'p'\nmaterial = 'm'\n"
            "[[material]]\nname = 'm'\ncolor = [0.2, 0.1, 0.05]\n[[light]]\ndirection = [0, 0, -1]\nintensity = 0.5\n"
                + cameraToml({0, 0, 30}, {0, 0, 0}, "orthographic_height = 2"),
            {{"p.obj", quadObj(-across - up, across - up, across + up, -across + up)}});
        const Picture p =
            draw(makeConfig("[image]\nsize = [16, 16]\nsamples = 1\n[shading]\ntechnique = 'blinn_phong'\nambient = "
                            "0.3\nexponent = 8\nspecular = 0.6\n[output]\naovs = ['beauty']\n"),
                scene);
        const double highlight = 0.5 * 0.6 * std::pow(cosine, 8), diffuse = 0.3 + 0.5 * cosine;
        const double colour[] = {0.2, 0.1, 0.05};
        // Half floats between passes keep eleven bits.
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(p.aov("beauty").at(8, 8)[c], colour[c] * diffuse + highlight, 1e-3) << degrees;
    }
}

TEST(Toon, bandsGiveAsManyValues) {
    const LoadedScene scene = makeScene("[[mesh]]\nname = 's'\nfile = 's.obj'\n[[light]]\ndirection = [-1, -1, -1]\n"
            + cameraToml({0, 0, 4}, {0, 0, 0}, "fov = 35"),
        {{"s.obj", sphereObj(1, 128)}});
    for (int bands = 2; bands <= 12; ++bands) {
        const Picture picture = draw(
            makeConfig(fmt::format("[image]\nsize = [160, 160]\nsamples = 1\n[shading]\ntechnique = 'toon'\nbands = "
                                   "{}\nambient = 0\nextra_ambient = 0\nedge_softness = 0\n[output]\naovs = ['shade']",
                bands)),
            scene);
        std::set<float> values;
        const auto& pixels = picture.aov("shade").pixels;
        for (std::size_t i = 0; i < pixels.size(); i += 4)
            if (pixels[i + 3] > 0) values.insert(pixels[i]);
        EXPECT_EQ(values.size(), static_cast<std::size_t>(bands));
    }
}

TEST(Toon, bandEdgesAreOnePixelSoft) {
    const LoadedScene scene = makeScene(
        "[[mesh]]\nname = 's'\nfile = 's.obj'\n[[light]]\ndirection = [-1, 0, 0]\n[[material]]\nname = 'white'\ncolor "
        "= '#ffffff'\n[[instance]]\nmesh = 's'\nmaterial = 'white'\n"
            + cameraToml({0, 0, 4}, {0, 0, 0}, "fov = 35"),
        {{"s.obj", sphereObj(1, 256)}});
    const Picture picture =
        draw(makeConfig("[image]\nsize = [200, 200]\nsamples = 1\n[shading]\ntechnique = 'toon'\nbands = 3\nambient = "
                        "0\nextra_ambient = 0\n[output]\naovs = ['shade']"),
            scene);
    // Along the equator, from dark to light: each of the two transitions takes at most two pixels.
    const float low = 0, middle = srgbToLinear(0.5f), high = 1;
    int between = 0;
    for (int x = 60; x < 140; ++x) {
        const float v = *picture.aov("shade").at(x, 100);
        between += std::abs(v - low) > 1e-3f && std::abs(v - middle) > 1e-3f && std::abs(v - high) > 1e-3f;
    }
    EXPECT_GE(between, 1);
    EXPECT_LE(between, 4);
}

TEST(Toon, aWallLitExactlyAtABandEdgeNeverFlips) {
    // The wall faces its light, whose strength is exactly the threshold of the third of four bands.
    const float threshold = srgbToLinear(0.5f);
    LoadedScene scene = makeScene(
        fmt::format(
            "[[mesh]]\nname = 'w'\nfile = 'w.obj'\n[[light]]\ndirection = [-2, -3, -6]\nintensity = "
            "{:.9g}\n[[material]]\nname = 'white'\ncolor = '#ffffff'\n[[instance]]\nmesh = 'w'\nmaterial = 'white'\n",
            threshold)
            + cameraToml({0, 0, 4}, {0, 0, 0}, "fov = 20"),
        {{"w.obj", [] {
              // Perpendicular to (2, 3, 6)/7: an orthogonal basis of whole numbers.
              const glm::dvec3 a(-3, -6, 4), b(6, -2, -1), origin(0);
              return quadObj(origin - 40.0 * a - 40.0 * b, origin + 40.0 * a - 40.0 * b, origin + 40.0 * a + 40.0 * b,
                  origin - 40.0 * a + 40.0 * b);
          }()}});
    const RenderConfig config = makeConfig(
        "[image]\nsize = [16, 16]\nsamples = 1\n[shading]\ntechnique = 'toon'\nbands = 4\nambient = 0\nextra_ambient = "
        "0\n[output]\naovs = ['shade']");
    const float expected = srgbToLinear(2.0f / 3);
    // 100 000 cameras all around the wall's lit side, at every roll: a low-discrepancy walk, the same every time.
    constexpr int kCameras = 100000;
    int flips = 0;
    for (int i = 0; i < kCameras; ++i) {
        const double u = std::fmod(i * 0.7548776662466927, 1.0), v = std::fmod(i * 0.5698402909980532, 1.0),
                     w = std::fmod(i * 0.6180339887498949, 1.0);
        const double azimuth = 2 * std::acos(-1.0) * u, height = 0.3 + 0.7 * v, ring = std::sqrt(1 - height * height),
                     roll = 2 * std::acos(-1.0) * w;
        const glm::dvec3 n(2.0 / 7, 3.0 / 7, 6.0 / 7), s(-3.0 / 7, 6.0 / 7, -2.0 / 7), t(-6.0 / 7, -2.0 / 7, 3.0 / 7);
        Camera& camera = scene.scene.cameras.front().base;
        camera.position = 4.0 * (height * n + ring * std::cos(azimuth) * s + ring * std::sin(azimuth) * t);
        // From 17 degrees up the wall fills the view: no horizon.
        camera.up = std::cos(roll) * s + std::sin(roll) * n;
        const RenderedFrame frame = renderer().render(config, scene, 1, {});
        for (std::size_t p = 0; p < frame.layers[0].image.pixels.size(); p += 4)
            flips += std::abs(frame.layers[0].image.pixels[p] - expected)
                > 1e-3f;  // half floats; bands lie 0.1 and more apart
    }
    EXPECT_EQ(flips, 0) << "of " << kCameras << " cameras × 256 pixels";
}

}  // namespace
}  // namespace limn::test
