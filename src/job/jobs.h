// What a run has to do: configs with the files they make.
#pragma once

#include "job/progress.h"
#include "job/session.h"

#include <functional>
#include <string>
#include <vector>

namespace limn {

/// The options of the command line.
struct RunOptions {
    std::vector<std::string> configs;
    ConfigOverrides overrides;
    std::string output;           ///< a file, a folder, or a pattern with {config} and ####; empty: from the configs
    std::string frames;           ///< a list of frames; empty: all declared ones
    bool firstFrameOnly = false;  ///< of those
    std::string chunk;            ///< "I/N": the I-th of N equal parts of each config's frames; empty: all
    std::string crop;             ///< X,Y,W,H in pixels from the upper left; empty: everything
    std::string stats;            ///< file for the report of the run; empty: none
    bool strict = false;          ///< values that are not finite end the run
    bool keepGoing = false;       ///< a frame that fails does not end the run
    bool resume = false;          ///< keeps frames whose files are whole and current
    double frameTimeout = 0;      ///< seconds after which a frame counts as failed; 0: never
    ProgressForm progress = ProgressForm::plain;
    SessionOptions session;
    /// Chooses the settings of a config that asks for a quality, for its output.
    std::function<RenderConfig(Session&, const RenderConfig&, const ConfigOverrides&, const std::filesystem::path&)>
        keepQuality;
};

/// A config and all that is known about it before drawing.
struct Job {
    RenderConfig config;
    std::filesystem::path output;
    PixelRect crop;  ///< empty: everything
};

/// Reads all configs, and reports every problem in them before anything is drawn (Errors).
std::vector<Job> readJobs(const RunOptions& options);

/// A job's frames in their order. Throws Error.
std::vector<int> framesOf(const Job& job, const RunOptions& options, const LoadedScene& loaded);

}  // namespace limn
