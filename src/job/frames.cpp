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

std::vector<int> chunkOf(const std::vector<int>& frames, const std::string& chunk) {
    std::uint64_t part = 0, parts = 0;
    const char* const end = chunk.data() + chunk.size();
    const auto first = std::from_chars(chunk.data(), end, part);
    const bool hasParts = first.ec == std::errc() && first.ptr < end && *first.ptr == '/';
    const auto second = hasParts ? std::from_chars(first.ptr + 1, end, parts) : first;
    if (!hasParts || second.ec != std::errc() || second.ptr != end || part < 1 || part > parts || parts > kMostFrames)
        throw Error(ExitCode::usage, {fmt::format("--chunk {}", chunk)}, "this is not I/N",
            "write for example --chunk 3/40, with I from 1 to N");
    const auto at = [&](std::uint64_t i) { return static_cast<std::ptrdiff_t>(i * frames.size() / parts); };
    return {frames.begin() + at(part - 1), frames.begin() + at(part)};
}

}  // namespace limn
