// Colours of vertices, and holes that materials cut.

#include "base/file.h"
#include "formats/obj.h"
#include "mesh/tri_mesh.h"
#include "settings/color.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace limn::test {
namespace {

constexpr int kSize = 120;

/// Seen square on, 4 units high: a pixel is 1/30.
const std::string kFront =
    fmt::format("[[camera]]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\northographic_height = 4\n");

RenderConfig config(const std::string& aovs, const std::string& more = "", int samples = 1) {
    return makeConfig(fmt::format("{}[image]\nsize = [{}, {}]\nsamples = {}\n[output]\naovs = [{}]\n",
                          more.starts_with("accuracy") ? more : "", kSize, kSize, samples, aovs)
        + (more.starts_with("accuracy") ? "" : more));
}

/// A triangle whose corners are red, green and blue.
const std::string kTriangle = "v -1.5 -1.5 0 1 0 0\nv 1.5 -1.5 0 0 1 0\nv 0 1.5 0 0 0 1\nf 1 2 3\n";

TEST(VertexColours, areLinearBetweenTheCorners) {
    const std::string scene = kFront + "[[mesh]]\nname = 't'\nfile = 't.obj'\n[[instance]]\nmesh = 't'\n";
    for (const char* accuracy : {"accuracy = 'exact'\n", "accuracy = 'fast'\n"}) {
        const Picture p = draw(config("'albedo', 'object_id'", accuracy), makeScene(scene, {{"t.obj", kTriangle}}));
        int seen = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                if (*p.aov("object_id").at(x, y) == 0) continue;
                const glm::dvec2 at((x + 0.5) / 30 - 2, 2 - (y + 0.5) / 30);
                const double blue = (at.y + 1.5) / 3, green = (at.x + 1.5 - 1.5 * blue) / 3;
                const double expected[] = {1 - green - blue, green, blue};
                // Half floats hold 1 to 1/2048; an encoded colour of 0 or 1 is exact.
                for (int k = 0; k < 3; ++k)
                    ASSERT_NEAR(p.aov("albedo").at(x, y)[k], expected[k], 1e-3) << accuracy << x << ' ' << y;
                ++seen;
            }
        EXPECT_GT(seen, 4000);
    }
}

TEST(VertexColours, tintTheMaterialThatWantsThem) {
    const std::string scene = kFront + "[[mesh]]\nname = 't'\nfile = 't.obj'\n[[material]]\nname = 'grey'\n"
        "color = '#bcbcbc'\n{}\n[[instance]]\nmesh = 't'\nmaterial = 'grey'\n";
    const std::string half = "v -9 -9 0 0.5 0.5 0.5\nv 9 -9 0 0.5 0.5 0.5\nv 0 9 0 0.5 0.5 0.5\nf 1 2 3\n";
    const auto albedo = [&](const char* line) {
        return *draw(config("'albedo'"), makeScene(fmt::format(fmt::runtime(scene), line), {{"t.obj", half}}))
                    .aov("albedo")
                    .at(60, 60);
    };
    EXPECT_NEAR(albedo(""), srgbToLinear(188 / 255.0f) * srgbToLinear(0.5f), 1e-3);
    EXPECT_NEAR(albedo("vertex_colors = false"), srgbToLinear(188 / 255.0f), 1e-3);
}

