// Techniques of ambient occlusion against what they ought to find in a wedge and a corner: the truth where they weigh
// with the cosine, the analytic value of their own weighting where they do not.

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <random>

namespace limn::test {
namespace {

/// Mean openness of the floor between `from` and `to` units from the edge where it meets a plane that rises at
/// `degrees` (x < 0).
double openness(const std::string& technique, double degrees, double from, double to, const std::string& camera) {
    const double a = glm::radians(degrees);
    const glm::dvec3 up(-std::cos(a) * 100, std::sin(a) * 100, 0);
    const std::string obj = quadObj({0, 0, 100}, {100, 0, 100}, {100, 0, -100}, {0, 0, -100})
        + quadObj({up.x, up.y, 100}, {0, 0, 100}, {0, 0, -100}, {up.x, up.y, -100});
    const LoadedScene scene =
        makeScene("[[mesh]]\nname = 'p'\nfile = 'p.obj'\n[[camera]]\n" + camera, {{"p.obj", obj}});
    const Picture p =
        draw(makeConfig(fmt::format("shading = 'flat'\n[image]\nsize = [192, 128]\nsamples = 1\n[ao]\n{}\nradius = "
                                    "2\n[output]\naovs = ['ambient_occlusion', 'position']\n",
                 technique)),
            scene);
    double sum = 0;
    int count = 0;
    for (int y = 16; y < 112; ++y)
        for (int x = 0; x < 192; ++x) {
            const float* at = p.aov("position").at(x, y);
            if (std::abs(at[1]) > 1e-4 || at[0] < from || at[0] > to) continue;
            sum += *p.aov("ambient_occlusion").at(x, y);
            ++count;
        }
    EXPECT_GE(count, 90) << technique;
    return sum / count;
}

const char* kAbove = "position = [0.4, 30, 0]\nlook_at = [0.4, 0, 0]\nup = [0, 0, -1]\northographic_height = 2.4\n";
const char* kAside = "position = [5, 5, 2]\nlook_at = [0, 0.7, 0]\nfov = 60\n";

// A plane that rises at β hides (1 − cos β)/2 of a point beside its foot. At a tenth of the radius from it the sphere's
// end takes a little off: a direction ω meets the plane within R where −ω·m ≥ c = sin β · x/R, the area of a circle's
// segment cut from the disk's part beyond.
double wedgeTruth(double degrees, double x) {
    const double b = glm::radians(degrees), c = std::sin(b) * x / 2;
    constexpr int n = 2000;
    int hits = 0, all = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = (i + 0.5) * 2 / n - 1, v = (j + 0.5) * 2 / n - 1, r2 = u * u + v * v;
            if (r2 >= 1) continue;
            ++all;
            // Towards the foot is −x; m = (sin β, cos β) in (x, y) points away from the plane, towards the floor's
            // side.
            hits += -(u * std::sin(b) + std::sqrt(1 - r2) * std::cos(b)) >= c;
        }
    return 1 - static_cast<double>(hits) / all;
}

// The floor and the wall are all the depth buffer has to show, so that horizons, bits and rays all tend to the truth:
// within 0.012, which steps of a pixel and the open end of the wall account for (measured: at most 0.008).
// One column of pixels counts, which has four pixels' rays: 1024 of them find a half-space within 0.007, but 256
// within 0.017 only.
TEST(Occlusion, cosineWeightedTechniquesFindTheTruth) {
    for (const char* technique :
        {"technique = 'gtao'\nslices = 16\nsteps = 128", "technique = 'hbao'\ndirections = 32\nsteps = 128",
            "technique = 'visibility_bitmask'\nslices = 16\nsteps = 128", "technique = 'ray_traced'\nrays = 256"})
        for (const double degrees : {30.0, 45.0, 90.0}) {
            if (degrees >= 90) {
                EXPECT_NEAR(openness(technique, degrees, 0.15, 0.25, kAside), wedgeTruth(degrees, 0.2), 0.012)
                    << technique << " at " << degrees;
            } else {
                EXPECT_NEAR(openness(technique, degrees, 0.19, 0.21, kAbove), wedgeTruth(degrees, 0.2), 0.012)
                    << technique << " at " << degrees;
            }
        }
}

/// What horizons hide of a point `x` from the foot of a plane at β, counting directions alike: the mean of sin h −
/// sin(t + bias), t = 0, over the highest rise within the radius 2.
double uniformHorizons(double degrees, double x, double biasDegrees) {
    const double slope = std::tan(glm::radians(degrees)), bias = std::sin(glm::radians(biasDegrees));
    constexpr int n = 2000;
    double hidden = 0;
    for (int i = 0; i < n; ++i) {
        const double cosine = std::cos(2 * std::acos(-1.0) * (i + 0.5) / n);
        double highest = bias;
        for (double s = x; s < 2; s += 0.002) {
            const double h = (s * cosine - x) * slope;
            if (h > 0 && s * s + h * h <= 4) highest = std::max(highest, h / std::hypot(s, h));
        }
        hidden += (highest - bias) / n;
    }
    return hidden;
}

// Bavoil & Sainz count directions alike: β/π as x goes to 0, with their bias what h > t + bias leaves.
TEST(Occlusion, uniformHorizonsHideWhatTheirFormulaSays) {
    EXPECT_NEAR(uniformHorizons(45, 1e-3, 0), 0.25, 1e-3);
    for (const double bias : {0.0, 10.0, 30.0})
        for (const double degrees : {30.0, 45.0, 60.0}) {
            const std::string paper = fmt::format(
                "technique = 'hbao'\nmode = 'paper'\nangle_bias = {}\nfalloff = 'none'\ndirections = 32\nsteps = "
                "128\nclamp_taps = false",
                bias);
            EXPECT_NEAR(1 - openness(paper, degrees, 0.09, 0.11, kAbove), uniformHorizons(degrees, 0.1, bias), 0.01)
                << bias << " " << degrees;
        }
}

/// Share of points, drawn by `point` into the unit hemisphere, that lie under a plane rising at 45 degrees from a foot
/// `x` away; radius 2.
double pointsUnder(double x, const std::function<glm::dvec3(std::mt19937&)>& point) {
    std::mt19937 generator(7);
    int under = 0;
    constexpr int n = 400000;
    for (int i = 0; i < n; ++i) {
        const glm::dvec3 p = point(generator) * 2.0;
        under += p.z < p.x - x;
    }
    return static_cast<double>(under) / n;
}

// Each kernel hides the share of its own points that lie under the surface: of the 256 and 64 that there are, within a
// sixteenth root's worth of chance (two sigma of 256 points: 0.05; of 64 evenly spread ones less).
TEST(Occlusion, pointsHideTheirShare) {
    const char* camera = "position = [0.4, 30, 0]\nlook_at = [0.4, 0, 0]\nup = [0, 0, -1]\northographic_height = 5\n";
    const auto uniform = [](std::mt19937& g, double low, double high) {
        return low + (high - low) * static_cast<double>(g()) * 0x1p-32;
    };
    const double lecture = pointsUnder(0.2, [&](std::mt19937& g) {
        return glm::normalize(glm::dvec3(uniform(g, -1, 1), uniform(g, -1, 1), uniform(g, 0, 1))) * uniform(g, 0, 1);
    });
    EXPECT_NEAR(1
            - openness("technique = 'hemisphere'\npoints = 256\nbias = 0\ndraw_in = 1\nrange_check = false", 45, 0.15,
                0.25, camera),
        lecture, 0.03);
    const double ball = pointsUnder(0.2, [&](std::mt19937& g) {
        for (;;) {
            const glm::dvec3 p(uniform(g, -1, 1), uniform(g, -1, 1), uniform(g, 0, 1));
            if (glm::dot(p, p) <= 1) return p;
        }
    });
    EXPECT_NEAR(
        1 - openness("technique = 'toon_ssao'\npoints = 64\nrange_check = false", 45, 0.15, 0.25, camera), ball, 0.02);
    // With the reach in the picture a point's height says nothing: hidden is what falls beyond the slope's foot. Of a
    // ball's volume that is the cap beyond t radii, (2 - 3 t + t³) / 4. The picture is 7.5 units wide.
    constexpr double t = 0.2;
    EXPECT_NEAR(1
            - openness("technique = 'toon_ssao'\npoints = 64\nrange_check = false\nradius_in = 'image'\n"
                       "image_radius = 0.1333333",
                45, 0.15, 0.25, camera),
        (2 - 3 * t + t * t * t) / 4, 0.02);
}

/// What the occlusion function f(Δ) = Δ, with Δ in radii of 2, hides of flat ground: the mean height of neighbours at
/// even angles and distances.
double meanHeight(const std::function<double(double, double)>& height, double x, double z) {
    constexpr int n = 1000;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double angle = 2 * 3.14159265358979 * (i + 0.5) / n, reach = 2 * (j + 0.5) / n;
            sum += std::max(0.0, height(x + reach * std::cos(angle), z + reach * std::sin(angle))) / 2;
        }
    return sum / n / n;
}

