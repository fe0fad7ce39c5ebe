// Ranges of frames, as scene files and configs write them.
#pragma once

#include "scene/scene.h"

#include <optional>
#include <string_view>

namespace limn {

/// "1-240" or "12"; numbers may be negative. nullopt for anything else, backward ranges and more than kMostFrames
/// included.
inline constexpr int kMostFrames = 1'000'000;  ///< nine hours of film
std::optional<FrameRange> parseFrameRange(std::string_view text);

}  // namespace limn
