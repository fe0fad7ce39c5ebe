// Lines that scenes draw themselves: polylines of mesh files, and what a section leaves of a single sheet.

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

namespace limn::test {
namespace {

const char* const kDrawing =
    "shading = 'flat'\n[[edges]]\ntechnique = 'depth_normal'\nwidth = '{}px'\n{}[image]\nsize "
    "= [160, 120]\nsamples = {}\n[output]\naovs = ['edges', 'depth']\n";

Image edges(const LoadedScene& scene, double width, int samples, const std::string& more = "") {
    return draw(makeConfig(fmt::format(fmt::runtime(kDrawing), width, more, samples)), scene).aov("edges");
}

double ink(const Image& image, int fromX, int toX) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = fromX; x < toX; ++x) sum += static_cast<double>(image.at(x, y)[3]);
    return sum;
}

// A camera that sees 160 × 120 units: one per pixel.
const std::string kFlat = cameraToml({0, 0, 50}, {0, 0, 0}, "orthographic_height = 120");

LoadedScene lines(const std::string& obj, const std::string& more = "") {
    return makeScene("[[mesh]]\nname = 'm'\nfile = 'm.obj'\n" + kFlat + more, {{"m.obj", obj}});
}

TEST(Marks, haveTheirWidthAndLengthInEveryDirection) {
    // A line of length l and width w with round ends covers l·w + π·w²/4, whatever its angle: within a hundredth, which
    // the twelve bits of ends and the rounding of ends to trapezia account for.
    for (const double degrees : {0.0, 17.0, 45.0, 90.0, 133.0})
        for (const double width : {1.0, 2.0, 5.0})
            for (const int samples : {1, 4}) {
                const double c = 40 * std::cos(glm::radians(degrees)), s = 40 * std::sin(glm::radians(degrees));
                const Image image =
                    edges(lines(fmt::format("v {} {} 0\nv {} {} 0\nl 1 2\n", -c, -s, c, s)), width, samples);
                const double expected = 80 * width + M_PI * width * width / 4;
                EXPECT_NEAR(ink(image, 0, 160), expected, 0.015 * expected)
                    << degrees << " degrees, " << width << " pixels, " << samples << " samples";
            }
}

TEST(Marks, ofAPolylineJoin) {
    // A circle of many short lines: the ink of a ring.
    std::string obj, line = "l";
    for (int i = 0; i <= 720; ++i) {
        const double a = glm::radians(i / 2.0);
        obj += fmt::format("v {} {} 0\n", 50 * std::cos(a), 50 * std::sin(a));
        line += fmt::format(" {}", i + 1);
    }
    const double expected = 2 * M_PI * 50 * 3;
    EXPECT_NEAR(ink(edges(lines(obj + line + "\n"), 3, 1), 0, 160), expected, 0.01 * expected);
}

TEST(Marks, areHiddenByWhatLiesInFrontAndVisibleOnSurfaces) {
    // A board from x = -80 to 0. Lines across it: behind it, on it, and in front of it.
    const std::string board = "v -80 -60 0\nv 0 -60 0\nv 0 60 0\nv -80 60 0\nf 1 2 3 4\n";
    const auto across = [&](double z) {
        return edges(lines(board + fmt::format("v -70 10 {0}\nv 70 10 {0}\nl 5 6\n", z)), 2, 1,
            "silhouettes = 0\ncreases = 0\n");
    };
    const Image behind = across(-5), on = across(0), before = across(5);
    EXPECT_LT(ink(behind, 0, 78), 1e-6);
    EXPECT_NEAR(ink(behind, 82, 160), 2 * 68, 2.5);
    EXPECT_NEAR(ink(on, 0, 160), 2 * 140 + M_PI, 3);
    EXPECT_NEAR(ink(before, 0, 160), 2 * 140 + M_PI, 3);
}

TEST(Marks, takeTheirOwnWeightAndColour) {
    const LoadedScene scene = lines("v -40 0 0\nv 40 0 0\nl 1 2\n");
    EXPECT_NEAR(ink(edges(scene, 2, 1, "marks = 2\n"), 20, 140) / ink(edges(scene, 2, 1), 20, 140), 2, 0.06);
    EXPECT_EQ(ink(edges(scene, 2, 1, "marks = 0\nsilhouettes = 1\n"), 0, 160), 0);
    const Image red = edges(scene, 2, 1, "mark_color = '#ff0000'\n");
    EXPECT_GT(red.at(80, 60)[0], 0.4f);
    EXPECT_LT(red.at(80, 60)[1], 0.01f);
    const LoadedScene own =
        lines("usemtl m\nv -40 0 0\nv 40 0 0\nl 1 2\n", "[[material]]\nname = 'm'\nlines = false\n");
    EXPECT_EQ(ink(edges(own, 2, 1), 0, 160), 0) << "lines = false";
}

