// A picture that follows its files.
#pragma once

#include "job/jobs.h"

namespace limn {

/// Draws a config, and again whenever a file changes that it or its scene is read from: as runJobs does, with one
/// session, so that only what has changed is read, made and uploaded. Errors are logged, and the next change tries
/// again. Ends with the process, by a signal; or where `isEnough`, called after each drawing, says so.
void watchJobs(const RunOptions& options, const std::function<bool()>& isEnough);

}  // namespace limn
