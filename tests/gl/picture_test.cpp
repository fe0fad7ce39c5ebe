// Properties of finished pictures: alpha, crops, samples, ids, shadows, textures.

#include "settings/color.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace limn::test {
namespace {

const std::string kScene =
    "[[mesh]]\nname = 'm'\nfile = 'm.obj'\n[[camera]]\nposition = [3, 4, 6]\nlook_at = [0, 0.5, "
    "-1]\n[[light]]\ndirection = [-1, -2, -1]\nshadow = { resolution = 512 }\n";
const std::string kAll =
    "[shading]\ntechnique = 'toon'\n[ao]\ntechnique = 'toon_ssao'\nfilter = { technique = 'gaussian' "
    "}\n[[edges]]\ntechnique = 'depth_normal'\ncolor = '#204060'\nopacity = 0.6\n";

LoadedScene mixedScene() { return makeScene(kScene, {{"m.obj", mixedObj()}}); }

TEST(Picture, transparentPicturesCompositeToOpaqueOnes) {
    const LoadedScene scene = mixedScene();
    const Picture clear = draw(makeConfig("[image]\nsize = [120, 80]\nbackground = 'transparent'\n" + kAll), scene);
    for (const char* background : {"#000000", "#ffffff", "#c04080"}) {
        const Picture opaque =
            draw(makeConfig(fmt::format("[image]\nsize = [120, 80]\nbackground = '{}'\n", background) + kAll), scene);
        const Color color = *parseHexColor(background);
        const float rgb[] = {color.r, color.g, color.b};
        float worst = 0;
        for (std::size_t i = 0; i < clear.aov("beauty").pixels.size(); i += 4)
            for (std::size_t c = 0; c < 3; ++c) {
                const float over = clear.aov("beauty").pixels[i + c] + rgb[c] * (1 - clear.aov("beauty").pixels[i + 3]);
                worst = std::max(worst, std::abs(over - opaque.aov("beauty").pixels[i + c]));
            }
        EXPECT_LT(worst, 5e-4f) << "half floats between passes keep eleven bits";
    }
}

TEST(Picture, aCropIsThatPartOfTheWhole) {
    const LoadedScene scene = mixedScene();
    const RenderConfig config = makeConfig("[image]\nsize = [120, 80]\n" + kAll);
    const Picture whole = draw(config, scene);
    RenderOptions options;
    options.crop = {{31, 17}, {40, 23}};
    const Picture part = draw(config, scene, options);
    ASSERT_EQ(part.aov("beauty").width, 40);
    for (int y = 0; y < 23; ++y)
        for (int x = 0; x < 40; ++x)
            for (int c = 0; c < 4; ++c)
                ASSERT_EQ(part.aov("beauty").at(x, y)[c], whole.aov("beauty").at(31 + x, 17 + y)[c]);
}

TEST(Picture, samplesAverageToTheSamePicture) {
    // However samples are split between a finer raster and sub-frames, more of them approach one picture.
    const LoadedScene scene = mixedScene();
    const auto mean = [&](int samples) {
        const Picture p =
            draw(makeConfig(fmt::format("[image]\nsize = [96, 64]\nsamples = {}\n", samples) + kAll), scene);
        return p.aov("beauty").pixels;
    };
    const auto truth = mean(64);
    const auto rmse = [&](const std::vector<float>& pixels) {
        double sum = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) sum += (pixels[i] - truth[i]) * (pixels[i] - truth[i]);
        return std::sqrt(sum / static_cast<double>(pixels.size()));
    };
    const double one = rmse(mean(1)), four = rmse(mean(4)), five = rmse(mean(5)), sixteen = rmse(mean(16));
    EXPECT_LT(four, one * 0.65);
    EXPECT_LT(five, one * 0.65) << "five is split into sub-frames alone, four into a finer raster alone";
    EXPECT_LT(sixteen, four * 0.75);
}

TEST(Picture, sampleSplitIsExactAndFits) {
    for (int n = 1; n <= 64; ++n) {
        const Sampling split = splitSamples(n, {1280, 720}, 16384);
        EXPECT_EQ(split.samples(), n);
    }
    EXPECT_EQ(splitSamples(16, {1280, 720}, 16384).raster, 4);
    EXPECT_EQ(splitSamples(16, {16000, 720}, 16384).raster, 1) << "beyond the driver";
    EXPECT_EQ(splitSamples(4, {8000, 8000}, 65536).raster, 1) << "beyond the memory that the fine raster may take";
}

