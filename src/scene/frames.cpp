#include "scene/frames.h"

#include "base/text.h"

#include <cmath>

namespace limn {

std::optional<FrameRange> parseFrameRange(std::string_view text) {
    const auto dash = text.find('-', 1);  // from 1: the first number may be negative
    const auto first = parseNumber(text.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : parseNumber(text.substr(dash + 1));
    const auto isFrame = [](double f) { return std::abs(f) < 1e9 && f == static_cast<int>(f); };
    if (!first || !last || !isFrame(*first) || !isFrame(*last) || *last < *first || *last - *first >= kMostFrames)
        return std::nullopt;
    return FrameRange{static_cast<int>(*first), static_cast<int>(*last)};
}

}  // namespace limn
