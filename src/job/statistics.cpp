#include "job/statistics.h"

#include "base/text.h"
#include "settings/document.h"

#include <fmt/format.h>

namespace limn {

void Statistics::addFrame(
    const std::filesystem::path& file, int frame, const std::vector<PartTime>& parts, double total) {
    std::string times;
    for (const auto& part : parts)
        times += fmt::format("{}{}: {:.2f}", times.empty() ? "" : ", ", jsonText(part.name), part.milliseconds);
    frames_ += fmt::format("{}  {{\"file\": {}, \"frame\": {}, \"parts\": {{{}}}, \"total\": {:.2f}}}",
        frames_.empty() ? "" : ",\n", jsonText(file.string()), frame, times, total);
}

std::string Statistics::json() const {
    return fmt::format("{{\"version\": {}, \"frames\": [\n{}\n]}}\n", kFormatVersion, frames_);
}

}  // namespace limn
