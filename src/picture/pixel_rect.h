// Rectangles of pixels.
#pragma once

#include <glm/glm.hpp>

namespace limn {

struct PixelRect {
    glm::ivec2 origin{0};  ///< from the lower left
    glm::ivec2 size{0};
};

}  // namespace limn
