// Sessions: what is loaded stays, and what has changed since is known.

#include "job/session.h"
#include "base/file.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace limn::test {
namespace {

using Paths = std::vector<std::filesystem::path>;

TEST(Session, knowsWhichFilesChanged) {
    const TemporaryFolder folder;
    const auto scene = folder.path() / "scene.toml", wall = folder.path() / "wall.obj",
               wood = folder.path() / "wood.mtl";
    replaceFile(wall, "mtllib wood.mtl\nusemtl oak\n" + quadObj({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}));
    replaceFile(wood, "newmtl oak\nKd 0.25 0.5 0.75\n");
    replaceFile(scene,
        "[[mesh]]\nname = 'wall'\nfile = 'wall.obj'\n[[camera]]\nposition = [0, 0, 5]\nlook_at = [0, 0, "
        "0]\nfov = 40\n");
    RenderConfig config = makeConfig("[image]\nsize = [8, 8]\nsamples = 1\n[output]\naovs = ['albedo', 'depth']\n");
    config.scene = scene;

    Session session;
    const auto albedo = [&] { return session.draw(config, 1).layers[0].image.pixels; };
    const LoadedScene* first = &session.load(config);
    const auto before = albedo();
    EXPECT_NEAR(before[0], 0.25, 1e-3);
    EXPECT_EQ(session.changedFiles(), Paths());
    EXPECT_EQ(&session.load(config), first) << "loaded once";

    replaceFile(wood, "newmtl oak\nKd 0.5 0.5 0.75 \n");
    EXPECT_EQ(session.changedFiles(), Paths{wood});
    EXPECT_EQ(albedo(), before) << "until it is forgotten";
    session.forget(config);
    EXPECT_EQ(session.changedFiles(), Paths());
    EXPECT_NEAR(albedo()[0], 0.5, 1e-3);

    std::filesystem::remove(wall);
    EXPECT_EQ(session.changedFiles(), Paths{wall}) << "gone is changed";
}

TEST(Session, plansWithoutADevice) {
    const TemporaryFolder folder;
    replaceFile(folder.path() / "box.obj", boxObj({0, 0, 0}, {1, 1, 1}));
    RenderConfig config = makeConfig("shading = 'toon'\n");
    config.scene = folder.path() / "box.obj";
    Session session({.device = {.device = "no such device"}, .shaderFolder = {}});
    EXPECT_GT(session.plan(config, 1).pipeline.plan.passes.size(), 2u);
    EXPECT_THROW(session.draw(config, 1), Error);
}

TEST(Session, drawsWithTheMeshesThatWereMadeAhead) {
    const TemporaryFolder folder;
    replaceFile(folder.path() / "ball.obj", sphereObj(1, 16));
    replaceFile(folder.path() / "scene.toml",
        "[[mesh]]\nname = 'ball'\nfile = 'ball.obj'\nsubdivision = { level = 2 }\n[[camera]]\nposition = [0, 0, 5]\n"
        "look_at = [0, 0, 0]\n");
    RenderConfig config = makeConfig("[image]\nsize = [32, 24]\nsamples = 1\n[shading]\ntechnique = 'toon'\n");
    config.scene = folder.path() / "scene.toml";
    const auto parts = [&](Session& session) {
        std::vector<std::string> names;
        for (const auto& part : session.draw(config, 1).times) names.push_back(part.name);
        return names;
    };
    const auto has = [](const std::vector<std::string>& names, const char* name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    Session ahead, plain;
    ahead.makeAhead(config, 1);
    EXPECT_TRUE(has(parts(ahead), "triangles (made ahead)"))
        << "making them again would cost as much as the first time";
    EXPECT_TRUE(has(parts(plain), "triangles (made in parallel)"));
    EXPECT_FALSE(has(parts(plain), "triangles (made in parallel)")) << "they are kept";
}

}  // namespace
}  // namespace limn::test
