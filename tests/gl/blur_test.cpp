// Motion blur: what moves is averaged over the time that the shutter is open, lines included; what rests does not
// change.

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace limn::test {
namespace {

/// A white card, 1.2 wide and 2 high, before black, that moves by `speed` units a frame; 16 pixels a unit.
std::string movingCard(double speed, const std::string& more = "") {
    return fmt::format(R"(
        [[mesh]]
        name = 'card'
        file = 'card.obj'
        [[material]]
        name = 'white'
        color = '#ffffff'
        [[instance]]
        mesh = 'card'
        material = 'white'
        translate = {{ keys = [[0, [{}, 0, 0]], [20, [{}, 0, 0]]] }}
        {}
    )",
               -10 * speed, 10 * speed, more)
        + cameraToml({0, 0, 5}, {0, 0, 0}, "orthographic_height = 4");
}

const std::string kCard = quadObj({-0.6, -1, 0}, {0.6, -1, 0}, {0.6, 1, 0}, {-0.6, 1, 0});

/// Red of the row in the middle of frame 10.
std::vector<float> row(const std::string& config, const std::string& scene) {
    const Picture picture = draw(makeConfig("[image]\nsize = [64, 64]\nbackground = '#000000'\n" + config),
        makeScene(scene, {{"card.obj", kCard}}), {}, 10);
    const Image& beauty = picture.aov("beauty");
    std::vector<float> values;
    for (int x = 0; x < beauty.width; ++x) values.push_back(beauty.at(x, 32)[0]);
    return values;
}

TEST(Blur, aMovingCardIsAveragedOverItsPath) {
    for (const double shutter : {0.25, 0.5, 1.0}) {
        // Moves by 16 pixels a frame: the card covers x from 32 - 9.6 to 32 + 9.6, give or take half of the blur.
        const double blur = 16 * shutter, samples = 64;
        const auto values = row(fmt::format("samples = 64\nshutter = {}\n", shutter), movingCard(1));
        for (int x = 0; x < 64; ++x) {
            const auto covered = [&](double at) { return std::clamp(at / blur + 0.5, 0.0, 1.0); };
            // The pixel's own width is averaged too.
            double expected = 0;
            for (double part = 0.05; part < 1; part += 0.1)
                expected += 0.1 * (covered(x + part - (32 - 9.6)) - covered(x + part - (32 + 9.6)));
            // Each sample is there or not: one of them at each of the two ends, and what it covers of a pixel.
            EXPECT_NEAR(values[static_cast<std::size_t>(x)], expected, 2 / samples + 0.016) << x << " " << shutter;
        }
    }
}

TEST(Blur, whatRestsIsSharp) {
    // Seven samples lie in the same places with and without a shutter: they fit no finer raster.
    EXPECT_EQ(row("samples = 7\nshutter = 1\n", movingCard(0)), row("samples = 7\n", movingCard(0)));
}

TEST(Blur, aMovingCameraBlursAsMuchAsAMovingWorld) {
    std::string scene = movingCard(0);
    const std::string still = "position = " + toml({0, 0, 5}), aim = "look_at = " + toml({0, 0, 0});
    ASSERT_NE(scene.find(still), std::string::npos) << scene;
    scene.replace(scene.find(still), still.size(), "position = { keys = [[0, [10, 0, 5]], [20, [-10, 0, 5]]] }");
    scene.replace(scene.find(aim), aim.size(), "look_at = { keys = [[0, [10, 0, 0]], [20, [-10, 0, 0]]] }");
    const auto world = row("samples = 32\nshutter = 0.5\n", movingCard(1)),
               camera = row("samples = 32\nshutter = 0.5\n", scene);
    for (std::size_t x = 0; x < world.size(); ++x) EXPECT_NEAR(camera[x], world[x], 1e-6) << x;
}

TEST(Blur, linesBlurToo) {
    // Ink per row is what the lines' width says, wherever it goes.
    const std::string lines =
        "samples = 32\nline_samples = 32\nbackground = '#ffffff'\n[[edges]]\ntechnique = 'depth_normal'\n"
        "width = '3px'\ncolor = '#000000'\n";
    const auto ink = [&](const std::string& shutter) {
        const Picture picture = draw(makeConfig("[image]\nsize = [64, 64]\n" + shutter + lines),
            makeScene(movingCard(0.25), {{"card.obj", kCard}}), {}, 10);
        double sum = 0, darkest = 1;
        for (int x = 0; x < 64; ++x) {
            sum += 1 - picture.aov("beauty").at(x, 32)[0];
            darkest = std::min<double>(darkest, picture.aov("beauty").at(x, 32)[0]);
        }
        return std::pair(sum, darkest);
    };
    const auto [sharp, darkOfSharp] = ink("");
    const auto [open, darkOfOpen] = ink("shutter = 2\n");  // each line moves over 8 pixels
    EXPECT_NEAR(sharp, 6, 0.06);
    EXPECT_NEAR(open, 6, 0.12);
    EXPECT_LT(darkOfSharp, 0.01);
    EXPECT_NEAR(darkOfOpen, 1 - 3.0 / 8, 0.06);
}

}  // namespace
}  // namespace limn::test
