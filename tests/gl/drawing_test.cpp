// Drawings measure right on paper, whatever their resolution.

#include "render/report.h"
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
            const LoadedScene scene = makeScene(
                fmt::format("[units]\nmeters_per_unit = {}\n[[mesh]]\nname = 'w'\nfile = 'w.obj'\n", metersPerUnit)
                    + cameraToml(
                        glm::dvec3(0.1234, 0.5, 9) * m, glm::dvec3(0.1234, 0.5, 0) * m, "orthographic_height = 1"),
                {{"w.obj", boxObj(glm::dvec3(-0.5, 0, 0) * m, glm::dvec3(0.5, 1, 0.2) * m)}});
            const Picture p = draw(
                makeConfig(fmt::format(
                    "[image]\ndpi = {}\nsamples = 1\n[sheet]\nsize = '60x40'\nscale = '1:50'\n[[edges]]\ntechnique = "
                    "'depth_normal'\nwidth = '0.35mm'\n[output]\naovs = ['edges']\n",
                    dpi)),
                scene);
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
    const LoadedScene scene =
        makeScene("[[mesh]]\nname = 'w'\nfile = 'w.obj'\n" + cameraToml({0, 0, 9}, {0, 0, 0}, "fov = 30"),
            {{"w.obj", boxObj(glm::dvec3(-1), glm::dvec3(1))}});
    EXPECT_THROW(draw(makeConfig("[sheet]\nsize = 'A6'\nscale = '1:50'\n"), scene), Error);
}

TEST(Lines, ofObjectsAndMaterialsLookAsTheySay) {
    // Three boxes side by side, seen from the front and above: as the technique says, red by its material, and without
    // lines by its instance.
    const std::string scene =
        "[[mesh]]\nname = 'b'\nfile = 'b.obj'\n[[material]]\nname = 'red'\nline_color = [1, 0, 0]\n[[material]]\nname "
        "= 'soft'\ncrease_angle = 120\n"
        "[[instance]]\nmesh = 'b'\ntranslate = [-3, 0, 0]\n[[instance]]\nmesh = 'b'\nmaterial = "
        "'red'\n[[instance]]\nmesh = 'b'\ntranslate = [3, 0, 0]\nlines = false\n[[instance]]\nmesh = 'b'\ntranslate = "
        "[6, 0, 0]\nmaterial = 'soft'\n"
        + cameraToml({1.5, 6, 6}, {1.5, 0, 0}, "orthographic_height = 6");
    const Picture p = draw(makeConfig("[image]\nsize = [240, 120]\nsamples = 1\n[[edges]]\ntechnique = "
                                      "'depth_normal'\nwidth = '1px'\ncolor = '#0000ff'\n[output]\naovs = ['edges']\n"),
        makeScene(scene, {{"b.obj", boxObj(glm::dvec3(-1), glm::dvec3(1))}}));
    const Image& edges = p.aov("edges");
    double red[4] = {}, blue[4] = {};
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 240; ++x) {
            red[x / 60] += static_cast<double>(edges.at(x, y)[0]);
            blue[x / 60] += static_cast<double>(edges.at(x, y)[2]);
        }
    // Outline and one crease: 2·(40 + two faces' heights) + 40 pixels.
    const double full = 2 * (40 + 2 * 40 * std::sqrt(0.5)) + 40;
    EXPECT_NEAR(blue[0], full, 4);  // corners are round, and lie upon one another
    EXPECT_NEAR(red[1], full, 4);
    EXPECT_EQ(blue[2] + red[2], 0);
    EXPECT_NEAR(blue[3], full - 40, 4) << "its right angles are no creases";
    EXPECT_EQ(red[0] + blue[1] + red[3], 0);
}

