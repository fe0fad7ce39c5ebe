// Images as textures: mip chains for the atlas, and holes for those who look one up on the CPU.
#pragma once

#include "image/image.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace limn {

/// What a material shows, RGBA, linear, rows from the bottom as v counts: the colours of one image (white where its
/// name is empty), and in alpha the holes of another: its alpha, or its brightness to the eye where it has none. Both
/// as large as the larger. Throws what readImage throws.
Image readTexture(const std::string& colors, const std::string& holes);

/// Made smaller, by halves, until no side is longer than `longest`.
Image shrunk(Image texture, int longest);

/// Does the alpha of an image cut shapes out: most of it is 0 or 1, and some of it is below one half? Throws what
/// readImage throws.
bool isAlphaMask(const std::string& file);

/// All mip levels of an 8-bit sRGB picture, laid out in a rectangle 1.5 times as wide: level 0 left, the others in a
/// column to its right.
struct MipChain {
    glm::ivec2 size{0};
    std::vector<std::vector<std::uint8_t>> pixels;  ///< RGBA per level

    int levels() const { return static_cast<int>(pixels.size()); }
    glm::ivec2 levelSize(int level) const { return glm::max(size >> level, glm::ivec2(1)); }
    glm::ivec2 levelOrigin(int level) const {
        glm::ivec2 origin(0);
        for (int l = 1; l <= level; ++l) l == 1 ? void(origin.x = size.x) : void(origin.y += levelSize(l - 1).y);
        return origin;
    }
    glm::ivec2 footprint() const {
        const glm::ivec2 last = levelOrigin(levels() - 1) + levelSize(levels() - 1);
        return {levels() > 1 ? size.x + levelSize(1).x : size.x, std::max(size.y, last.y)};
    }
};

/// With `hasHoles` every level keeps the share of texels whose alpha is at least one half, and levels end where that is
/// no longer possible: fine leaves neither vanish in the distance nor close.
MipChain makeMipChain(Image texture, bool hasHoles);

}  // namespace limn
