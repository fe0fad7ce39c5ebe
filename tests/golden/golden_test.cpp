// One picture, kept. It must match, and it must *not* match when a parameter moves by 2 %: a golden that everything
// passes shows nothing.

#include "job/frame_files.h"
#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace limn::test {
namespace {

/// Share of values further apart than an eighth of a percent, and the largest difference.
struct Difference {
    double share = 0, largest = 0;
};

Difference compare(const Image& a, const Image& b) {
    Difference d;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const double difference = std::abs(static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i]));
        d.largest = std::max(d.largest, difference);
        d.share += difference > 0.00125 ? 1.0 / static_cast<double>(a.pixels.size()) : 0;
    }
    return d;
}

RenderedFrame drawRoom(const std::vector<std::string>& settings, const LoadedScene& scene) {
    const std::filesystem::path file = std::filesystem::path(LIMN_SOURCE_DIR) / "render_configs/figure1_both.toml";
    ConfigOverrides overrides;
    overrides.settings = {
        "image.size=[320,180]", "image.samples=4", "output.aovs=[\"beauty\"]", "output.path=\"golden.exr\""};
    overrides.settings.insert(overrides.settings.end(), settings.begin(), settings.end());
    return renderer().render(readRenderConfig(file, overrides), scene, 1, {});
}

TEST(Golden, theRoom) {
    const std::filesystem::path golden = std::filesystem::path(LIMN_SOURCE_DIR) / "tests/golden/room.exr";
    const LoadedScene scene = loadScene(std::filesystem::path(LIMN_SOURCE_DIR) / "scenes/room/scene.toml");
    const RenderedFrame now = drawRoom({}, scene);
    if (std::getenv("LIMN_UPDATE_GOLDEN")) {
        FrameWriter writer({{golden}}, {}, now.layers.front().image.height);
        writer.add(now, now.metadata);
        writer.finish();
    }
    const Image kept = readImage(golden);
    ASSERT_EQ(kept.width, 320);
    // Other CPUs and drivers round differently: a pixel in a thousand may fall on the other side of a band or a line.
    // The measured sensitivities below are each at least twice this.
    constexpr double kTolerance = 0.001;
    EXPECT_LT(compare(now.layers[0].image, kept).share, kTolerance);

    const std::pair<const char*, std::vector<std::string>> moved[] = {
        {"radius of the ambient occlusion", {"ao.radius=0.255"}},
        {"ambient light", {"shading.ambient=0.153"}},
        {"brightness of the darkest band", {"shading.floor=0.255"}},
        {"width of the lines", {"edges.width=2.04px"}},
        {"opacity of the lines", {"edges.opacity=0.98"}},
    };
    for (const auto& [what, settings] : moved)
        EXPECT_GT(compare(drawRoom(settings, scene).layers[0].image, kept).share, 2 * kTolerance) << what;
    LoadedScene turned = loadScene(std::filesystem::path(LIMN_SOURCE_DIR) / "scenes/room/scene.toml");
    turned.scene.lights.front().base.direction.x *= 1.02;
    EXPECT_GT(compare(drawRoom({}, turned).layers[0].image, kept).share, 2 * kTolerance) << "direction of the sun";
}

}  // namespace
}  // namespace limn::test
