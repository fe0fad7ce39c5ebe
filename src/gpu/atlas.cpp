#include "gpu/atlas.h"

#include "base/log.h"
#include "base/memory.h"
#include "image/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace limn {
namespace {

using Files = std::pair<std::string, std::string>;  ///< of colours, and of holes
Files filesOf(const Material& material) { return {material.texture, material.cutout}; }

struct Layout {
    int side = 256, layers = 1;  ///< of the texture, in texels
    std::map<Files, glm::ivec3> corners;
};

/// Packs shelves: tallest image first, left to right, then the next shelf, then the next layer.
Layout layOut(const std::map<Files, MipChain>& chains) {
    Layout layout;
    std::vector<std::pair<Files, const MipChain*>> order;
    int& side = layout.side;
    for (const auto& [files, chain] : chains) {
        order.emplace_back(files, &chain);
        const glm::ivec2 footprint = chain.footprint();
        while (side < std::max(footprint.x, footprint.y)) side *= 2;
    }
    std::stable_sort(order.begin(), order.end(),
        [](const auto& a, const auto& b) { return a.second->footprint().y > b.second->footprint().y; });
    glm::ivec3 pen(0);
    int shelf = 0;
    for (const auto& [files, chain] : order) {
        const glm::ivec2 footprint = chain->footprint();
        if (pen.x + footprint.x > side) {
            pen.x = 0;
            pen.y += shelf;
            shelf = 0;
        }
        if (pen.y + footprint.y > side) {
            pen = {0, 0, pen.z + 1};
            shelf = 0;
        }
        layout.corners[files] = pen;
        pen.x += footprint.x;
        shelf = std::max(shelf, footprint.y);
    }
    layout.layers = pen.z + 1;
    return layout;
}

/// The mip chain of a material's images, shrunk where it does not fit into the device's largest texture.
MipChain chainOf(const Files& files, int maxTextureSize) {
    Image image = readTexture(files.first, files.second);
    // A chain is 3/2 as wide as its first level.
    const int width = image.width, height = image.height;
    image = shrunk(std::move(image), maxTextureSize / 3 * 2);
    if (image.width != width)
        log::warning(
            "{}: with mip levels beside it an image of {}×{} texels does not fit into a texture; drawn with {}×{}",
            files.first.empty() ? files.second : files.first, width, height, image.width, image.height);
    return makeMipChain(std::move(image), !files.second.empty());
}

/// What the images of all materials will take, by their headers: chains of mip levels, the atlas made of them, and one
/// image as floats at a time.
std::uint64_t bytesOf(const std::map<Files, MipChain>& chains, int maxTextureSize) {
    std::uint64_t kept = 0, once = 0;
    for (const auto& [files, chain] : chains) {
        std::uint64_t texels = 0;
        for (const auto& file : {files.first, files.second}) {
            if (file.empty()) continue;
            const ImageInfo info = readImageInfo(file);
            texels = std::max(texels, static_cast<std::uint64_t>(info.width) * static_cast<std::uint64_t>(info.height));
        }
        once = std::max(once, texels * 4 * sizeof(float));
        const auto most = static_cast<std::uint64_t>(maxTextureSize) / 3 * 2;
        kept += std::min(texels, most * most) * 4 * 3 / 2;
    }
    return 2 * kept + once;
}

}  // namespace

void TextureAtlas::update(const SceneAt& scene, int maxTextureSize) {
    if (keys_ == scene.textureKeys) return;
    keys_.clear();  // if an image fails, the next frame tries again
    places_.assign(scene.materials.size(), {});
    texture_ = {};
    std::map<Files, MipChain> chains;
    for (const auto& material : scene.materials)
        if (!material.texture.empty() || !material.cutout.empty()) chains[filesOf(material)];
    std::optional<MemoryClaim> claim;
    if (!chains.empty())
        claim.emplace(bytesOf(chains, maxTextureSize), Location{},
            fmt::format("the scene shows {} image{} as textures", chains.size(), chains.size() == 1 ? "" : "s"),
            "make some of them smaller");
    for (auto& [files, chain] : chains) chain = chainOf(files, maxTextureSize);
    Layout layout = layOut(chains);
    if (!chains.empty()) texture_ = gl::Texture::pictureArray(layout.side, layout.layers, "texture atlas");
    for (const auto& [files, chain] : chains)
        for (int l = 0; l < chain.levels(); ++l)
            texture_.writeLayer(layout.corners[files].z, glm::ivec2(layout.corners[files]) + chain.levelOrigin(l),
                chain.levelSize(l), chain.pixels[static_cast<std::size_t>(l)].data());
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (const auto known = chains.find(filesOf(scene.materials[i])); known != chains.end())
            places_[i] = {layout.corners[known->first], known->second.levels(), known->second.size};
    keys_ = scene.textureKeys;
}

}  // namespace limn
