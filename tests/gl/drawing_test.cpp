// Drawings measure right on paper, whatever their resolution.

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace limn::test {
namespace {

/// Centres of the two vertical lines that a row of the picture crosses, in pixels.
std::pair<double, double> linesInRow(const Image& edges, int y) {
    double left = 0, leftWeight = 0, right = 0, rightWeight = 0;
    for (int x = 0; x < edges.width; ++x) {
        const double alpha = static_cast<double>(edges.at(x, y)[3]);
        (x < edges.width / 2 ? left : right) += alpha * (x + 0.5);
        (x < edges.width / 2 ? leftWeight : rightWeight) += alpha;
    }
    return {left / leftWeight, right / rightWeight};
}

TEST(Sheet, aMetreOfWallIsTwentyMillimetresAtOneToFifty) {
    for (const double metersPerUnit : {1.0, 0.001})
        for (const int dpi : {150, 300, 600}) {
            const double m = 1 / metersPerUnit;
            const LoadedScene scene = makeScene(fmt::format("[units]\nmeters_per_unit = {}\n[[mesh]]\nname = 'w'\nfile = 'w.obj'\n", metersPerUnit) + cameraToml(glm::dvec3(0.1234, 0.5, 9) * m, glm::dvec3(0.1234, 0.5, 0) * m, "orthographic_height = 1"),
                                                {{"w.obj", boxObj(glm::dvec3(-0.5, 0, 0) * m, glm::dvec3(0.5, 1, 0.2) * m)}});
            const Picture p = draw(makeConfig(fmt::format("[image]\ndpi = {}\nsamples = 1\n[sheet]\nsize = '60x40'\nscale = '1:50'\n[[edges]]\ntechnique = 'depth_normal'\nwidth = '0.35mm'\n[output]\naovs = ['edges']\n", dpi)), scene);
            const Image& edges = p.aov("edges");
            EXPECT_EQ(edges.width, std::lround(60 / 25.4 * dpi));
            const auto [left, right] = linesInRow(edges, edges.height / 2);
            // Lines are placed to 1/256 pixel, and alpha is a half float.
            EXPECT_NEAR((right - left) / dpi * 25.4, 20, 4.0 / 256 / dpi * 25.4) << dpi;
            double area = 0;
            for (int x = 0; x < edges.width; ++x) area += static_cast<double>(edges.at(x, edges.height / 2)[3]);
            EXPECT_NEAR(area / 2 / dpi * 25.4, 0.35, 0.35 * 0.005) << "the lines' width in millimetres";
        }
}

TEST(Sheet, perspectiveHasNoScale) {
    const LoadedScene scene = makeScene("[[mesh]]\nname = 'w'\nfile = 'w.obj'\n" + cameraToml({0, 0, 9}, {0, 0, 0}, "fov = 30"), {{"w.obj", boxObj(glm::dvec3(-1), glm::dvec3(1))}});
    EXPECT_THROW(draw(makeConfig("[sheet]\nsize = 'A6'\nscale = '1:50'\n"), scene), Error);
}

TEST(Sections, showFilledFacesUnderHeavierLines) {
    // A hollow box, cut in the middle: a square ring of fill, 1 unit of 4 wide, seen from above in a picture of 8 units.
    const std::string outer = boxObj({-2, -2, -2}, {2, 2, 2});
    const LoadedScene scene = makeScene("[[mesh]]\nname = 'o'\nfile = 'o.obj'\n[[section]]\nname = 'A'\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nfill = '#ff0000'\n" + cameraToml({0, 0, 9}, {0, 0, 0}, "orthographic_height = 8"), {{"o.obj", outer}});
    const auto red = [&](const std::string& sections) {
        const Picture p = draw(makeConfig(sections + "[image]\nsize = [80, 80]\nsamples = 1\n[[edges]]\ntechnique = 'depth_normal'\nwidth = '1px'\nsections = 3\n[output]\naovs = ['beauty', 'albedo', 'edges']\n"), scene);
        int count = 0;
        for (int i = 0; i < 80 * 80; ++i) count += p.aov("albedo").pixels[static_cast<std::size_t>(i) * 4] > 0.9f;
        double ink = 0;
        for (int i = 0; i < 80 * 80; ++i) ink += static_cast<double>(p.aov("edges").pixels[static_cast<std::size_t>(i) * 4 + 3]);
        return std::pair(count, ink);
    };
    const auto [without, thin] = red("");
    const auto [with, thick] = red("sections = ['A']\n");
    EXPECT_EQ(without, 0);
    EXPECT_EQ(with, 40 * 40);
    EXPECT_NEAR(thin, 160, 2);
    EXPECT_NEAR(thick, 3 * 160, 4) << "three times as heavy";
    EXPECT_THROW(red("sections = ['B']\n"), Error);
}

}  // namespace
}  // namespace limn::test
