// The report of a run: the file of --stats.
#pragma once

#include "job/flicker.h"
#include "render/renderer.h"

#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>

namespace limn {

/// What became of a frame: it was drawn, it shows the same as another one, its files were complete and current, or it
/// failed.
enum class FrameOutcome { drawn, same, kept, failed };

class Statistics {
public:
    struct Frame {
        std::filesystem::path file;
        int frame = 1;
        FrameOutcome outcome = FrameOutcome::drawn;
        std::vector<PartTime> parts;  ///< in order of execution
        double total = 0;             ///< milliseconds, from its begin until its files were in place
        std::string problem;          ///< of a failed frame
        std::optional<FlickerFigure> flicker;
    };

    /// What a config's pictures are to keep; empty: nothing.
    void promise(const std::string& text);
    /// May be called by several threads.
    void add(const Frame& frame);
    /// JSON: {"version", "limn", "device", "exit_code", "seconds", "peak_memory", "quality": [TEXT], "drawn", "same",
    /// "kept", "failed", "frames": [{"file", "frame", "outcome", "parts": {NAME: ms}, "total": ms, "problem",
    /// "flicker": {"mean", "p99", "compared"}}]}; of all frames "flicker": {"mean", "largest"}.
    std::string json(const std::string& device, ExitCode exitCode, double seconds) const;

private:
    mutable std::mutex mutex_;
    std::string frames_, promises_;
    std::size_t counts_[4] = {};
    std::size_t flickerCount_ = 0;
    double flickerSum_ = 0, flickerLargest_ = 0;
};

}  // namespace limn
