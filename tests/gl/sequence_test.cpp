// Meshes with a file for each frame.

#include "base/file.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace limn::test {
namespace {

TEST(Sequence, drawsTheFileOfEachFrame) {
    const TemporaryFolder temporary;
    const std::filesystem::path folder = temporary.path() / "job#3";  // a sign in a folder's name means nothing
    std::filesystem::create_directory(folder);
    for (const int frame : {2, 3, 4})
        replaceFile(folder / fmt::format("wall_{:03}.obj", frame),
            quadObj({-9, -9, -frame}, {9, -9, -frame}, {9, 9, -frame}, {-9, 9, -frame}));
    const std::string scene =
        "[animation]\nframes = \"{}\"\n[[camera]]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\northographic_height = "
        "4\n[[mesh]]\nname = 'wall'\nfile = 'wall_###.obj'\n";
    replaceFile(folder / "scene.toml", fmt::format(fmt::runtime(scene), "2-4"));
    const RenderConfig config = makeConfig("[image]\nsize = [16, 16]\nsamples = 1\n[output]\naovs = ['depth']\n");
    const LoadedScene loaded = loadScene(folder / "scene.toml");
    const Bounds first = loaded.bounds;
    ContentKey key;
    for (const int frame : {2, 3, 4, 3}) {
        EXPECT_EQ(*draw(config, loaded, {}, frame).aov("depth").at(8, 8), 5 + frame);
        EXPECT_EQ(loaded.bounds.lo, first.lo) << "what is relative to the scene does not change from frame to frame";
        const ContentKey now = sceneAt(loaded, frameRequest(config, frame)).key;
        EXPECT_NE(now, key);
        key = now;
    }

    // A bad file fails its own frame only.
    for (const int frame : {2, 3}) EXPECT_EQ(*draw(config, loaded, {}, frame).aov("depth").at(8, 8), 5 + frame);
    replaceFile(folder / "wall_004.obj", "v 0 0 0\nf 1 2 3\n");
    EXPECT_THROW(renderer().render(config, loaded, 4, {}), Errors);
    for (const int frame : {3, 2}) EXPECT_EQ(*draw(config, loaded, {}, frame).aov("depth").at(8, 8), 5 + frame);

    replaceFile(folder / "scene.toml", fmt::format(fmt::runtime(scene), "1-6"));
    try {
        loadScene(folder / "scene.toml");
        FAIL() << "frames 1, 5 and 6 have no file";
    } catch (const Errors& errors) {
        ASSERT_EQ(errors.list.size(), 1u);
        EXPECT_EQ(errors.list[0].code, ExitCode::missingInput);
        EXPECT_NE(errors.list[0].problem.find("wall_001.obj' does not exist, nor do 2 more"), std::string::npos)
            << errors.list[0].problem;
    }
}

TEST(Sequence, mayBeginWithNothing) {
    const TemporaryFolder temporary;
    const std::filesystem::path& folder = temporary.path();
    replaceFile(folder / "m_1.obj", "# nothing yet\n");
    replaceFile(folder / "m_2.obj", sphereObj(1, 16));
    replaceFile(folder / "scene.toml",
        "[animation]\nframes = \"1-2\"\n[[mesh]]\nname = 'm'\nfile = 'm_#.obj'\n"
        "subdivision = { level = 1 }\n");
    const LoadedScene loaded = loadScene(folder / "scene.toml");
    for (const char* technique : {"hbao", "ray_traced"}) {
        const RenderConfig config =
            makeConfig(fmt::format("shading = 'toon'\n[image]\nsize = [32, 24]\nsamples = 2\n[ao]\ntechnique = '{}'\n"
                                   "[[edges]]\ntechnique = 'depth_normal'\n[output]\naovs = ['beauty', 'object_id']\n",
                technique));
        const Picture empty = draw(config, loaded, {}, 1), full = draw(config, loaded, {}, 2);
        for (const float id : empty.aov("object_id").pixels) ASSERT_EQ(id, 0);
        for (std::size_t i = 4; i < empty.aov("beauty").pixels.size(); ++i)
            ASSERT_EQ(empty.aov("beauty").pixels[i], empty.aov("beauty").pixels[i % 4]) << "background alone";
        EXPECT_EQ(*full.aov("object_id").at(16, 12), 1);
    }
}

}  // namespace
}  // namespace limn::test
