// Large pictures are drawn in tiles: the same picture, to the bit.

#include "support/bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>

namespace limn::test {
namespace {

std::size_t differing(const Image& a, const Image& b) {
    EXPECT_EQ(a.pixels.size(), b.pixels.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i)
        count += std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(float)) != 0;
    return count;
}

const std::string kEverything =
    "[shading]\ntechnique = 'toon'\n[[edges]]\ntechnique = 'depth_normal'\nwidth = '2.5px'\nobjects = "
    "1\n[[edges]]\ntechnique = 'laplacian'\ncolor = '#c02020'\nwidth = '1px'\n"
    "[output]\naovs = ['beauty', 'ambient_occlusion', 'edges', 'depth', 'normal', 'object_id']\n";

LoadedScene mixed(const std::string& lens = "fov = 60") {
    return makeScene("[[mesh]]\nname = 'm'\nfile = 'm.obj'\n" + cameraToml({2.5, 3.5, 6}, {0, 0.5, -1}, lens)
            + "[[light]]\ndirection = [-1, -2, -1]\nshadow = { resolution = 512 }\n",
        {{"m.obj", mixedObj()}});
}

TEST(Tiles, ofAnySizeMakeTheSamePicture) {
    // Coplanar and crossing surfaces are in the scene, and one that passes the eye: whichever wins a pixel must win it
    // in every tile. A guard band wide enough for the effects' reach is what lets tiles be smaller than the picture.
    for (const std::string ao : {"technique = 'gtao'\nradius = 0.3\nfilter = { technique = 'cross_bilateral' }",
             "technique = 'hbao'\nradius = 0.3\nresolution = 'half'\nfilter = [{ technique = 'gaussian', iterations = "
             "2 }, { technique = 'plane_aware' }]",
             "technique = 'ray_traced'\nradius = 0.5\nfilter = { technique = 'plane_aware' }",
             "technique = 'depth_tangent'", "technique = 'visibility_bitmask'\nradius = 0.3"})
        for (const int samples : {1, 4}) {
            // Seen in perspective, what passes the eye makes radii boundless, and techniques with a radius look at
            // everything: tiles are whole then.
            if (samples == 1 && ao.find("gtao") == std::string::npos) continue;  // more samples show more
            const bool parallel = ao.find("radius = 0.3") != std::string::npos;
            const auto at = [&](int tile, const RenderOptions& options = {}) {
                // 151 × 123: no multiple of anything.
                return draw(makeConfig(kEverything + "[ao]\n" + ao
                                + fmt::format("\n[image]\nsize = [151, 123]\nguard = 1\nsamples = {}\ntile = {}\n",
                                    samples, tile)),
                    mixed(parallel ? "orthographic_height = 5" : "fov = 60"), options);
            };
            const Picture whole = at(4096);
            for (const int tile : {0, 128, 100, 64, 32}) {
                const Picture tiled = at(tile);
                for (const auto& layer : whole.frame.layers)
                    EXPECT_EQ(differing(layer.image, tiled.aov(layer.name)), 0u)
                        << ao << ": " << layer.name << " in tiles of " << tile << ", " << samples << " samples";
            }
            int bands = 0;
            RenderOptions counting;
            counting.onBand = [&](const RenderedFrame&) { ++bands; };
            renderer().render(makeConfig(kEverything + "[ao]\n" + ao
                                  + "\n[image]\nsize = [151, 123]\nguard = 1\nsamples = 1\ntile = 32\n"),
                mixed(parallel ? "orthographic_height = 5" : "fov = 60"), 1, counting);
            EXPECT_EQ(bands, 4) << "there were tiles at all: " << ao;
            // And a part of the picture is a part of the picture.
            RenderOptions part;
            part.crop = {{37, 21}, {90, 70}};
            const Picture cropped = at(0, part);
            for (const auto& layer : whole.frame.layers) {
                const Image& image = cropped.aov(layer.name);
                ASSERT_EQ(image.width, 90);
                std::size_t differ = 0;
                for (int y = 0; y < 70; ++y)
                    differ += std::memcmp(image.at(0, y), layer.image.at(37, 21 + y),
                                  sizeof(float) * static_cast<std::size_t>(90 * image.channels))
                        != 0;
                EXPECT_EQ(differ, 0u) << layer.name;
            }
        }
}

TEST(Tiles, arriveInBandsFromTheTop) {
    const auto config = [](int tile) {
        return makeConfig(kEverything
            + fmt::format("[ao]\ntechnique = 'toon_ssao'\nradius = 0.3\n[image]\nsize = [120, 90]\nguard = 1\nsamples "
                          "= 2\ntile = {}\n",
                tile));
    };
    const LoadedScene scene = mixed("orthographic_height = 5");
    const Picture whole = draw(config(0), scene);
    std::vector<float> gathered;
    int bands = 0;
    RenderOptions options;
    options.onBand = [&](const RenderedFrame& band) {
        ++bands;
        gathered.insert(
            gathered.end(), band.layers.front().image.pixels.begin(), band.layers.front().image.pixels.end());
    };
    renderer().render(config(32), scene, 1, options);
    EXPECT_GE(bands, 3);
    EXPECT_EQ(gathered, whole.aov("beauty").pixels);
}

}  // namespace
}  // namespace limn::test
