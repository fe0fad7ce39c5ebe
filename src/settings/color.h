// Colour spaces. Everywhere inside limn colours are linear Rec.709; sRGB encoding happens once, on the way in and on
// the way out.
#pragma once

#include "settings/fields.h"

#include <optional>
#include <string>
#include <string_view>

namespace limn {

/// IEC 61966-2-1 transfer functions, for values of any size (negative values mirror).
float linearToSrgb(float linear);
float srgbToLinear(float encoded);

/// "#rgb" or "#rrggbb", display-encoded → linear.
std::optional<Color> parseHexColor(std::string_view text);
/// The nearest "#rrggbb".
std::string hexColor(const Color& linear);

}  // namespace limn
