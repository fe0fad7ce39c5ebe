// The numbers of a run: the file of --stats.
#pragma once

#include "render/renderer.h"

#include <filesystem>
#include <string>

namespace limn {

class Statistics {
public:
    /// Milliseconds; `parts` are in order of execution.
    void addFrame(const std::filesystem::path& file, int frame, const std::vector<PartTime>& parts, double total);
    /// JSON: {"version", "frames": [{"file", "frame", "parts": {NAME: ms}, "total": ms}]}.
    std::string json() const;

private:
    std::string frames_;
};

}  // namespace limn
