#include "rays/holes.h"

#include "image/texture.h"

#include <algorithm>

namespace limn {

float alphaAt(const Mask& mask, glm::vec2 uv) {
    const Image& image = *mask.image;
    const glm::ivec2 count(image.width, image.height);
    const glm::vec2 inside = mask.repeats ? uv - glm::floor(uv) : glm::clamp(uv, 0.0f, 1.0f),
                    at = inside * glm::vec2(count) - 0.5f, cell = glm::floor(at);
    const glm::vec2 f = mask.isSharp ? glm::floor(at - cell + 0.5f) : at - cell;
    const auto texel = [&](int x, int y) {
        const glm::ivec2 place = glm::ivec2(cell) + glm::ivec2(x, y);
        const glm::ivec2 known =
            mask.repeats ? (place % count + count) % count : glm::clamp(place, glm::ivec2(0), count - glm::ivec2(1));
        return image.at(known.x, known.y)[3];
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x), glm::mix(texel(0, 1), texel(1, 1), f.x), f.y);
}

std::vector<const Mask*> HoleMasks::of(const SceneAt& scene, const DrawInstance& instance) {
    std::vector<const Mask*> list;
    list.reserve(instance.materials.size());
    for (const auto number : instance.materials) {
        const Material& material = scene.materials[number];
        if (material.cutout.empty()) {
            list.push_back(nullptr);
            continue;
        }
        auto [image, isNew] = images_.try_emplace(material.cutout);
        if (isNew) image->second = readTexture("", material.cutout);
        const glm::ivec2 size(image->second.width, image->second.height);
        const Mask mask{&image->second, material.textureScale, material.textureOffset, material.textureRepeats,
            hasSharpTexels(material, size)};
        list.push_back(&masks_.try_emplace(number, mask).first->second);
    }
    if (std::all_of(list.begin(), list.end(), [](const Mask* mask) { return !mask; })) list.clear();
    return list;
}

}  // namespace limn
