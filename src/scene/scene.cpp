#include "scene/scene.h"

#include "base/file.h"
#include "base/text.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace limn {

std::optional<SubdivisionSettings::EdgeLength> SubdivisionSettings::wantedEdge() const {
    std::string_view text = edgeLength;
    const bool isPixels = text.ends_with("px");
    if (isPixels) text.remove_suffix(2);
    const auto amount = parseNumber(text);
    if (!amount || !(*amount > 0) || !std::isfinite(*amount)) return std::nullopt;
    return EdgeLength{*amount, isPixels};
}

std::filesystem::path MeshSource::at(int frame) const {
    const std::filesystem::path path(file);
    return perFrame ? path.parent_path() / framePath(path.filename(), frame) : path;
}

glm::dmat4 Instance::transform() const {
    if (matrix.size() == 16) {
        glm::dmat4 result(1);
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                result[column][row] = matrix[static_cast<std::size_t>(row) * 4 + static_cast<std::size_t>(column)];
        return result;
    }
    glm::dmat4 result = glm::translate(glm::dmat4(1), translate);
    result = glm::rotate(result, glm::radians(rotate.z), {0, 0, 1});
    result = glm::rotate(result, glm::radians(rotate.y), {0, 1, 0});
    result = glm::rotate(result, glm::radians(rotate.x), {1, 0, 0});
    return glm::scale(result, scale);
}

}  // namespace limn
