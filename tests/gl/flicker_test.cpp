// Sequences that flicker, and such that cannot.

#include "job/flicker.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace limn::test {
namespace {

const std::string kAsked =
    "[image]\nsize = [96, 64]\nsamples = 4\n[output]\naovs = ['beauty', 'motion', 'object_id']\n";

/// The figures of frames 2 to 6.
std::vector<FlickerFigure> figures(const std::string& config, const std::string& scene, const std::string& mesh) {
    const LoadedScene loaded = makeScene("[animation]\nframes = '1-6'\n" + scene, {{"m.obj", mesh}});
    Flicker flicker;
    std::vector<FlickerFigure> found;
    for (int frame = 1; frame <= 6; ++frame) {
        const Picture picture = draw(makeConfig(kAsked + config), loaded, {}, frame);
        EXPECT_TRUE(Flicker::canBeSeen(picture.frame.layers));
        flicker.add(picture.frame.layers);
        if (const auto figure = flicker.endFrame()) found.push_back(*figure);
    }
    return found;
}

const std::string kMesh = "[[mesh]]\nname = 'm'\nfile = 'm.obj'\n";
const std::string kPan = kMesh
    + "[[camera]]\nposition = { keys = [[1, [0, 0.3, 5]], [6, [0.31, 0.1, 4.6]]] }\nlook_at = [0, 0, 0]\nfov = 30\n";
const std::string kWall = quadObj({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});

TEST(Flicker, aPlainWallCannot) {
    for (const auto& figure : figures("[shading]\ntechnique = 'toon'\n", kPan, kWall)) {
        EXPECT_LT(figure.mean, 1e-3);
        EXPECT_GT(figure.compared, 0.8);
    }
}

TEST(Flicker, isWhatTheLightDoes) {
    // A white wall that is lit at every second frame: from #808080 to white and back.
    const std::string light =
        "[[material]]\nname = 'w'\ncolor = { keys = [[1, '#ffffff'], [2, '#808080'], [3, '#ffffff']], interpolation = "
        "'constant', beyond = 'repeat' }\n[[instance]]\nmesh = 'm'\nmaterial = 'w'\n";
    for (const auto& figure : figures("[shading]\ntechnique = 'flat'\n", kPan + light, kWall))
        EXPECT_NEAR(figure.mean, 127, 0.5);
}

TEST(Flicker, ofNoiseFallsWithSamples) {
    // Noise that stays where the picture is swims over the surface: the more samples, the less.
    const auto mean = [&](int points) {
        double sum = 0;
        for (const auto& figure :
            figures(fmt::format(
                        "[shading]\ntechnique = 'clay'\n[ao]\ntechnique = 'hemisphere'\nradius = 1.5\npoints = {}\n",
                        points),
                kPan, mixedObj()))
            sum += figure.mean / 5;
        return sum;
    };
    const double few = mean(4), many = mean(64);
    EXPECT_GT(few, 2 * many) << few << " " << many;
}

TEST(Flicker, ofNoiseOnTheSurfaceIsLess) {
    // Under a slow pan noise that lies on the surface moves along with it.
    const auto mean = [&](const std::string& seed, const char* technique) {
        double sum = 0;
        const LoadedScene loaded = makeScene("[animation]\nframes = '1-6'\n" + kMesh
                + "[[camera]]\nposition = { keys = [[1, [0, 0.3, 5]], [6, [0.05, 0.3, 5]]] }\nlook_at = [0, 0, 0]\n"
                  "fov = 30\n",
            {{"m.obj", mixedObj()}});
        Flicker flicker;
        const RenderConfig config = makeConfig(
            fmt::format("[image]\nsize = [192, 128]\nsamples = 1\nseed = {}\n[shading]\ntechnique = 'clay'\n[ao]\n"
                        "technique = '{}'\nradius = 1.5\n[output]\naovs = ['beauty', 'motion', 'object_id']\n",
                seed, technique));
        for (int frame = 1; frame <= 6; ++frame) {
            flicker.add(draw(config, loaded, {}, frame).frame.layers);
            if (const auto figure = flicker.endFrame()) sum += figure->mean / 5;
        }
        return sum;
    };
    for (const char* technique : {"hbao", "gtao", "visibility_bitmask", "toon_ssao", "occlusion_function"}) {
        const double onPixels = mean("0", technique), onSurface = mean("'surface'", technique);
        EXPECT_LT(onSurface, 0.9 * onPixels) << technique;  // measured: 0.65 to 0.86 of it
    }
}

TEST(Flicker, linesDoNotShimmerUnderSlowMoves) {
    // Ink across a straight line, over a pan of 64 steps of an eighth of a pixel: 16 pixels a unit.
    for (const char* edge : {"samples = 1\n", "samples = 4\n"}) {
        const std::string scene = kMesh
            + "[[camera]]\nposition = { keys = [[1, [0, 0, 5]], [65, [0.5, 0, 5]]] }\nlook_at = { keys = [[1, [0, 0, "
              "0]], [65, [0.5, 0, 0]]] }\northographic_height = 4\n";
        const LoadedScene loaded =
            makeScene(scene, {{"m.obj", quadObj({-0.8, -5, 0}, {0.71, -5, 0}, {1.0, 5, 0}, {-1.3, 5, 0})}});
        double least = 1e9, most = 0;
        for (int frame = 1; frame <= 64; ++frame) {
            const Picture picture = draw(makeConfig(fmt::format("[image]\nsize = [96, 64]\n{}[[edges]]\ntechnique = "
                                                                "'depth_normal'\nwidth = '2px'\n[output]\naovs = "
                                                                "['edges']\n",
                                             edge)),
                loaded, {}, frame);
            double ink = 0;
            for (int x = 0; x < 96; ++x) ink += picture.aov("edges").at(x, 32)[3];
            least = std::min(least, ink);
            most = std::max(most, ink);
        }
        EXPECT_LT(most - least, 2.0 / 255) << edge << least << " to " << most << ": two lines, each within 1/255";
    }
}

}  // namespace
}  // namespace limn::test
