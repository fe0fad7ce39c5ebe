// The lights as shaders read them.
#pragma once

#include "stage/scene_at.h"

#include <cstddef>
#include <vector>

namespace limn {

/// Bytes of one light in the uniform block of shaders/scene/lights.glsl.
std::size_t lightSize();

/// All lights, in the view's space.
std::vector<std::byte> lightBytes(const SceneAt& scene, const View& view);

}  // namespace limn