TEST(Picture, dataIsTakenAtPixelCentres) {
    const LoadedScene scene = mixedScene();
    const std::string aovs = "[output]\naovs = ['beauty', 'depth', 'normal', 'object_id', 'material_id', 'position']\n";
    const Picture one = draw(makeConfig("[image]\nsize = [96, 64]\nsamples = 1\n" + aovs), scene),
                  many = draw(makeConfig("[image]\nsize = [96, 64]\nsamples = 8\n" + aovs), scene);
    for (const char* name : {"depth", "normal", "object_id", "material_id", "position"})
        EXPECT_EQ(one.aov(name).pixels, many.aov(name).pixels) << name;
    EXPECT_NE(one.aov("beauty").pixels, many.aov("beauty").pixels);
}

TEST(Picture, positionsLieWhereDepthSays) {
    const LoadedScene scene = mixedScene();
    const Picture p = draw(makeConfig("[image]\nsize = [96, 64]\nsamples = 1\n[output]\naovs = ['depth', 'position', "
                                      "'normal_geometric', 'normal']\n"),
        scene);
    const glm::dvec3 eye(3, 4, 6), forward = glm::normalize(glm::dvec3(0, 0.5, -1) - eye);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            const float depth = *p.aov("depth").at(x, y);
            if (!std::isfinite(depth)) continue;
            const float* q = p.aov("position").at(x, y);
            EXPECT_NEAR(glm::dot(glm::dvec3(q[0], q[1], q[2]) - eye, forward), depth, 2e-6 * depth + 2e-6);
            for (const char* name : {"normal", "normal_geometric"}) {
                const float* n = p.aov(name).at(x, y);
                EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-6);
            }
        }
}

TEST(Picture, mirroredAndShearedInstancesStayRight) {
    // A sphere mirrored in x and one turned half a circle about y are the same surface: the same normals, the same
    // light.
    const std::string camera =
        "[[camera]]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nfov = 40\n[[light]]\ndirection = [-1, -1, "
        "-2]\n[[mesh]]\nname = 's'\nfile = 's.obj'\n[[instance]]\nmesh = 's'\n";
    const std::vector<std::pair<std::string, std::string>> sphere{{"s.obj", sphereObj(1, 64)}};
    const RenderConfig config = makeConfig(
        "[image]\nsize = [80, 80]\nsamples = 1\n[shading]\ntechnique = 'toon'\n[output]\naovs = ['normal', 'shade']\n");
    const Picture plain = draw(config, makeScene(camera, sphere)),
                  mirrored = draw(config, makeScene(camera + "scale = [-1, 1, 1]\n", sphere));
    double worst = 0;
    for (std::size_t i = 0; i < plain.aov("normal").pixels.size(); ++i)
        worst = std::max(
            worst, static_cast<double>(std::abs(plain.aov("normal").pixels[i] - mirrored.aov("normal").pixels[i])));
    EXPECT_LT(worst, 0.05) << "up to how the facets fall";
    // A sheared unit cube: its top face's normal must follow the inverse transpose.
    const Picture sheared = draw(
        makeConfig("[image]\nsize = [40, 40]\nsamples = 1\n[output]\naovs = ['normal', 'normal_geometric']\n"),
        makeScene("[[camera]]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nfov = 10\n[[mesh]]\nname = 'b'\nfile = "
                  "'b.obj'\n[[instance]]\nmesh = 'b'\nmatrix = [1, 0, 0, 0,  0, 1, 0, 0,  0.5, 0, 1, 0,  0, 0, 0, 1]\n",
            {{"b.obj", boxObj({-1, -1, -1}, {1, 1, 1})}}));
    const glm::dvec3 expected = glm::normalize(glm::dvec3(-0.5, 0, 1));
    for (const char* name : {"normal", "normal_geometric"})
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(sheared.aov(name).at(20, 20)[k], expected[k], 1e-6) << name;
}

TEST(Picture, aFlattenedInstanceIsDrawn) {
    const Picture p =
        draw(makeConfig("[image]\nsize = [40, 40]\nsamples = 1\n[output]\naovs = ['object_id', 'depth', 'normal']\n"),
            makeScene("[[camera]]\nposition = [0, 3, 0.5]\nlook_at = [0, 0, 0]\nfov = 40\n[[mesh]]\nname = 'b'\nfile = "
                      "'b.obj'\n[[instance]]\nmesh = 'b'\nscale = [1, 0, 1]\n",
                {{"b.obj", boxObj({-1, -1, -1}, {1, 1, 1})}}));
    EXPECT_EQ(*p.aov("object_id").at(20, 20), 1);
}