// A slope of 45 degrees beside flat ground, seen from above: differences of depth are heights. At the very foot the
// mean is 1/(2π). All neighbours must be in the picture. They fall on whole pixels (1/14 of a unit), and those below a
// hundredth of the radius count as the ground's own.
TEST(Occlusion, depthDifferencesGoThroughTheFunction) {
    EXPECT_NEAR(meanHeight([](double x, double) { return -x; }, 0, 0), 1 / (2 * 3.14159265358979), 1e-4)
        << "the oracle against the formula";
    const char* camera = "position = [0.4, 30, 0]\nlook_at = [0.4, 0, 0]\nup = [0, 0, -1]\northographic_height = 9\n";
    const std::string linear = "technique = 'occlusion_function'\nsamples = 128\nfunction = [[0, 0], [1, 1]]";
    const auto drawn = [&](const std::string& obj, int samples) {
        const LoadedScene scene =
            makeScene(std::string("[[mesh]]\nname = 'p'\nfile = 'p.obj'\n[[camera]]\n") + camera, {{"p.obj", obj}});
        return draw(
            makeConfig(fmt::format("shading = 'flat'\n[image]\nsize = [192, 128]\nsamples = {}\n[ao]\n{}\nradius = "
                                   "2\n[output]\naovs = ['ambient_occlusion', 'position']\n",
                samples, linear)),
            scene);
    };
    const Picture slope = drawn(quadObj({0, 0, 100}, {100, 0, 100}, {100, 0, -100}, {0, 0, -100})
            + quadObj({-100, 100, 100}, {0, 0, 100}, {0, 0, -100}, {-100, 100, -100}),
        1);
    for (const int column : {92, 98, 105}) {
        double hidden = 0;
        for (int y = 32; y < 96; ++y)
            hidden += (1 - static_cast<double>(*slope.aov("ambient_occlusion").at(column, y))) / 64;
        const double x = static_cast<double>(slope.aov("position").at(column, 64)[0]);
        EXPECT_NEAR(hidden, meanHeight([](double px, double) { return -px; }, x, 0), 0.003) << x;
    }
    // A corner of two such slopes: the higher one is seen.
    const std::string obj = quadObj({0, 0, 100}, {100, 0, 100}, {100, 0, 0}, {0, 0, 0}) + "v 0 0 0\nv 0 0 100\n"
        "v -100 100 100\nv -100 100 -100\nv 0 0 0\nv -100 100 -100\nv 100 100 -100\nv 100 0 0\nf -8 -7 -6 -5\n"
        "f -4 -3 -2 -1\n";
    const Picture p = drawn(obj, 16);
    for (const auto& [x, y] : {std::pair(93, 67), {100, 80}, {110, 72}}) {
        const float* at = p.aov("position").at(x, y);
        const double expected = meanHeight([](double px, double pz) { return std::max(-px, -pz); },
            static_cast<double>(at[0]), static_cast<double>(at[2]));
        EXPECT_NEAR(1 - static_cast<double>(*p.aov("ambient_occlusion").at(x, y)), expected, 0.01)
            << at[0] << ' ' << at[2] << ": one pixel, of 2048 neighbours";
    }
}