TEST(VertexColours, stayWithTheMeshThatHasThem) {
    const std::string scene = kFront + "[[mesh]]\nname = 'c'\nfile = 'c.obj'\n[[mesh]]\nname = 'p'\nfile = 'p.obj'\n";
    const std::string coloured = "v -9 -9 0 1 0 0\nv 0 -9 0 1 0 0\nv 0 9 0 1 0 0\nv -9 9 0 1 0 0\nf 1 2 3 4\n",
                      plain = "v 0 -9 0\nv 9 -9 0\nv 9 9 0\nv 0 9 0\nf 1 2 3 4\n";
    for (const char* accuracy : {"accuracy = 'exact'\n", "accuracy = 'fast'\n"}) {
        RenderConfig wanted = makeConfig(
            std::string(accuracy) + "[image]\nsize = [120, 120]\nsamples = 1\n[output]\naovs = ['albedo']\n");
        const Picture p = draw(wanted, makeScene(scene, {{"c.obj", coloured}, {"p.obj", plain}}));
        const float *left = p.aov("albedo").at(20, 60), *right = p.aov("albedo").at(100, 60);
        EXPECT_NEAR(left[0], 1, 1e-3) << accuracy;
        EXPECT_NEAR(left[1], 0, 1e-3);
        EXPECT_NEAR(right[0], kPaperGrey.r, 1e-3) << accuracy;
        EXPECT_NEAR(right[1], kPaperGrey.g, 1e-3);
    }
    // As triangles: no colours where there are none, and none that nobody asks for.
    for (const bool unified : {false, true}) {
        const auto colours = [&](const std::string& text, bool wants) {
            return buildTriMesh(parseObj(text, "m.obj").mesh, {.unified = unified, .colors = wants}).colors.size();
        };
        EXPECT_EQ(colours(plain, true), 0u);
        EXPECT_EQ(colours(coloured, false), 0u);
        EXPECT_GT(colours(coloured, true), 0u);
    }
}

/// A scene in a folder that lasts, since textures are read when it is drawn.
class Holes : public testing::Test {
protected:
    /// A grey image of 64 × 64 from what says where it is solid; u, v in 0 … 1.
    void mask(const std::string& name, const std::function<bool(double, double)>& isSolid) {
        std::string text = "P2\n64 64\n255\n";
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) text += isSolid((x + 0.5) / 64, 1 - (y + 0.5) / 64) ? "255 " : "0 ";
        replaceFile(folder_.path() / name, text);
    }
    /// A card two units wide in front of a wall; the card's material has this line.
    LoadedScene scene(const std::string& line, bool withCard = true, const std::string& camera = kFront) {
        replaceFile(folder_.path() / "wall.obj", quadObj({-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}));
        replaceFile(folder_.path() / "card.obj",
            "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
        std::string toml = camera + "[[light]]\ndirection = [1, 0, -1]\nshadow = { resolution = 1024 }\n"
            "[[mesh]]\nname = 'wall'\nfile = 'wall.obj'\n[[mesh]]\nname = 'card'\nfile = 'card.obj'\n"
            "[[material]]\nname = 'card'\ncolor = '#ff0000'\n" + line + "\n[[instance]]\nmesh = 'wall'\n";
        if (withCard) toml += "[[instance]]\nmesh = 'card'\nmaterial = 'card'\n";
        replaceFile(folder_.path() / "scene.toml", toml);
        return loadScene(folder_.path() / "scene.toml");
    }
    TemporaryFolder folder_;
};

const std::string kLooks =
    "[shading]\ntechnique = 'lambert'\n[ao]\ntechnique = 'ray_traced'\nradius = 2.0\n[[edges]]\ntechnique = "
    "'depth_normal'\n";

TEST_F(Holes, ofEverythingLeaveWhatLiesBehind) {
    mask("nothing.pgm", [](double, double) { return false; });
    const RenderConfig wanted = config("'beauty', 'depth', 'normal', 'ambient_occlusion', 'edges'", kLooks, 4);
    const Picture with = draw(wanted, scene("cutout = 'nothing.pgm'")), without = draw(wanted, scene("", false));
    for (const char* aov : {"beauty", "depth", "normal", "ambient_occlusion", "edges"})
        EXPECT_EQ(with.aov(aov).pixels, without.aov(aov).pixels) << aov;
}