TEST(Picture, shadowsFallWhereTheyMust) {
    // A square lid 1 above the floor, the sun 45 degrees from the side: its shadow lies 1 further along.
    const std::string scene =
        "[[mesh]]\nname = 'f'\nfile = 'f.obj'\n[[mesh]]\nname = 'l'\nfile = 'l.obj'\n[[camera]]\nposition = [0, 10, "
        "0]\nlook_at = [0, 0, 0]\nup = [0, 0, -1]\northographic_height = 8\n[[light]]\nkind = '{}'\n{}\nshadow = {{ "
        "resolution = 1024 }}\n";
    const std::vector<std::pair<std::string, std::string>> files{
        {"f.obj", quadObj({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4})},
        {"l.obj", quadObj({-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1})}};
    const RenderConfig config = makeConfig(
        "[image]\nsize = [160, 160]\nsamples = 1\n[shading]\ntechnique = 'toon'\nbands = 2\nambient = 0\nextra_ambient "
        "= 0\n[output]\naovs = ['shade']\n");
    const auto lit = [](const Picture& p, double x, double z) {
        return *p.aov("shade").at(static_cast<int>((x + 4) * 20), static_cast<int>((z + 4) * 20)) > 0.2f;
    };
    const Picture sun = draw(
        config, makeScene(fmt::format(fmt::runtime(scene), "sun", "direction = [1, -1, 0]\nintensity = 1.3"), files));
    EXPECT_FALSE(lit(sun, 1.5, 0));
    EXPECT_FALSE(lit(sun, 1.9, 0.9));
    EXPECT_TRUE(lit(sun, 2.1, 0));
    EXPECT_TRUE(lit(sun, 1.5, 1.1));
    EXPECT_TRUE(lit(sun, -2, 0));
    // From a lamp 2 above the floor the lid's shadow is twice as large.
    const Picture lamp = draw(
        config, makeScene(fmt::format(fmt::runtime(scene), "point", "position = [0, 2, 0]\nintensity = 4"), files));
    EXPECT_FALSE(lit(lamp, 1.8, 1.8));
    EXPECT_TRUE(lit(lamp, 2.3, 0));
    EXPECT_TRUE(lit(lamp, 0, -2.3));
    const Picture spot = draw(config,
        makeScene(fmt::format(fmt::runtime(scene), "spot",
                      "position = [0, 2, 0]\ndirection = [0, -1, 0]\nangle = 120\nintensity = 4"),
            files));
    EXPECT_FALSE(lit(spot, 1.8, 1.8));
    EXPECT_TRUE(lit(spot, 2.4, 0));
    EXPECT_FALSE(lit(spot, 3.8, 0)) << "outside the cone";
}

TEST(Picture, shiftMovesThePictureAndKeepsVerticalsUpright) {
    const std::vector<std::pair<std::string, std::string>> files{{"b.obj", boxObj({-1, -1, -1}, {1, 1, 1})}};
    const auto centre = [&](const char* shift) {
        const Picture p = draw(makeConfig("[image]\nsize = [200, 100]\nsamples = 1\n[output]\naovs = ['object_id']\n"),
            makeScene(fmt::format("[[camera]]\nposition = [0, 0, 8]\nlook_at = [0, 0, 0]\nfov = 60\nshift = "
                                  "{}\n[[mesh]]\nname = 'b'\nfile = 'b.obj'\n",
                          shift),
                files));
        glm::dvec3 sum(0);
        for (int y = 0; y < 100; ++y)
            for (int x = 0; x < 200; ++x)
                if (*p.aov("object_id").at(x, y) > 0) sum += glm::dvec3(x + 0.5, y + 0.5, 1);
        return glm::dvec2(sum) / sum.z;
    };
    EXPECT_NEAR(centre("[0.1, 0]").x, 100 - 20, 0.01) << "a tenth of the longer side";
    EXPECT_NEAR(centre("[0, 0.1]").y, 50 + 20, 0.01) << "looking up moves things down";
}

TEST(Picture, exactAndFastAgree) {
    const LoadedScene scene = mixedScene();
    const std::string rest =
        "[image]\nsize = [160, 120]\nsamples = 1\n[output]\naovs = ['depth', 'object_id', 'normal', "
        "'normal_geometric', 'albedo', 'position', 'material_id']\n";
    const Picture exact = draw(makeConfig("accuracy = 'exact'\n" + rest), scene),
                  fast = draw(makeConfig("accuracy = 'fast'\n" + rest), scene);
    int differ = 0;
    for (std::size_t i = 0; i < exact.aov("object_id").pixels.size(); ++i) {
        const bool same = exact.aov("object_id").pixels[i] == fast.aov("object_id").pixels[i];
        differ += !same;
        if (same && std::isfinite(exact.aov("depth").pixels[i])) {
            EXPECT_NEAR(exact.aov("depth").pixels[i], fast.aov("depth").pixels[i], 1e-4) << i;
        }
    }
    EXPECT_LE(differ, 8) << "snapping moves edges by at most 1/512 pixel";
}

}  // namespace
}  // namespace limn::test
