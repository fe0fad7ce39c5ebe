// The images of all materials in one texture.
#pragma once

#include "gl/objects.h"
#include "stage/scene_at.h"

#include <vector>

namespace limn {

/// Where a material's image lies.
struct AtlasPlace {
    glm::ivec3 corner{0};  ///< texels x, y, and layer
    int levels = 0;        ///< mip levels, beside and above each other; 0: no image
    glm::ivec2 size{0};    ///< of level 0
};

class TextureAtlas {
public:
    /// Reads the images of these materials, unless they are there already. Throws Error where one cannot be read or is
    /// too large for the device, and what readImage throws.
    void update(const SceneAt& scene, int maxTextureSize);
    /// The place of each of the scene's materials.
    const std::vector<AtlasPlace>& places() const { return places_; }
    const gl::Texture& texture() const { return texture_; }

private:
    std::vector<AtlasPlace> places_;
    std::vector<ContentKey> keys_;  ///< SceneAt::textureKeys of places_
    gl::Texture texture_;
};

}  // namespace limn
