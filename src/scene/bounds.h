// Boxes and directions in doubles.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <limits>

namespace limn {

/// Axis-aligned box; empty when lo > hi.
struct Bounds {
    glm::dvec3 lo{std::numeric_limits<double>::infinity()};
    glm::dvec3 hi{-std::numeric_limits<double>::infinity()};

    bool empty() const { return !(lo.x <= hi.x); }
    void add(const glm::dvec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
    void add(const Bounds& b) { lo = glm::min(lo, b.lo), hi = glm::max(hi, b.hi); }
    glm::dvec3 centre() const { return (lo + hi) * 0.5; }
    double diagonal() const { return empty() ? 0 : glm::length(hi - lo); }
};

/// The unit vector, or zero for a zero vector.
inline glm::dvec3 unitOrZero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : glm::dvec3(0);
}

}  // namespace limn
