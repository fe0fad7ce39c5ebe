#include "lines/record.h"

#include <glm/trigonometric.hpp>

#include <bit>
#include <cmath>

namespace limn {

std::array<std::uint32_t, 5> lineRecordWords(const LineRecord& record) {
    const Color& color = record.color.color;
    const float cosine =
        record.creaseAngle > 0 ? static_cast<float>(std::cos(glm::radians(record.creaseAngle))) : -2.0f;
    const std::uint32_t flags = (record.draws ? 1u : 0u) | (record.color.given ? 2u : 0u) | (record.isCut ? 4u : 0u);
    const auto bits = [](float number) { return std::bit_cast<std::uint32_t>(number); };
    return {bits(color.r), bits(color.g), bits(color.b), bits(cosine), flags};
}

}  // namespace limn
