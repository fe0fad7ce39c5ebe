// What nothing asks for costs nothing: counted at the GL entry points, not from our own bookkeeping.

#include "cost/counting.h"
#include "render/report.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace limn::test {
namespace {

const std::string kScene =
    "[[mesh]]\nname = 'm'\nfile = 'm.obj'\n[[camera]]\nposition = [3, 4, 6]\nlook_at = [0, 0.5, "
    "-1]\n[[light]]\ndirection = [-1, -2, -1]\n";
const std::string kBase = "[image]\nsize = [96, 64]\nsamples = 4\n";

struct Drawn {
    Counts counts;
    std::vector<float> beauty;
};

/// Draws once with everything, uncounted: libepoxy replaces each entry point by the driver's at its first call.
void resolveEntryPoints() {
    static const bool resolved = [] {
        Renderer first{gl::DeviceOptions{}};
        const LoadedScene loaded = makeScene(kScene + "shadow = {}\n", {{"m.obj", mixedObj()}});
        first.render(makeConfig(kBase
                         + "[shading]\ntechnique = 'toon'\n[ao]\ntechnique = 'toon_ssao'\n[[edges]]\ntechnique = "
                           "'depth_normal'\n"),
            loaded, 1, {});
        return true;
    }();
    static_cast<void>(resolved);
}

Drawn run(const std::string& config, const std::string& scene = kScene, const std::string& mesh = mixedObj()) {
    resolveEntryPoints();
    // A renderer of its own: nothing is left over from another picture.
    Renderer fresh{gl::DeviceOptions{}};
    const LoadedScene loaded = makeScene(scene, {{"m.obj", mesh}});
    const RenderConfig parsed = makeConfig(kBase + config);
    const Counting counting;
    const RenderedFrame frame = fresh.render(parsed, loaded, 1, {});
    return {counts(), frame.layers.front().image.pixels};
}

TEST(Cost, anEffectThatNothingReadsCostsExactlyNothing) {
    const std::string toon = "[shading]\ntechnique = 'toon'\n", flat = "[shading]\ntechnique = 'flat'\n";
    const Drawn bareToon = run(toon), bareFlat = run(flat);
    struct Case {
        const char* what;
        std::string config;
        const Drawn& bare;
    };
    const Case cases[] = {
        {"ambient occlusion of strength 0 under toon",
            "[shading]\ntechnique = 'toon'\nao_strength = 0\n[ao]\ntechnique = 'toon_ssao'\nfilter = { technique = "
            "'gaussian' }\n",
            bareToon},
        {"ambient occlusion of strength 0 under flat",
            "[shading]\ntechnique = 'flat'\nao_strength = 0\n[ao]\ntechnique = 'toon_ssao'\n", bareFlat},
        {"lines of opacity 0", toon + "[[edges]]\ntechnique = 'depth_normal'\nopacity = 0\n", bareToon},
    };
    for (const auto& c : cases) {
        const Drawn with = run(c.config);
        EXPECT_EQ(with.counts.draws, c.bare.counts.draws) << c.what;
        EXPECT_EQ(with.counts.dispatches, c.bare.counts.dispatches) << c.what;
        EXPECT_EQ(with.counts.programs, c.bare.counts.programs) << c.what;
        EXPECT_EQ(with.counts.textures, c.bare.counts.textures) << c.what;
        EXPECT_EQ(with.counts.textureBytes, c.bare.counts.textureBytes) << c.what;
        EXPECT_EQ(with.counts.framebuffers, c.bare.counts.framebuffers) << c.what;
        EXPECT_EQ(with.counts.bufferBytes, c.bare.counts.bufferBytes) << c.what;
        EXPECT_EQ(with.beauty, c.bare.beauty) << c.what << ": the picture's bits";
    }
}

TEST(Cost, everyEffectThatIsReadIsCounted) {
    // The test above could not fail if the counters did not count.
    const Drawn bare = run("[shading]\ntechnique = 'toon'\n");
    const Drawn ao = run("[shading]\ntechnique = 'toon'\n[ao]\ntechnique = 'toon_ssao'\n");
    const Drawn edges = run("[shading]\ntechnique = 'toon'\n[[edges]]\ntechnique = 'depth_normal'\n");
    const Drawn shadow = run("[shading]\ntechnique = 'toon'\n", kScene + "shadow = {}\n");
    const auto passes = [](const Drawn& r) { return r.counts.draws + r.counts.dispatches; };
    // Four samples: one AO pass each; detection, two masks, places, pieces and strokes each; one shadow map for all of
    // them.
    EXPECT_EQ(passes(ao), passes(bare) + 4);
    EXPECT_EQ(passes(edges), passes(bare) + 4 * 6);
    EXPECT_EQ(passes(shadow), passes(bare) + 1);
    EXPECT_GT(ao.counts.textureBytes, bare.counts.textureBytes);
    EXPECT_GE(shadow.counts.textureBytes, bare.counts.textureBytes + 2048u * 2048 * 4);
    EXPECT_NE(ao.beauty, bare.beauty);
    EXPECT_NE(shadow.beauty, bare.beauty);
}

TEST(Cost, attributesThatNobodyReadsAreNotUploaded) {
    // Flat colours need neither normals nor lights; depth alone needs no materials.
    const Drawn toon = run("[shading]\ntechnique = 'toon'\n"), flat = run("[shading]\ntechnique = 'flat'\n"),
                depth = run("[output]\naovs = ['depth']\n");
    EXPECT_GT(toon.counts.bufferBytes, flat.counts.bufferBytes);
    EXPECT_GT(flat.counts.bufferBytes, depth.counts.bufferBytes);
    EXPECT_EQ(depth.counts.draws + depth.counts.dispatches, 4)
        << "visibility, where boxes stand on the floor what faces the eye and what does not, resolve";
}

TEST(Cost, aSceneWithoutCoincidentFacesDrawsNothingTwice) {
    const Drawn one = run("[output]\naovs = ['depth']\n", kScene, sphereObj(1, 12));
    EXPECT_EQ(one.counts.draws + one.counts.dispatches, 2) << "visibility and resolve, once";
    const Drawn two = run("[output]\naovs = ['depth']\n",
        kScene + "[[instance]]\nmesh = 'm'\n[[instance]]\nmesh = 'm'\n", sphereObj(1, 12));
    EXPECT_EQ(two.counts.draws + two.counts.dispatches, 3) << "and what must be seen of two in one place";
}

TEST(Cost, highlightsAreComputedWhereSomeMaterialHasThem) {
    const LoadedScene dull = makeScene(kScene, {{"m.obj", mixedObj()}});
    const LoadedScene shiny = makeScene(
        kScene + "[[material]]\nname = 'shiny'\nshininess = 20\n[[instance]]\nmesh = 'm'\nmaterial = 'shiny'\n",
        {{"m.obj", mixedObj()}});
    const auto readsMaterials = [](const LoadedScene& scene, const std::string& config) {
        const PlanReport plan = reportPlan(makeConfig(kBase + config), scene, 1);
        for (const auto& planned : plan.pipeline.plan.passes)
            for (const auto& read : plan.pipeline.graph.passes[static_cast<std::size_t>(planned.pass)].reads)
                if (read.name == "materialId") return true;
        return false;
    };
    for (const std::string shading : {"'toon'", "'blinn_phong'\nexponent = 0"}) {
        const std::string config = "[shading]\ntechnique = " + shading + "\n";
        EXPECT_FALSE(readsMaterials(dull, config)) << shading;
        EXPECT_TRUE(readsMaterials(shiny, config)) << shading;
        EXPECT_FALSE(readsMaterials(shiny, config + "specular = 0\n")) << shading;
    }
}

TEST(Cost, planOfTheBarePictureNamesNoEffect) {
    const LoadedScene loaded = makeScene(kScene, {{"m.obj", mixedObj()}});
    const PlanReport plan = reportPlan(makeConfig(kBase + "[shading]\ntechnique = 'toon'\n"), loaded, 1);
    for (const auto& pass : plan.pipeline.graph.passes)
        EXPECT_TRUE(pass.slot != "ao" && pass.slot != "filter" && pass.slot != "edges" && pass.slot != "shadow")
            << pass.name;
}

}  // namespace
}  // namespace limn::test