// The paper's settings: 0.852 on flat ground; the reach of neighbours that bend towards the viewer darkens, away from
// him lightens.
TEST(Occlusion, depthTangentsTellConcaveFromConvex) {
    const auto at = [](double y, const char* preset) {
        const std::string obj = quadObj({-100, y * 100, 100}, {0, 0, 100}, {0, 0, -100}, {-100, y * 100, -100})
            + quadObj({0, 0, 100}, {100, y * 100, 100}, {100, y * 100, -100}, {0, 0, -100});
        const LoadedScene scene = makeScene(
            "[[mesh]]\nname = 'p'\nfile = 'p.obj'\n[[camera]]\nposition = [0, 30, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, "
            "-1]\northographic_height = 20\nfar = 60\n",
            {{"p.obj", obj}});
        const Picture p =
            draw(makeConfig(fmt::format("shading = 'flat'\n[image]\nsize = [193, 129]\nsamples = 1\n[ao]\ntechnique = "
                                        "'depth_tangent'\n{}\n[output]\naovs = ['ambient_occlusion']\n",
                     preset)),
                scene);
        return static_cast<double>(*p.aov("ambient_occlusion").at(96, 64));
    };
    const double flat = at(0, "mode = 'paper'"), concave = at(1, "mode = 'paper'"), convex = at(-1, "mode = 'paper'");
    // The paper measures distances to the camera, not depths: beside the axis even a plane in front of it bends.
    EXPECT_NEAR(flat, std::pow(1 / (1 + 0.0025), 64.0), 0.006);
    EXPECT_LT(concave, flat - 0.01);
    EXPECT_GT(convex, flat + 0.01);
    EXPECT_EQ(at(0, "range = 10"), 1.0);
    EXPECT_EQ(at(-1, "range = 10"), 1.0);
    EXPECT_LT(at(1, "range = 10"), 0.8);
}

