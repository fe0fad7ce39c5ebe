#include "stage/shadow_layout.h"

#include <algorithm>

namespace limn {

ShadowLayout shadowLayout(std::span<const Light> lights) {
    constexpr int kRow = 8192;  // texels in a row of maps; further maps go in the next row
    ShadowLayout layout;
    glm::ivec2 pen(0);
    int rowHeight = 0;
    for (std::size_t l = 0; l < lights.size(); ++l) {
        if (!lights[l].shadow.present) continue;
        const int side = lights[l].shadow.resolution;
        for (int face = 0; face < (lights[l].kind == LightKind::point ? 6 : 1); ++face) {
            if (pen.x > 0 && pen.x + side > kRow) {
                pen = {0, pen.y + rowHeight};
                rowHeight = 0;
            }
            layout.maps.push_back({{pen, side, side}, static_cast<int>(l) * 8 + face});
            pen.x += side;
            rowHeight = std::max(rowHeight, side);
            layout.size = glm::max(layout.size, glm::ivec2(pen.x, pen.y + rowHeight));
        }
    }
    return layout;
}

}  // namespace limn
