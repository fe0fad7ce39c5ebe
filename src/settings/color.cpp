#include "settings/color.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limn {

float linearToSrgb(float linear) {
    const float x = std::abs(linear);
    return std::copysign(x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f, linear);
}

float srgbToLinear(float encoded) {
    const float x = std::abs(encoded);
    return std::copysign(x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f), encoded);
}

std::optional<Color> parseHexColor(std::string_view text) {
    if ((text.size() != 4 && text.size() != 7) || text[0] != '#') return std::nullopt;
    int digits[6] = {};
    for (std::size_t i = 1; i < text.size(); ++i) {
        const char c = text[i];
        const int value = c >= '0' && c <= '9' ? c - '0'
            : c >= 'a' && c <= 'f'             ? c - 'a' + 10
            : c >= 'A' && c <= 'F'             ? c - 'A' + 10
                                               : -1;
        if (value < 0) return std::nullopt;
        digits[i - 1] = value;
    }
    float rgb[3];
    for (int i = 0; i < 3; ++i) {
        const int byte = text.size() == 4 ? digits[i] * 17 : digits[2 * i] * 16 + digits[2 * i + 1];
        rgb[i] = srgbToLinear(static_cast<float>(byte) / 255.0f);
    }
    return Color{rgb[0], rgb[1], rgb[2]};
}

std::string hexColor(const Color& linear) {
    const auto byte = [](float value) {
        return static_cast<int>(std::lround(std::clamp(linearToSrgb(value), 0.0f, 1.0f) * 255));
    };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(linear.r), byte(linear.g), byte(linear.b));
}

}  // namespace limn