TEST_F(Holes, ofNothingChangeNothing) {
    mask("all.pgm", [](double, double) { return true; });
    const RenderConfig wanted = config("'beauty', 'depth', 'object_id', 'ambient_occlusion'", kLooks, 4);
    const Picture with = draw(wanted, scene("cutout = 'all.pgm'")), without = draw(wanted, scene(""));
    for (const char* aov : {"beauty", "depth", "object_id", "ambient_occlusion"})
        EXPECT_EQ(with.aov(aov).pixels, without.aov(aov).pixels) << aov;
}

TEST_F(Holes, haveTheAreaAndTheShadowOfTheirMask) {
    // The left half of the card is there. With the light from the side at 45 degrees its shadow falls one unit to the
    // right.
    mask("left.pgm", [](double u, double) { return u < 0.5; });
    for (const char* accuracy : {"accuracy = 'exact'\n", "accuracy = 'fast'\n"}) {
        RenderConfig wanted = makeConfig(std::string(accuracy) + "[image]\nsize = [120, 120]\nsamples = 1\n"
            "[shading]\ntechnique = 'lambert'\nambient = 0\n[output]\naovs = ['depth', 'shade']\n");
        const Picture p = draw(wanted, scene("cutout = 'left.pgm'"));
        const auto depthAt = [&](double x, double y) {
            return *p.aov("depth").at(static_cast<int>((x + 2) * 30), static_cast<int>((2 - y) * 30));
        };
        const auto lightAt = [&](double x, double y) {
            return p.aov("shade").at(static_cast<int>((x + 2) * 30), static_cast<int>((2 - y) * 30))[1];
        };
        EXPECT_NEAR(depthAt(-0.5, 0), 5, 1e-4) << accuracy;
        EXPECT_NEAR(depthAt(0.5, 0), 6, 1e-4) << accuracy;
        // Bilinear alpha is one half exactly between the texels: half of the card, to a column of pixels.
        int solid = 0;
        for (const float depth : p.aov("depth").pixels) solid += depth < 5.5f;
        EXPECT_NEAR(solid, 30 * 60, 61) << accuracy;
        EXPECT_LT(lightAt(0.5, 0), 0.01f) << accuracy << "in the card's shadow";
        EXPECT_GT(lightAt(1.5, 0), 0.1f) << accuracy << "where the hole's shadow would be";
    }
}

TEST_F(Holes, keepTheirShareInTheDistance) {
    // Leaves of eight texels, and dots of two that soon melt into one grey: as much of the card is there from far as
    // from near.
    const std::pair<const char*, std::function<bool(double, double)>> masks[] = {
        {"leaves.pgm",
            [](double u, double v) { return std::hypot(std::fmod(u * 4, 1) - 0.5, std::fmod(v * 4, 1) - 0.5) < 0.35; }},
        {"dots.pgm", [](double u, double v) {
             return std::hypot(std::fmod(u * 8, 1) - 0.5, std::fmod(v * 8, 1) - 0.5) < 0.178;
         }}};
    constexpr int kSamples = 256;
    for (const auto& [name, isSolid] : masks) {
        mask(name, isSolid);
        const auto share = [&](double height, double side) {
            const std::string camera = fmt::format(
                "[[camera]]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\northographic_height = {}\n", height);
            const Picture p = draw(config("'shade'", "[shading]\ntechnique = 'flat'\n", kSamples),
                scene(fmt::format("cutout = '{}'", name), true, camera));
            const float wall = p.aov("shade").at(30, 60)[1];
            double solid = 0;
            for (int y = 0; y < kSize; ++y)
                for (int x = 30; x < 90; ++x) solid += 1 - static_cast<double>(p.aov("shade").at(x, y)[1] / wall);
            return solid / (side * side);
        };
        const double near = share(4.4, 60 / 1.1), far = share(16, 15);
        EXPECT_GT(near, 0.03) << name;
        // Three standard deviations of how often the samples of 15 × 15 pixels meet such a share by chance.
        EXPECT_NEAR(far / near, 1, 3 / std::sqrt(kSamples * 15 * 15 * near)) << name;
    }
}

