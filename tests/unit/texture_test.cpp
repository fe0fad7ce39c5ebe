// Mip levels of textures.

#include "image/texture.h"

#include <gtest/gtest.h>

namespace limn {
namespace {

/// Alike everywhere: linear colour and alpha.
Image plain(int width, int height, float value, float alpha) {
    Image image{width, height, 4, {}};
    for (int i = 0; i < width * height; ++i)
        image.pixels.insert(image.pixels.end(), {value, value / 2, value / 4, alpha});
    return image;
}

TEST(Textures, keepTheirColourOnEveryLevel) {
    for (const float alpha : {1.0f, 0.5f, 0.0f}) {  // in a hole too: its border is blended with it
        const MipChain chain = makeMipChain(plain(13, 6, 0.5f, alpha), false);
        ASSERT_EQ(chain.levels(), 4);
        for (int l = 0; l < chain.levels(); ++l) {
            const glm::ivec2 size = chain.levelSize(l);
            const auto& pixels = chain.pixels[static_cast<std::size_t>(l)];
            ASSERT_EQ(pixels.size(), static_cast<std::size_t>(size.x * size.y * 4));
            for (std::size_t i = 0; i < pixels.size(); i += 4) {
                // sRGB of 0.5, 0.25 and 0.125.
                EXPECT_NEAR(pixels[i], 188, 1) << "level " << l << ", alpha " << alpha;
                EXPECT_NEAR(pixels[i + 1], 137, 1);
                EXPECT_NEAR(pixels[i + 2], 99, 1);
                EXPECT_NEAR(pixels[i + 3], 255 * alpha, 1);
            }
        }
    }
}

TEST(Textures, areMadeSmallerByTheMeanOfWhatTheyShow) {
    Image image = plain(4, 2, 0, 1);
    image.at(0, 0)[0] = 1;
    const Image half = shrunk(image, 2);
    ASSERT_EQ(half.width, 2);
    ASSERT_EQ(half.height, 1);
    EXPECT_FLOAT_EQ(half.at(0, 0)[0], 0.25f);
    EXPECT_FLOAT_EQ(half.at(1, 0)[0], 0);
    EXPECT_EQ(shrunk(image, 4).pixels, image.pixels) << "small enough";
    // Colours count by their alpha: a leaf's rim is as green as the leaf.
    Image rim = plain(2, 1, 1, 0);
    rim.at(0, 0)[3] = 1;
    for (int c = 0; c < 3; ++c) rim.at(1, 0)[c] = 0;
    EXPECT_FLOAT_EQ(shrunk(rim, 1).at(0, 0)[0], 1);
    EXPECT_FLOAT_EQ(shrunk(rim, 1).at(0, 0)[3], 0.5f);
}

}  // namespace
}  // namespace limn
