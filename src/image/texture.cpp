#include "image/texture.h"

#include "image/image.h"
#include "settings/color.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// Resizes by averaging the area that each new texel covers, so that any size works. Colours count by their alpha: what
/// lies in a hole has none.
Image resize(const Image& image, glm::ivec2 size) {
    Image resized{
        size.x, size.y, 4, std::vector<float>(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * 4)};
    tbb::parallel_for(0, size.y, [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            const double x0 = double(x) * image.width / size.x, x1 = double(x + 1) * image.width / size.x;
            const double y0 = double(y) * image.height / size.y, y1 = double(y + 1) * image.height / size.y;
            double sum[4] = {}, total = 0, bare[3] = {};
            for (int v = static_cast<int>(y0); v < std::min<int>(static_cast<int>(std::ceil(y1)), image.height); ++v) {
                for (int u = static_cast<int>(x0); u < std::min<int>(static_cast<int>(std::ceil(x1)), image.width);
                     ++u) {
                    const double weight = (std::min<double>(u + 1, x1) - std::max<double>(u, x0))
                        * (std::min<double>(v + 1, y1) - std::max<double>(v, y0));
                    const float* texel = image.at(u, v);
                    const double alpha = static_cast<double>(texel[3]);
                    for (int c = 0; c < 3; ++c) {
                        sum[c] += weight * alpha * static_cast<double>(texel[c]);
                        bare[c] += weight * static_cast<double>(texel[c]);
                    }
                    sum[3] += weight * alpha;
                    total += weight;
                }
            }
            for (int c = 0; c < 3; ++c)
                resized.at(x, y)[c] = static_cast<float>(sum[3] > 0 ? sum[c] / sum[3] : bare[c] / total);
            resized.at(x, y)[3] = static_cast<float>(sum[3] / total);
        }
    });
    return resized;
}

/// RGBA, rows from the bottom as v counts.
Image asTexture(const Image& picture) {
    Image texture{picture.width, picture.height, 4, {}};
    texture.pixels.reserve(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) * 4);
    for (int y = picture.height - 1; y >= 0; --y) {
        for (int x = 0; x < picture.width; ++x) {
            const float* p = picture.at(x, y);
            const bool grey = picture.channels < 3;
            for (int c = 0; c < 3; ++c) texture.pixels.push_back(p[grey ? 0 : c]);
            texture.pixels.push_back(picture.channels == 4 ? p[3] : picture.channels == 2 ? p[1] : 1.0f);
        }
    }
    return texture;
}

}  // namespace

Image readTexture(const std::string& colors, const std::string& holes) {
    Image texture{1, 1, 4, {1, 1, 1, 1}};
    if (!colors.empty()) texture = asTexture(readImage(colors));
    for (std::size_t i = 3; i < texture.pixels.size(); i += 4)
        texture.pixels[i] = 1;  // its own alpha says nothing: only where holes are asked for are there any
    if (holes.empty()) return texture;
    const Image picture = readImage(holes);
    Image mask = asTexture(picture);
    const bool hasAlpha = picture.channels % 2 == 0;
    const glm::ivec2 size = glm::max(glm::ivec2(texture.width, texture.height), glm::ivec2(mask.width, mask.height));
    for (std::size_t i = 0; i < mask.pixels.size(); i += 4)
        if (!hasAlpha)
            mask.pixels[i + 3] = linearToSrgb(
                (mask.pixels[i] + mask.pixels[i + 1] + mask.pixels[i + 2]) / 3);  // half is what looks half
    if (size != glm::ivec2(mask.width, mask.height)) mask = resize(mask, size);
    if (size != glm::ivec2(texture.width, texture.height)) texture = resize(texture, size);
    for (std::size_t i = 3; i < texture.pixels.size(); i += 4) texture.pixels[i] = mask.pixels[i];
    return texture;
}

Image shrunk(Image texture, int longest) {
    glm::ivec2 size(texture.width, texture.height);
    while (std::max(size.x, size.y) > longest) size = glm::max(size / 2, glm::ivec2(1));
    return size == glm::ivec2(texture.width, texture.height) ? std::move(texture) : resize(texture, size);
}

bool isAlphaMask(const std::string& file) {
    if (!readImageInfo(file).hasAlpha()) return false;
    const Image image = readImage(file);
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t texels = image.pixels.size() / channels;
    std::size_t clear = 0, plain = 0;
    // Compression and filtering leave alphas that are nearly 0 or 1.
    constexpr float slack = 8.0f / 255;
    for (std::size_t i = channels - 1; i < image.pixels.size(); i += channels) {
        const float alpha = image.pixels[i];
        clear += alpha < 0.5f;
        plain += alpha < slack || alpha > 1 - slack;
    }
    return clear > 0 && 2 * plain > texels;
}

namespace {

/// The share of texels that are no hole.
double solidShare(const Image& texture) {
    std::size_t solid = 0;
    for (std::size_t i = 3; i < texture.pixels.size(); i += 4) solid += texture.pixels[i] >= 0.5f;
    return static_cast<double>(solid) * 4 / static_cast<double>(texture.pixels.size());
}

/// Scales alpha so that this share of the texels is no hole, as nearly as can be.
void keepShare(Image& level, double share) {
    std::vector<float> alphas;
    for (std::size_t i = 3; i < level.pixels.size(); i += 4) alphas.push_back(level.pixels[i]);
    const auto solid =
        std::min(static_cast<std::size_t>(std::lround(share * static_cast<double>(alphas.size()))), alphas.size());
    if (solid == 0) return;
    std::nth_element(alphas.begin(), alphas.begin() + static_cast<std::ptrdiff_t>(alphas.size() - solid), alphas.end());
    const float least = alphas[alphas.size() - solid];
    if (least > 0)
        for (std::size_t i = 3; i < level.pixels.size(); i += 4)
            level.pixels[i] = std::min(level.pixels[i] * 0.5f / least, 1.0f);
}

/// How far off a level's share of solid texels may be, as a part of that share.
constexpr double kWrongShare = 0.25;

}  // namespace

MipChain makeMipChain(Image level, bool hasHoles) {
    MipChain chain;
    chain.size = {level.width, level.height};
    const int levels = 1 + static_cast<int>(std::log2(std::max(level.width, level.height)));
    const double share = hasHoles ? solidShare(level) : 1;
    for (int l = 0; l < levels; ++l) {
        if (l > 0) level = resize(level, chain.levelSize(l));
        Image encoded = level;
        if (hasHoles && l > 0) {
            keepShare(encoded, share);
            // Where all texels have become alike they are all solid or all holes: better that samples meet the finer
            // level at random.
            if (std::abs(solidShare(encoded) - share) > kWrongShare * share) break;
        }
        for (std::size_t i = 0; i < encoded.pixels.size(); ++i)
            if (i % 4 != 3) encoded.pixels[i] = linearToSrgb(encoded.pixels[i]);
        chain.pixels.push_back(quantize8(
            {.name = "texture", .channels = {}, .isColour = false, .isInteger = false, .image = std::move(encoded)}));
    }
    return chain;
}

}  // namespace limn
