// Holes that images cut into materials, for whoever asks about single points.
#pragma once

#include "image/image.h"
#include "stage/scene_at.h"

#include <map>
#include <string>
#include <vector>

namespace limn {

/// The image that cuts a material's holes.
struct Mask {
    const Image* image = nullptr;
    glm::vec2 scale{1}, offset{0};  ///< of texture coordinates
    bool repeats = true, isSharp = false;
};

/// Alpha at texture coordinates to which scale and offset have been applied: bilinear as in shaders/lib/texture.glsl,
/// the nearest texel where texels are sharp. There is a hole where it is below one half.
float alphaAt(const Mask& mask, glm::vec2 uv);

/// The masks of a scene; reads each image once. Throws what reading throws.
class HoleMasks {
public:
    /// The mask of each of the mesh's materials, as an instance shows it, null where there is none; empty where none
    /// cuts holes. Valid as long as this.
    std::vector<const Mask*> of(const SceneAt& scene, const DrawInstance& instance);

private:
    std::map<std::string, Image> images_;  ///< by their files
    std::map<std::uint32_t, Mask> masks_;  ///< by the number of the material
};

}  // namespace limn
