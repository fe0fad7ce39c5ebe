// What a run is at, said where it takes long.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace limn {

/// Tells the log what goes on, two seconds after it began and every ten seconds from then on. Silent where work ends
/// sooner. Has a thread of its own, so that work that cannot tell how far it is does not leave people without a word.
class Progress {
public:
    Progress();
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `what`: "room.png".
    void begin(const std::string& what);
    /// How much of it is done, 0 to 1. Shares below 0 are not known.
    void reach(double share);
    void end();

private:
    using Clock = std::chrono::steady_clock;
    void tell();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::string what_;  ///< empty: nothing goes on
    double share_ = -1;
    Clock::time_point next_;
    bool isOver_ = false;
    std::thread thread_;
};

}  // namespace limn