TEST_F(Holes, haveLinesAlongThem) {
    // A disc of radius 0.6: its outline is a circle of that radius within a tenth of a pixel on the mean, from one
    // sample.
    mask("disc.pgm", [](double u, double v) { return std::hypot(u - 0.5, v - 0.5) < 0.3; });
    const Picture p =
        draw(config("'edges'", "[[edges]]\ntechnique = 'depth_normal'\nwidth = '1px'\n"), scene("cutout = 'disc.pgm'"));
    double weight = 0, radius = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const double alpha = static_cast<double>(p.aov("edges").at(x, y)[3]);
            weight += alpha;
            radius += alpha * std::hypot(x + 0.5 - 60, y + 0.5 - 60);
        }
    EXPECT_NEAR(radius / weight, 18, 0.1);
    EXPECT_NEAR(weight, 2 * 3.14159265 * 18, 8) << "once around; texels make its way a little longer";
}

/// A square from -1 to 1 with these texture coordinates at its corners, seen from above, with a picture of 2 × 2
/// texels: red and green below, blue and white above.
Image textured(const std::string& material, double low, double high, const char* more = "") {
    const TemporaryFolder folder;
    const auto write = [&](const char* name, std::string_view text) { replaceFile(folder.path() / name, text); };
    using namespace std::string_literals;
    write("t.ppm", "P6 2 2 255\n\0\0\xff\xff\xff\xff\xff\0\0\0\xff\0"s);
    write("q.obj",
        fmt::format("vt {0} {0}\nvt {1} {0}\nvt {1} {1}\nvt {0} {1}\n", low, high)
            + "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1/1 2/2 3/3 4/4\n");
    write("scene.toml",
        "[[mesh]]\nname = 'q'\nfile = 'q.obj'\n[[instance]]\nmesh = 'q'\nmaterial = 'a'\n[[material]]\nname = "
        "'a'\ncolor = '#ffffff'\ntexture = 't.ppm'\n"
            + material + "\n" + cameraToml({0, 0, 5}, {0, 0, 0}, "orthographic_height = 2"));
    return draw(makeConfig(std::string(more) + "[image]\nsize = [80, 80]\nsamples = 1\n[output]\naovs = ['albedo']\n"),
        loadScene(folder.path() / "scene.toml"))
        .aov("albedo");
}

TEST(Textures, arePlacedAsTheirCoordinatesWouldBe) {
    for (const char* accuracy : {"accuracy = 'exact'\n", "accuracy = 'fast'\n"})
        for (const char* filter : {"texture_filter = 'linear'", "texture_filter = 'nearest'"}) {
            const auto distance = [](const Image& a, const Image& b) {
                double sum = 0;
                for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(a.pixels[i] - b.pixels[i]);
                return sum / static_cast<double>(a.pixels.size());
            };
            const Image byMaterial =
                            textured(std::string(filter) + "\ntexture_scale = [4, 4]\ntexture_offset = [0.25, 0.25]", 0,
                                1, accuracy),
                        byMesh = textured(filter, 0.25, 4.25, accuracy);
            // What interpolation rounds shows where one texel ends at once.
            EXPECT_LT(distance(byMaterial, byMesh), 1e-4) << accuracy << filter;
            EXPECT_GT(distance(byMaterial, textured(filter, 0, 4, accuracy)), 0.1);
        }
}

