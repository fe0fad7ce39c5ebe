// What the process does when it is told to end.
#pragma once

namespace limn {

/// From now on SIGINT, SIGTERM and SIGHUP end the process at once, as they do by default, but leave no temporary
/// behind: files that are complete stay, others stay as they were. Call before any thread is started, since threads
/// inherit what is blocked; programs that are started inherit it as well and must undo it (unblockSignals).
void endCleanlyOnSignals();

/// Gives a child process back what endCleanlyOnSignals() took.
void unblockSignals();

}  // namespace limn
