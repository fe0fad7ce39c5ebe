// A run: configs drawn into files, frame by frame.
#pragma once

#include "job/session.h"

#include <functional>
#include <string>
#include <vector>

namespace limn {

/// The options of the command line.
struct RunOptions {
    std::vector<std::string> configs;
    ConfigOverrides overrides;
    std::string output;      ///< a file, a folder, or a pattern with {config} and ####; empty: from the configs
    std::string frames;      ///< a list of frames; empty: all declared ones
    std::string crop;        ///< X,Y,W,H in pixels from the upper left; empty: everything
    std::string stats;       ///< file for the times of each part; empty: none
    bool strict = false;     ///< values that are not finite end the run
    bool keepGoing = false;  ///< a frame that fails does not end the run
    SessionOptions session;
};

/// Draws everything. Progress and warnings go to the log. Throws errors that end the run; with `keepGoing` only those
/// before the first frame. Returns done; with `keepGoing` also someFramesFailed, or the first frame's code if all
/// failed.
ExitCode runJobs(const RunOptions& options);

}  // namespace limn
