// Lines that a scene draws itself, whatever its surfaces are.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace limn {

/// A straight line: part of a polyline of a mesh file, or of the cut of a surface without thickness.
struct Mark {
    glm::dvec3 a{0}, b{0};     ///< world, scene units
    std::uint32_t record = 0;  ///< line record of its object and material
    bool isCut = false;        ///< its style is that of sections
};

}  // namespace limn
