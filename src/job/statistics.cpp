#include "job/statistics.h"

#include "base/install.h"
#include "base/text.h"
#include "settings/document.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

namespace limn {
namespace {

constexpr const char* kOutcomes[] = {"drawn", "same", "kept", "failed"};

/// The most memory that the process has held, in bytes.
std::uint64_t peakMemory() {
    struct rusage usage {};
    return ::getrusage(RUSAGE_SELF, &usage) == 0 ? 1024 * static_cast<std::uint64_t>(usage.ru_maxrss) : 0;
}

}  // namespace

void Statistics::promise(const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (!text.empty()) promises_ += (promises_.empty() ? "" : ", ") + jsonText(text);
}

void Statistics::add(const Frame& frame) {
    std::string times;
    for (const auto& part : frame.parts)
        times += fmt::format("{}{}: {:.2f}", times.empty() ? "" : ", ", jsonText(part.name), part.milliseconds);
    const auto outcome = static_cast<std::size_t>(frame.outcome);
    std::string more = frame.problem.empty() ? "" : ", \"problem\": " + jsonText(frame.problem);
    if (frame.flicker)
        more += fmt::format(", \"flicker\": {{\"mean\": {:.4f}, \"p99\": {:.2f}, \"compared\": {:.4f}}}",
            frame.flicker->mean, frame.flicker->p99, frame.flicker->compared);
    const std::lock_guard lock(mutex_);
    if (frame.flicker) {
        ++flickerCount_;
        flickerSum_ += frame.flicker->mean;
        flickerLargest_ = std::max(flickerLargest_, frame.flicker->mean);
    }
    ++counts_[outcome];
    frames_ +=
        fmt::format("{}  {{\"file\": {}, \"frame\": {}, \"outcome\": \"{}\", \"parts\": {{{}}}, \"total\": {:.2f}{}}}",
            frames_.empty() ? "" : ",\n", jsonText(frame.file.string()), frame.frame, kOutcomes[outcome], times,
            frame.total, more);
}

std::string Statistics::json(const std::string& device, ExitCode exitCode, double seconds) const {
    const std::lock_guard lock(mutex_);
    const std::string flicker = flickerCount_ == 0
        ? ""
        : fmt::format(" \"flicker\": {{\"mean\": {:.4f}, \"largest\": {:.4f}}},\n",
            flickerSum_ / static_cast<double>(flickerCount_), flickerLargest_);
    const std::string quality = promises_.empty() ? "" : fmt::format(" \"quality\": [{}],\n", promises_);
    return fmt::format(
        "{{\"version\": {}, \"limn\": {}, \"device\": {}, \"exit_code\": {}, \"seconds\": {:.2f}, \"peak_memory\": "
        "{},\n{}"
        " \"drawn\": {}, \"same\": {}, \"kept\": {}, \"failed\": {},\n{} \"frames\": [\n{}\n]}}\n",
        kFormatVersion, jsonText(fmt::format("limn {}", kVersion)), jsonText(device), static_cast<int>(exitCode),
        seconds, peakMemory(), quality, counts_[0], counts_[1], counts_[2], counts_[3], flicker, frames_);
}

}  // namespace limn