TEST(Textures, areSharpOrSmoothAndEndAsTheySay) {
    const auto at = [](const Image& image, int x, int y) {
        const float* p = image.at(x, y);
        return glm::vec3(p[0], p[1], p[2]);
    };
    // Sharp, and by itself so: each quarter has its texel's colour up to its border.
    for (const char* filter : {"texture_filter = 'nearest'", "texture_filter = 'automatic'"}) {
        const Image sharp = textured(filter, 0, 1);
        for (const int x : {1, 20, 38}) {
            EXPECT_EQ(at(sharp, x, 78), glm::vec3(1, 0, 0)) << filter << x;
            EXPECT_EQ(at(sharp, x + 40, 78), glm::vec3(0, 1, 0));
            EXPECT_EQ(at(sharp, x, 1), glm::vec3(0, 0, 1));
        }
    }
    // Smooth: half way between the texels' middles their mean.
    const glm::vec3 between = at(textured("texture_filter = 'linear'", 0, 1), 40, 60);
    EXPECT_NEAR(between.r, 0.5, 0.02);
    EXPECT_NEAR(between.g, 0.5, 0.02);
    // Beyond the image: again, or its border.
    const Image again = textured("texture_filter = 'nearest'", 0, 2),
                border = textured("texture_filter = 'nearest'\ntexture_repeats = false", 0, 2);
    EXPECT_EQ(at(again, 50, 70), glm::vec3(1, 0, 0));
    EXPECT_EQ(at(border, 50, 70), glm::vec3(0, 1, 0));
    EXPECT_EQ(at(border, 10, 10), glm::vec3(0, 0, 1));
}

// Parts of one OBJ have their own place, material and lines through meshes that take some of them.
TEST(Parts, ofOneFileAreAddressed) {
    const std::string obj = "o left\n" + quadObj({-3, -1, 0}, {-1, -1, 0}, {-1, 1, 0}, {-3, 1, 0}) + "o right wing\n"
        + quadObj({1, -1, 0}, {3, -1, 0}, {3, 1, 0}, {1, 1, 0});
    const auto shot = [&](const std::string& scene) {
        return draw(makeConfig("shading = 'flat'\n[image]\nsize = [80, 40]\nsamples = 1\n[output]\naovs = ['beauty', "
                               "'object_id']\n"),
            makeScene(scene + cameraToml({0, 0, 50}, {0, 0, 0}, "orthographic_height = 4"), {{"m.obj", obj}}));
    };
    const auto covered = [](const Picture& p, int from, int to) {
        int count = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = from; x < to; ++x) count += *p.aov("object_id").at(x, y) > 0;
        return count;
    };
    const std::string mesh = "[[mesh]]\nname = 'm'\nfile = 'm.obj'\n";
    const Picture whole = shot(mesh), one = shot(mesh + "parts = ['right*']\n"),
                  rest = shot(mesh + "without_parts = ['right*']\n");
    EXPECT_EQ(covered(one, 0, 40), 0);
    EXPECT_EQ(covered(one, 40, 80), covered(whole, 40, 80));
    EXPECT_EQ(covered(rest, 40, 80), 0);
    EXPECT_EQ(covered(rest, 0, 40), covered(whole, 0, 40));
    const Picture moved = shot(
        "[[mesh]]\nname = 'a'\nfile = 'm.obj'\nparts = ['left']\n[[mesh]]\nname = 'b'\nfile = "
        "'m.obj'\nparts = ['right wing']\n[[instance]]\nmesh = 'a'\n[[instance]]\nmesh = "
        "'b'\nmaterial = 'red'\ntranslate = [0, 1, 0]\n[[material]]\nname = 'red'\ncolor = '#ff0000'\n");
    EXPECT_EQ(*moved.aov("object_id").at(60, 35), 0) << "moved up";
    EXPECT_GT(moved.aov("beauty").at(60, 12)[0], 0.99f);
    EXPECT_LT(moved.aov("beauty").at(60, 12)[1], 0.01f);
    EXPECT_GT(moved.aov("beauty").at(20, 20)[1], 0.1f) << "the other keeps its own";
    try {
        shot(mesh + "parts = ['rigth*']\n");
        ADD_FAILURE() << "no part is called so";
    } catch (const Errors& errors) { EXPECT_NE(errors.list.front().message.find("no part of"), std::string::npos); }
}

}  // namespace
}  // namespace limn::test
