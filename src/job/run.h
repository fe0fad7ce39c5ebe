// A run: configs drawn into files, frame by frame.
#pragma once

#include "job/jobs.h"

namespace limn {

/// Draws everything. Progress and warnings go to the log. Throws errors that end the run; with `keepGoing` only those
/// before the first frame. Returns done; with `keepGoing` also someFramesFailed, or the first frame's code if all
/// failed.
ExitCode runJobs(const RunOptions& options);
/// The same in a session that goes on: it keeps its scenes and its device.
ExitCode runJobs(const RunOptions& options, Session& session);

}  // namespace limn
