// The frames that a run draws.
#pragma once

#include "render/config.h"

#include <string>
#include <vector>

namespace limn {

/// "12", "1-100", "1-100x2", "1,5,9-12", "10-1", "-5--1". Throws Error (usage).
std::vector<int> parseFrames(const std::string& text);

/// The requested frames; else the config's range, else the scene's, else frame 1.
std::vector<int> framesOf(
    const RenderConfig& config, const std::string& asked, const std::optional<FrameRange>& declared);

/// The I-th of N parts of a list, I/N being for example "3/40": parts follow one another and differ by one frame at
/// most. Throws Error (usage).
std::vector<int> chunkOf(const std::vector<int>& frames, const std::string& chunk);

}  // namespace limn
