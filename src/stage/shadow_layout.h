// The layout of all lights' shadow maps in one texture.
#pragma once

#include "base/content_key.h"
#include "scene/scene.h"
#include "stage/scene_at.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace limn {

/// One map: its square, and a number, 8 · light + face.
struct ShadowMap {
    glm::ivec4 viewport{0};  ///< texels: origin and size
    int number = 0;
};

/// One map for a sun or spot, six for a point light. Empty when no light casts a shadow.
struct ShadowLayout {
    glm::ivec2 size{0};
    std::vector<ShadowMap> maps;
};
ShadowLayout shadowLayout(std::span<const Light> lights);

/// Of all that the maps show; they stay the same while it does. `meshOf`: the content key of each instance's mesh.
ContentKey shadowsKey(const SceneAt& scene, std::span<const ContentKey> meshOf);

}  // namespace limn
