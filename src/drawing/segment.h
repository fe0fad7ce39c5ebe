// Straight pieces in the plane.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>

namespace limn {

/// The share of the way from a to b at which it comes nearest to p: 0 … 1.
inline double nearestShare(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    const glm::dvec2 way = b - a;
    const double squared = glm::dot(way, way);
    return squared > 0 ? std::clamp(glm::dot(p - a, way) / squared, 0.0, 1.0) : 0;
}

inline double distanceFromSegment(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    return glm::distance(p, a + (b - a) * nearestShare(a, b, p));
}

}  // namespace limn
