#include "job/statistics.h"

#include "base/install.h"
#include "base/text.h"
#include "settings/document.h"

#include <fmt/format.h>
#include <sys/resource.h>

namespace limn {
namespace {

constexpr const char* kOutcomes[] = {"drawn", "same", "kept", "failed"};

/// The most memory that the process has held, in bytes.
std::uint64_t peakMemory() {
    struct rusage usage {};
    return ::getrusage(RUSAGE_SELF, &usage) == 0 ? 1024 * static_cast<std::uint64_t>(usage.ru_maxrss) : 0;
}

}  // namespace

void Statistics::add(const Frame& frame) {
    std::string times;
    for (const auto& part : frame.parts)
        times += fmt::format("{}{}: {:.2f}", times.empty() ? "" : ", ", jsonText(part.name), part.milliseconds);
    const auto outcome = static_cast<std::size_t>(frame.outcome);
    const std::lock_guard lock(mutex_);
    ++counts_[outcome];
    frames_ +=
        fmt::format("{}  {{\"file\": {}, \"frame\": {}, \"outcome\": \"{}\", \"parts\": {{{}}}, \"total\": {:.2f}{}}}",
            frames_.empty() ? "" : ",\n", jsonText(frame.file.string()), frame.frame, kOutcomes[outcome], times,
            frame.total, frame.problem.empty() ? "" : ", \"problem\": " + jsonText(frame.problem));
}

std::string Statistics::json(const std::string& device, ExitCode exitCode, double seconds) const {
    const std::lock_guard lock(mutex_);
    return fmt::format(
        "{{\"version\": {}, \"limn\": {}, \"device\": {}, \"exit_code\": {}, \"seconds\": {:.2f}, \"peak_memory\": "
        "{},\n"
        " \"drawn\": {}, \"same\": {}, \"kept\": {}, \"failed\": {},\n \"frames\": [\n{}\n]}}\n",
        kFormatVersion, jsonText(fmt::format("limn {}", kVersion)), jsonText(device), static_cast<int>(exitCode),
        seconds, peakMemory(), counts_[0], counts_[1], counts_[2], counts_[3], frames_);
}

}  // namespace limn
