// A frame brings to the GPU only what the one before it did not: counted at the GL entry points.

#include "base/file.h"
#include "cost/counting.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace limn::test {
namespace {

constexpr int kSides = 48;  // of the large sphere that never changes

/// Bytes handed over and textures made for frame 2, after frame 1, by a renderer of its own.
Counts secondFrame(
    const std::string& camera, const std::string& material, const std::string& files, const std::string& config = "") {
    const TemporaryFolder folder;
    replaceFile(folder.path() / "large.obj", sphereObj(1, kSides));
    replaceFile(folder.path() / "small_1.obj", boxObj({2, 0, 0}, {3, 1, 1}));
    replaceFile(folder.path() / "small_2.obj", boxObj({2, 0, 0}, {3, 2, 1}));
    replaceFile(folder.path() / "scene.toml",
        fmt::format("[animation]\nframes = '1-2'\n[[mesh]]\nname = 'large'\nfile = 'large.obj'\n[[mesh]]\nname = "
                    "'small'\nfile = '{}'\n[[camera]]\nposition = {}\nlook_at = [0, 0, 0]\n[[material]]\nname = "
                    "'paint'\ncolor = {}\n[[instance]]\nmesh = 'large'\nmaterial = 'paint'\n[[instance]]\nmesh = "
                    "'small'\n[[light]]\ndirection = [-1, -2, -1]\n",
            files, camera, material));
    const LoadedScene loaded = loadScene(folder.path() / "scene.toml");
    const RenderConfig parsed =
        makeConfig("[image]\nsize = [64, 48]\nsamples = 2\n[shading]\ntechnique = 'toon'\n" + config);
    Renderer renderer{gl::DeviceOptions{}};
    const RenderedFrame first = renderer.render(parsed, loaded, 1, {});
    const Counting counting;
    const RenderedFrame second = renderer.render(parsed, loaded, 2, {});
    const bool changes = camera.starts_with("{") || material.starts_with("{") || files.find('#') != std::string::npos;
    EXPECT_EQ(first.layers[0].image.pixels != second.layers[0].image.pixels, changes);
    return counts();
}

const std::string kStill = "[1, 2, 6]", kPaint = "'#804020'", kFile = "small_1.obj";
const std::string kMoving = "{ keys = [[1, [1, 2, 6]], [2, [2, 2, 6]]] }";
const std::string kFading = "{ keys = [[1, '#804020'], [2, '#208040']] }";

TEST(Frames, bringOnlyWhatChanged) {
    secondFrame(kMoving, kFading, "small_#.obj");  // calls every entry point once
    const Counts still = secondFrame(kStill, kPaint, kFile), camera = secondFrame(kMoving, kPaint, kFile),
                 material = secondFrame(kStill, kFading, kFile), mesh = secondFrame(kStill, kPaint, "small_#.obj");
    EXPECT_EQ(camera.uploadedBytes, still.uploadedBytes) << "a keyed camera brings nothing that a still does not";
    EXPECT_EQ(material.uploadedBytes, still.uploadedBytes + 2 * 96) << "a keyed material its list of materials";
    // Eight vertices and as many more as triangles need to be numbered, twelve triangles, their normals and numbers.
    EXPECT_GT(mesh.uploadedBytes, still.uploadedBytes + 8 * 12 + 12 * 12);
    EXPECT_LT(mesh.uploadedBytes, still.uploadedBytes + 2000) << "a mesh sequence its own mesh, and no other";
    EXPECT_LT(still.uploadedBytes + 2000, kSides * kSides / 2 * 12u) << "the bound above says something";
    for (const Counts& counted : {still, camera, material, mesh}) {
        EXPECT_EQ(counted.textures, 0) << "images are kept";
        EXPECT_EQ(counted.textureBytes, 0u);
    }
}

struct ShadowCase {
    const char* what;
    std::string camera, light, file;
    int maps;  ///< drawn again for the second frame
};

// Maps know nothing of the camera: they are drawn again when something moves that their light sees. Either way the
// second frame has the bits of a renderer that saw no other.
TEST(Frames, drawShadowMapsOnlyWhereWhatTheyShowChanged) {
    const std::string still = "direction = [-1, -2, -1]";
    const ShadowCase cases[] = {
        {"still", kStill, still, kFile, 0},
        {"camera", kMoving, still, kFile, 0},
        {"light's colour", kStill, still + "\ncolor = { keys = [[1, '#ffffff'], [2, '#ff0000']] }", kFile, 0},
        {"light", kStill, "direction = { keys = [[1, [-1, -2, -1]], [2, [1, -2, -1]]] }", kFile, 1},
        {"mesh", kStill, still, "small_#.obj", 1},
    };
    int bare = 0;
    for (const auto& c : cases) {
        const TemporaryFolder folder;
        replaceFile(folder.path() / "small_1.obj", boxObj({2, 0, 0}, {3, 1, 1}));
        replaceFile(folder.path() / "small_2.obj", boxObj({2, 0, 0}, {3, 2, 1}));
        replaceFile(folder.path() / "floor.obj", boxObj({-4, -1, -4}, {4, 0, 4}));
        replaceFile(folder.path() / "scene.toml",
            fmt::format("[animation]\nframes = '1-2'\n[[mesh]]\nfile = 'floor.obj'\nname = 'floor'\n[[mesh]]\nname = "
                        "'small'\nfile = '{}'\n[[camera]]\nposition = {}\nlook_at = [0, 0, 0]\n[[light]]\n{}\n"
                        "shadow = {{ resolution = 256 }}\n",
                c.file, c.camera, c.light));
        const LoadedScene loaded = loadScene(folder.path() / "scene.toml");
        const RenderConfig config =
            makeConfig("[image]\nsize = [64, 48]\nsamples = 2\n[shading]\ntechnique = 'toon'\n");
        Renderer renderer{gl::DeviceOptions{}}, fresh{gl::DeviceOptions{}};
        renderer.render(config, loaded, 1, {});
        const auto expected = fresh.render(config, loaded, 2, {});
        const Counting counting;
        const auto second = renderer.render(config, loaded, 2, {});
        const int draws = counts().draws;
        if (bare == 0) bare = draws;
        EXPECT_EQ(draws, bare + c.maps) << c.what;
        EXPECT_EQ(second.layers[0].image.pixels, expected.layers[0].image.pixels) << c.what;
    }
}

// The same with what rays are traced against: there is no count for that tree, but the picture must follow the mesh.
TEST(Frames, raysFollowTheMesh) {
    secondFrame(kStill, kPaint, "small_#.obj", "[ao]\ntechnique = 'ray_traced'\nradius = 2\n");
}

}  // namespace
}  // namespace limn::test
