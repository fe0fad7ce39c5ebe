#include "job/frames.h"
#include "scene/frames.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>

namespace limn {

std::vector<int> parseFrames(const std::string& text) {
    const auto fail = [&]() -> int {
        throw Error(ExitCode::usage, {fmt::format("--frames {}", text)}, "this is no list of frames",
            fmt::format("write for example 12, 1-100, 1-100x2 or 1,5,9-12, with at most {} frames", kMostFrames));
    };
    std::vector<int> frames;
    const char* at = text.data();
    const char* const end = at + text.size();
    const auto number = [&] {
        int value = 0;
        const auto [next, status] = std::from_chars(at, end, value);
        if (status != std::errc() || std::abs(static_cast<long>(value)) > 100'000'000) fail();
        at = next;
        return value;
    };
    while (true) {
        const int first = number();
        int last = first, step = 1;
        if (at < end && *at == '-') {
            ++at;
            last = number();
            if (at < end && *at == 'x') {
                ++at;
                step = number();
            }
        }
        const long count = step < 1 ? 0 : std::abs(static_cast<long>(last) - first) / step + 1;
        if (count < 1 || count + static_cast<long>(frames.size()) > kMostFrames) fail();
        for (int f = first; first <= last ? f <= last : f >= last; f += first <= last ? step : -step)
            frames.push_back(f);
        if (at == end) return frames;
        if (*at++ != ',') fail();
    }
}

std::vector<int> framesOf(
    const RenderConfig& config, const std::string& asked, const std::optional<FrameRange>& declared) {
    if (!asked.empty()) return parseFrames(asked);
    if (!declared && !config.frames) return {1};
    const FrameRange range = config.frames ? *config.frames : *declared;
    std::vector<int> frames;
    for (int f = range.first; f <= range.last; ++f) frames.push_back(f);
    return frames;
}

}  // namespace limn
