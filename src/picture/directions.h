// Unit vectors in two numbers, as shaders/lib/normals.glsl writes them.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

/// The octahedral map's coordinates; NO_NORMAL (2, 0) for a zero vector.
inline glm::vec2 encodeDirection(const glm::vec3& n) {
    const float size = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (size == 0) return {2, 0};
    const glm::vec2 p = glm::vec2(n) / size;
    if (n.z >= 0) return p;
    return {(1 - std::abs(p.y)) * (p.x >= 0 ? 1.0f : -1.0f), (1 - std::abs(p.x)) * (p.y >= 0 ? 1.0f : -1.0f)};
}

/// The inverse; NO_NORMAL becomes zero.
inline glm::vec3 decodeDirection(const glm::vec2& e) {
    if (e.x > 1) return glm::vec3(0);
    glm::vec3 n(e, 1 - std::abs(e.x) - std::abs(e.y));
    const float fold = std::max(-n.z, 0.0f);
    n.x -= n.x >= 0 ? fold : -fold;
    n.y -= n.y >= 0 ? fold : -fold;
    return glm::normalize(n);
}

}  // namespace limn