TEST(Lines, ofObjectsAndMaterialsAreSourcesOfTheirOwn) {
    // Two boxes side by side, flush: nothing bends or ends between them, but they are two objects, of two materials.
    const std::string scene =
        "[[mesh]]\nname = 'b'\nfile = 'b.obj'\n[[material]]\nname = 'one'\n[[material]]\nname = "
        "'other'\n[[instance]]\nmesh = 'b'\ntranslate = [-1, 0, 0]\nmaterial = 'one'\n[[instance]]\nmesh = "
        "'b'\ntranslate = [1, 0, 0]\nmaterial = 'other'\n"
        + cameraToml({0.01, 0, 6}, {0.01, 0, 0}, "orthographic_height = 4");
    const auto ink = [&](const std::string& sources) {
        const Picture p = draw(makeConfig("[image]\nsize = [200, 100]\nsamples = 1\n[[edges]]\ntechnique = "
                                          "'depth_normal'\nwidth = '2px'\ncolor = '#0000ff'\nsilhouettes = 0\n"
                                   + sources + "[output]\naovs = ['edges']\n"),
            makeScene(scene, {{"b.obj", boxObj(glm::dvec3(-1), glm::dvec3(1))}}));
        double red = 0, blue = 0;
        for (std::size_t i = 0; i < p.aov("edges").pixels.size(); i += 4) {
            red += static_cast<double>(p.aov("edges").pixels[i]);
            blue += static_cast<double>(p.aov("edges").pixels[i + 2]);
        }
        return std::pair(red, blue);
    };
    EXPECT_EQ(ink("").second, 0);
    EXPECT_NEAR(ink("objects = 1\n").second, 2 * 50 + 2 * 2 * (100 + 50), 8)
        << "the seam, and the objects' outlines against nothing";
    const double seam = 4 * 50 + 4 * std::acos(-1.0);  // its ends are round
    EXPECT_NEAR(ink("materials = 2\n").second, seam, 3);
    EXPECT_NEAR(ink("materials = 2\nmaterial_color = '#ff0000'\n").first, seam, 3);
    EXPECT_NEAR(ink("materials = 1\nobjects = 0.5\nobject_color = '#ff0000'\n").first, 1 * 50 + 1 * 2 * (100 + 50), 8)
        << "where both are, objects go before materials";
}

TEST(Lines, fadeAndTaperWithDepth) {
    const std::string obj = quadObj({-4, -1, 0}, {-2, -1, 0}, {-2, 1, 0}, {-4, 1, 0})
        + "v 2 -1 -10\nv 4 -1 -10\nv 4 1 -10\nv 2 1 -10\nf 5 6 7 8\n";
    const LoadedScene scene = makeScene(
        "[[mesh]]\nname = 'm'\nfile = 'm.obj'\n" + cameraToml({0, 0, 10}, {0, 0, 0}, "orthographic_height = 4"),
        {{"m.obj", obj}});
    const auto ink = [&](const std::string& more) {
        const Picture p = draw(makeConfig("[image]\nsize = [240, 96]\nsamples = 1\n[[edges]]\ntechnique = "
                                          "'depth_normal'\nwidth = '3px'\nfade_from = 10\nfade_to = 20\n"
                                   + more + "[output]\naovs = ['edges']\n"),
            scene);
        std::pair<double, double> halves;
        for (int y = 0; y < 96; ++y)
            for (int x = 0; x < 240; ++x)
                (x < 120 ? halves.first : halves.second) += static_cast<double>(p.aov("edges").at(x, y)[3]);
        return halves;
    };
    const auto plain = ink(""), faded = ink("fade = 0.5\n"), tapered = ink("taper = 0.75\n");
    EXPECT_NEAR(plain.first, plain.second, 0.01 * plain.first);
    EXPECT_NEAR(faded.first, plain.first, 0.01 * plain.first);
    EXPECT_NEAR(faded.second, 0.5 * plain.second, 0.02 * plain.second);
    EXPECT_NEAR(tapered.second, 0.25 * plain.second, 0.03 * plain.second);
}

