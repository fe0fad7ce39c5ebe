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

int SequenceSettings::fileAt(double frame) const {
    const double count = static_cast<double>(last) - first + 1;
    const double at = std::floor((frame - start) * speed + 1e-9);  // 3 · (1/3) is a whole file
    if (ends == SequenceEnds::hold || count <= 1) return first + static_cast<int>(std::clamp(at, 0.0, count - 1));
    const double round = ends == SequenceEnds::loop ? count : 2 * count - 2;
    const double inside = at - round * std::floor(at / round);
    return first + static_cast<int>(inside < count ? inside : round - inside);
}

int MeshSource::numberAt(int frame) const { return !perFrame ? 0 : sequence.present ? sequence.fileAt(frame) : frame; }

std::filesystem::path MeshSource::at(int frame) const {
    const std::filesystem::path path(file);
    return perFrame ? path.parent_path() / framePath(path.filename(), numberAt(frame)) : path;
}

glm::dmat4 Scene::worldFrom(const Placement& place, double frame) const {
    return worldFrom(place.parent, frame) * place.transform();
}

glm::dmat4 Scene::worldFrom(std::string_view name, double frame) const {
    if (name.empty()) return glm::dmat4(1);
    for (const auto& node : nodes)
        if (node.base.name == name) return worldFrom(node.at(frame), frame);
    for (const auto& instance : instances)
        if (instance.base.name == name) return worldFrom(instance.at(frame), frame);
    return glm::dmat4(1);
}

glm::dmat4 Placement::transform() const {
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
    return glm::scale(result * glm::mat4_cast(quaternion), scale);
}

}  // namespace limn