// By default: for each pair of opposite neighbours, in four rings each turned against the last, how far the pixel lies
// below the middle between them.
TEST(Occlusion, depthTangentsGiveWhatTheirFormulaSaysOfValleysAndRidges) {
    constexpr double kRange = 10, kPixel = 20.0 / 129, kReach = 7, kBleach = 0.3;
    for (const double slope : {1.0, 0.4, -1.0}) {
        const std::string obj = quadObj({-100, slope * 100, 100}, {0, 0, 100}, {0, 0, -100}, {-100, slope * 100, -100})
            + quadObj({0, 0, 100}, {100, slope * 100, 100}, {100, slope * 100, -100}, {0, 0, -100});
        const LoadedScene scene = makeScene(
            "[[mesh]]\nname = 'p'\nfile = 'p.obj'\n[[camera]]\nposition = [0, 30, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, "
            "-1]\northographic_height = 20\n",
            {{"p.obj", obj}});
        const Picture p = draw(makeConfig("shading = 'flat'\n[image]\nsize = [193, 129]\nsamples = 1\n[ao]\ntechnique "
                                          "= 'depth_tangent'\nrange = 10\n[output]\naovs = ['ambient_occlusion']\n"),
            scene);
        double least = 1;
        for (int column = 96; column < 110; ++column) {
            glm::dvec2 turned(1, 1);
            double sum = 0;
            for (int ring = 4; ring > 0; --ring) {
                for (int pair = 0; pair < 2; ++pair) {
                    // On either side of the fold's line both neighbours rise (or fall) by the slope: together by what
                    // reaches beyond it.
                    const double across = std::abs(std::round(turned.x * kReach * ring / 4)) * kPixel,
                                 from = (column - 96) * kPixel;
                    const double below = std::max(slope * std::max(across - from, 0.0) / kRange, 0.0),
                                 s = 0.5 * std::max(below * (2 - below / kBleach), 0.0);
                    sum += 1 / (1 + s * s) / 8;
                    turned = {-turned.y, turned.x};
                }
                turned = {0.6157 * turned.x - 0.7880 * turned.y, 0.7880 * turned.x + 0.6157 * turned.y};
            }
            const double expected = std::pow(sum, 64.0);
            // Depths of 30 are rounded by 2e-6, a 5 000 000th of the range; the power multiplies that by 64.
            EXPECT_NEAR(*p.aov("ambient_occlusion").at(column, 64), expected, 1e-4)
                << "slope " << slope << ", column " << column;
            least = std::min(least, expected);
        }
        EXPECT_EQ(least<0.98, slope> 0) << "only valleys darken";
    }
}