TEST(Lines, ofChosenObjectsLieOnTheSideAskedFor) {
    // A square of 40 × 40 pixels before a wall: 2 pixels of line within it, without it, or half and half.
    const std::string scene =
        "[[mesh]]\nname = 'w'\nfile = 'w.obj'\n[[mesh]]\nname = 'q'\nfile = 'q.obj'\n[[instance]]\nmesh = "
        "'w'\n[[instance]]\nmesh = 'q'\nname = 'square one'\n"
        + cameraToml({0, 0, 6}, {0, 0, 0}, "orthographic_height = 5");
    const LoadedScene loaded = makeScene(scene,
        {{"w.obj", quadObj({-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1})},
            {"q.obj", quadObj({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0})}});
    const auto ink = [&](const std::string& side, const std::string& chosen) {
        const Picture p = draw(
            makeConfig(fmt::format("[image]\nsize = [100, 100]\nsamples = 1\n[[edges]]\ntechnique = 'laplacian'\nwidth "
                                   "= '2px'\nside = '{}'\n{}\n[output]\naovs = ['edges', 'object_id']\n",
                side, chosen)),
            loaded);
        std::pair<double, double> sums;
        for (std::size_t i = 0; i < 10000; ++i)
            (p.aov("object_id").pixels[i] == 2 ? sums.first : sums.second) +=
                static_cast<double>(p.aov("edges").pixels[4 * i + 3]);
        return sums;
    };
    for (const std::string chosen : {"objects = ['square*']", "ids = [2]", ""}) {
        const auto both = ink("both", chosen), inner = ink("inner", chosen), outer = ink("outer", chosen);
        EXPECT_NEAR(both.first, 4 * 40 - 4, 2) << chosen;
        EXPECT_NEAR(both.second, 4 * 40 + 4, 4) << chosen;
        EXPECT_NEAR(inner.first, 2 * 4 * 40 - 16, 4) << chosen;
        EXPECT_LE(inner.second, 2) << chosen;
        EXPECT_NEAR(outer.second, 2 * 4 * 40 + 14, 6) << chosen;
        EXPECT_LE(outer.first, 2) << chosen;
    }
    EXPECT_THROW(ink("both", "objects = ['sqare']"), Error);
    EXPECT_THROW(ink("both", "ids = [7]"), Error);
}

TEST(DepthTangent, looksTheSameAtEveryResolution) {
    // With its reach in shares of the picture: the same ink at 1, 2 and 4 times the resolution, and supersampled.
    const LoadedScene scene =
        makeScene("[[mesh]]\nname = 'm'\nfile = 'm.obj'\n" + cameraToml({3, 4, 6}, {0, 0.5, -1}, "fov = 60"),
            {{"m.obj", mixedObj()}});
    double first = 0;
    for (const int times : {1, 2, 4})
        for (const int samples : {4, 16}) {
            const Picture p =
                draw(makeConfig(fmt::format("[image]\nsize = [{}, {}]\nsamples = {}\n[[edges]]\ntechnique = "
                                            "'depth_tangent'\nreach = '0.9%'\n[output]\naovs = ['edges']\n",
                         180 * times, 120 * times, samples)),
                    scene);
            double ink = 0;
            for (std::size_t i = 3; i < p.aov("edges").pixels.size(); i += 4)
                ink += static_cast<double>(p.aov("edges").pixels[i]);
            ink /= static_cast<double>(p.aov("edges").pixels.size() / 4);
            if (first == 0) first = ink;
            // Offsets are whole pixels, of which 0.9 % of 120 rows is one: what is drawn of a bend changes with how it
            // falls, by 0.3 % here.
            EXPECT_NEAR(ink, first, 0.01 * first) << times << " times, " << samples << " samples";
        }
}

TEST(DepthTangent, inBothSlotsIsOnePassFromDepthAlone) {
    const LoadedScene scene =
        makeScene("[[mesh]]\nname = 'm'\nfile = 'm.obj'\n" + cameraToml({3, 4, 6}, {0, 0.5, -1}, "fov = 60"),
            {{"m.obj", mixedObj()}});
    const RenderConfig config = makeConfig(
        "[image]\nsize = [160, 120]\nsamples = 1\n[ao]\ntechnique = 'depth_tangent'\nreach = '2px'\nrange = "
        "'1%'\n[[edges]]\ntechnique = 'depth_tangent'\n[output]\naovs = ['beauty', 'depth_tangent', 'albedo']\n");
    const PlanReport plan = reportPlan(config, scene, 1);
    int passes = 0;
    for (const auto& planned : plan.pipeline.plan.passes) {
        const Pass& pass = plan.pipeline.graph.passes[static_cast<std::size_t>(planned.pass)];
        if (pass.technique != "depth_tangent") continue;
        ++passes;
        ASSERT_EQ(pass.reads.size(), 1u);
        EXPECT_EQ(pass.reads[0].name, "depth");
    }
    EXPECT_EQ(passes, 1);
    const Picture p = draw(config, scene);
    const auto &beauty = p.aov("beauty").pixels, &factor = p.aov("depth_tangent").pixels,
               &albedo = p.aov("albedo").pixels;
    int dark = 0;
    for (std::size_t i = 0; i < factor.size(); ++i) {
        dark += factor[i] < 0.5f;
        const float alpha = albedo[4 * i + 3], expected = (albedo[4 * i] + (1 - alpha)) * factor[i];
        EXPECT_NEAR(beauty[4 * i], expected, 2e-3) << i;
    }
    EXPECT_GT(dark, 100);
    EXPECT_THROW(
        draw(makeConfig("[ao]\ntechnique = 'depth_tangent'\n[[edges]]\ntechnique = 'depth_tangent'\nreach = '3px'\n"),
            scene),
        Error)
        << "two settings for one image";
    EXPECT_THROW(draw(makeConfig("[ao]\ntechnique = 'depth_tangent'\nfilter = { technique = 'box' "
                                 "}\n[[edges]]\ntechnique = 'depth_tangent'\n"),
                     scene),
        Error);
}

