// What a run tells of itself in numbers: the file of --stats.
#pragma once

#include "render/renderer.h"

#include <filesystem>
#include <string>

namespace limn {

class Statistics {
public:
    /// Milliseconds; `parts` in the order in which they were done.
    void addFrame(const std::filesystem::path& file, int frame, const std::vector<PartTime>& parts, double total);
    /// JSON: {"version", "frames": [{"file", "frame", "parts": {NAME: ms}, "total": ms}]}.
    std::string json() const;

private:
    std::string frames_;
};

}  // namespace limn
