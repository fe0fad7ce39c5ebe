// Ranges of frames, as scene files and configs write them.
#pragma once

#include "scene/scene.h"

#include <optional>
#include <string_view>

namespace limn {

/// "1-240" or "12"; numbers may be negative. nullopt for anything else, backward ranges included.
std::optional<FrameRange> parseFrameRange(std::string_view text);

}  // namespace limn