TEST(Sections, showFilledFacesUnderHeavierLines) {
    // A hollow box, cut in the middle: a square ring of fill, 1 unit of 4 wide, seen from above in a picture of 8
    // units.
    const std::string outer = boxObj({-2, -2, -2}, {2, 2, 2});
    const LoadedScene scene = makeScene(
        "[[mesh]]\nname = 'o'\nfile = 'o.obj'\n[[section]]\nname = 'A'\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nfill = "
        "'#ff0000'\n"
            + cameraToml({0, 0, 9}, {0, 0, 0}, "orthographic_height = 8"),
        {{"o.obj", outer}});
    const auto red = [&](const std::string& sections) {
        const Picture p =
            draw(makeConfig(sections
                     + "[image]\nsize = [80, 80]\nsamples = 1\n[[edges]]\ntechnique = 'depth_normal'\nwidth = "
                       "'1px'\nsections = 3\n[output]\naovs = ['beauty', 'albedo', 'edges']\n"),
                scene);
        int count = 0;
        for (int i = 0; i < 80 * 80; ++i) count += p.aov("albedo").pixels[static_cast<std::size_t>(i) * 4] > 0.9f;
        double ink = 0;
        for (int i = 0; i < 80 * 80; ++i)
            ink += static_cast<double>(p.aov("edges").pixels[static_cast<std::size_t>(i) * 4 + 3]);
        return std::pair(count, ink);
    };
    const auto [without, thin] = red("");
    const auto [with, thick] = red("sections = ['A']\n");
    EXPECT_EQ(without, 0);
    EXPECT_EQ(with, 40 * 40);
    EXPECT_NEAR(thin, 160, 2);
    EXPECT_NEAR(thick, 3 * 160, 8) << "three times as heavy, but for its round corners";
    EXPECT_THROW(red("sections = ['B']\n"), Error);
}

TEST(Sections, areHatchedAsDenselyAsTheySay) {
    // Of a face, lines of a width at a distance cover their quotient, also where they are thinner than a pixel.
    for (const auto& [width, spacing, angle] :
        {std::tuple{2.0, 8.0, 30.0}, {0.5, 8.0, 45.0}, {3.0, 7.0, 0.0}, {1.0, 5.0, 90.0}}) {
        const LoadedScene scene = makeScene(
            fmt::format(
                "[[mesh]]\nname = 'o'\nfile = 'o.obj'\n[[section]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nfill = "
                "'#000000'\nhatch = '{}px'\nhatch_width = '{}px'\nhatch_angle = {}\nhatch_color = '#ffffff'\n",
                spacing, width, angle)
                + cameraToml({0, 0, 9}, {0, 0, 0}, "orthographic_height = 8"),
            {{"o.obj", boxObj({-20, -20, -2}, {20, 20, 2})}});
        const Picture p =
            draw(makeConfig("[image]\nsize = [560, 560]\nsamples = 1\n[output]\naovs = ['albedo']\n"), scene);
        double sum = 0;
        for (std::size_t i = 0; i < p.aov("albedo").pixels.size(); i += 4) sum += p.aov("albedo").pixels[i];
        // 560 pixels are a whole number of distances along the axes, and many at other angles.
        EXPECT_NEAR(sum / (560 * 560), width / spacing, 0.01 * width / spacing) << width << " of " << spacing;
    }
}

}  // namespace
}  // namespace limn::test