TEST(Marks, areTheSameInTiles) {
    std::string obj = mixedObj() + "o rope\n";
    for (int i = 0; i < 40; ++i)
        obj += fmt::format("v {} {} {}\n", 2.5 * std::sin(i * 0.7), 0.05 * i, 2 * std::cos(i * 1.1) - 1);
    obj += "l";
    for (int i = 40; i > 0; --i) obj += fmt::format(" -{}", i);
    const LoadedScene scene =
        makeScene("[[mesh]]\nname = 'm'\nfile = 'm.obj'\n" + cameraToml({2.5, 3.5, 6}, {0, 0.5, -1}, "fov = 60"),
            {{"m.obj", obj + "\n"}});
    const auto at = [&](int tile) {
        return draw(
            makeConfig(fmt::format("shading = 'flat'\n[[edges]]\ntechnique = 'depth_normal'\nwidth = "
                                   "'2.5px'\n[image]\nsize = [151, 123]\nsamples = 4\ntile = {}\n[output]\naovs = "
                                   "['beauty', 'edges']\n",
                tile)),
            scene);
    };
    const Picture whole = at(4096);
    for (const int tile : {100, 64, 32})
        for (const auto& layer : whole.frame.layers)
            EXPECT_EQ(std::memcmp(layer.image.pixels.data(), at(tile).aov(layer.name).pixels.data(),
                          layer.image.pixels.size() * sizeof(float)),
                0)
                << layer.name << " in tiles of " << tile;
}

TEST(Marks, costNothingWhereNoneAreDrawn) {
    const auto passes = [](const std::string& obj, const std::string& more) {
        const LoadedScene scene = lines(obj);
        const RenderConfig config = makeConfig(fmt::format(fmt::runtime(kDrawing), 2, more, 1));
        FrameRequest request;
        const SceneAt at = sceneAt(scene, request);
        return passNames(
            buildPipelines(config, at, sceneFacts(at), 1, 16384, 0, {{{}, config.image.size}, {}}).averaged);
    };
    const std::string board = "v -80 -60 0\nv 0 -60 0\nv 0 60 0\nf 1 2 3\n";
    EXPECT_EQ(passes(board, "").find("marks"), std::string::npos);
    EXPECT_NE(passes(board + "l 1 2\n", "").find("marks"), std::string::npos);
}

TEST(Seams, ofATenthOfAPixelAreNotSeen) {
    // Two walls in one plane, less than a tenth of a pixel apart, with a floor far behind: no line, wherever the gap
    // lies among the samples, which are a 16th apart. Half a pixel apart they have their lines.
    const auto drawn = [&](double gap, double place) {
        const std::string obj = quadObj({-60, -40, 0}, {place, -40, 0}, {place, 40, 0}, {-60, 40, 0})
            + quadObj({place + gap, -40, 0}, {60, -40, 0}, {60, 40, 0}, {place + gap, 40, 0})
            + quadObj({-90, -70, -30}, {90, -70, -30}, {90, 70, -30}, {-90, 70, -30});
        const Image image = edges(lines(obj), 1, 16);
        double sum = 0;
        for (int y = 40; y < 80; ++y)
            for (int x = 70; x < 95; ++x) sum += static_cast<double>(image.at(x, y)[3]);
        return sum;
    };
    for (const double place : {0.0, 0.03, 0.11, 0.24, 0.4, 0.499}) EXPECT_EQ(drawn(0.08, place), 0) << place;
    EXPECT_GT(drawn(0.6, 0.2), 10);
}

// What lies in front of one plane is no seam, however thin: its lines stay.
TEST(Seams, areNothingInFrontOfAWall) {
    const std::string obj = quadObj({-60, -40, 0}, {60, -40, 0}, {60, 40, 0}, {-60, 40, 0})
        + quadObj({0.2, -30, 5}, {1.2, -30, 5}, {1.2, 30, 5}, {0.2, 30, 5});
    const Image image = edges(lines(obj), 1, 4);
    for (int y = 40; y < 80; ++y) {
        double row = 0;
        for (int x = 70; x < 95; ++x) row += static_cast<double>(image.at(x, y)[3]);
        EXPECT_GT(row, 1.2) << y;
    }
}

}  // namespace
}  // namespace limn::test
