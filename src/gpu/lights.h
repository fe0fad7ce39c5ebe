// The lights as shaders read them.
#pragma once

#include "stage/scene_at.h"

#include <cstddef>
#include <vector>

namespace limn {

/// Bytes of one light in the uniform block of shaders/scene/lights.glsl.
std::size_t lightSize();

/// A shadow map's projection: its clip space from the world's axes and lengths, counted from a place of the light's
/// own.
struct ShadowProjection {
    glm::dvec3 origin{0};
    glm::dmat4 clipFromRelative{1};
};
/// One per map of shadowLayout().
std::vector<ShadowProjection> shadowProjections(const SceneAt& scene);

/// All lights, in the view's space.
std::vector<std::byte> lightBytes(const SceneAt& scene, const View& view);

}  // namespace limn