/// Distance of two pictures: root of the mean square over all channels.
double distance(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += (a.pixels[i] - b.pixels[i]) * (a.pixels[i] - b.pixels[i]);
    return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

// Half resolution is the same picture but for detail: registered at the same points, it has no bias of its own, and
// takes no pixel's value from another surface.
TEST(Occlusion, halfResolutionAgrees) {
    const LoadedScene scene = makeScene(
        "[[mesh]]\nname = 'm'\nfile = 'm.obj'\n[[camera]]\nposition = [3, 4, 6]\nlook_at = [0, 0.5, -1]\nfov = 60\n",
        {{"m.obj", mixedObj()}});
    const auto shot = [&](const char* technique, const char* resolution) {
        return draw(
            makeConfig(fmt::format("shading = 'flat'\n[image]\nsize = [320, 240]\nsamples = 16\n[ao]\ntechnique = "
                                   "'{}'\nradius = 0.6\nresolution = '{}'\n[output]\naovs = ['ambient_occlusion']\n",
                technique, resolution)),
            scene)
            .aov("ambient_occlusion");
    };
    const auto mean = [](const Image& image) {
        return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0)
            / static_cast<double>(image.pixels.size());
    };
    // What lost detail costs each of them, and 15 % more: pixels that take the values of what lies behind them cost a
    // third more.
    const std::pair<const char*, double> techniques[] = {
        {"hbao", 0.0079}, {"gtao", 0.0078}, {"visibility_bitmask", 0.0108}, {"hemisphere", 0.013}};
    for (const auto& [technique, lost] : techniques) {
        const Image half = shot(technique, "half"), full = shot(technique, "full");
        EXPECT_NEAR(mean(half), mean(full), 0.002) << technique;
        EXPECT_LT(distance(half, full), lost) << technique;
    }
}

// The error of a mean of half as many independent values is sqrt(2) times as large; that of a picture, in which
// outlines err as well, no more than that. A hundredth more is left to chance: noise of some thousand pixels.
TEST(Occlusion, ofAPartOfTheSamplesIsNoisierAndNothingElse) {
    const LoadedScene scene = makeScene("[[mesh]]\nname = 'm'\nfile = 'm.obj'\n"
            + cameraToml({3, 4, 6}, {0, 0.5, -1}, "fov = 45") + "[[light]]\ndirection = [-1, -2, -1]\n",
        {{"m.obj", mixedObj()}});
    const auto shot = [&](int samples, int ao) {
        return draw(
            makeConfig(fmt::format("[image]\nsize = [192, 128]\nsamples = {}\nao_samples = {}\n[shading]\ntechnique = "
                                   "'lambert'\nambient = 0.6\n[ao]\ntechnique = 'toon_ssao'\nradius = '20%'\nfilter = "
                                   "{{ technique = 'gaussian' }}\n[output]\naovs = ['beauty', 'ambient_occlusion']\n",
                samples, ao)),
            scene);
    };
    const Picture truth = shot(256, 256), all = shot(8, 8), half = shot(8, 4), one = shot(8, 1), automatic = shot(8, 0);
    const auto error = [&](const Picture& picture, const char* aov) {
        return distance(picture.aov(aov), truth.aov(aov));
    };
    EXPECT_EQ(automatic.aov("beauty").pixels, half.aov("beauty").pixels) << "a half, but at least four";
    EXPECT_EQ(shot(4, 0).aov("beauty").pixels, shot(4, 4).aov("beauty").pixels);
    EXPECT_LE(error(half, "ambient_occlusion"), 1.43 * error(all, "ambient_occlusion"));
    EXPECT_GE(error(one, "ambient_occlusion"), 1.5 * error(half, "ambient_occlusion")) << "this test sees noise";
    EXPECT_LE(error(half, "beauty"), 1.43 * error(all, "beauty"));
}

}  // namespace
}  // namespace limn::test
