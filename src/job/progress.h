// How far a run is, said to people, terminals and farms.
#pragma once

#include "settings/values.h"

#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace limn {

/// How it is said where no terminal watches: as sentences, or as the lines that farms read (Tractor, Open Job
/// Description), which go to standard output.
enum class ProgressForm { plain, alf, openjd };
inline constexpr std::array<std::string_view, 3> kProgressForms{"plain", "alf", "openjd"};

/// On a terminal one line below all others: frames, time per frame and time left. Elsewhere a sentence two seconds
/// after something began and every ten seconds from then on, or a farm's line as soon as a percent is done. Has a
/// thread of its own, so that work that cannot tell how far it is does not leave people without a word.
class Progress {
public:
    /// `limit`: the process ends (75) where one frame takes longer by far, in whatever it hangs; zero: never.
    Progress(ProgressForm form, std::chrono::duration<double> limit);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// The run's share that begins with the next frame: a config's, of `frames` frames.
    void beginJob(std::size_t job, std::size_t jobs, std::size_t frames);
    /// `what`: "room.png". The limit holds for frames.
    void begin(const std::string& what, bool isFrame = false);
    /// How much of it is done, 0 to 1. Shares below 0 are not known.
    void reach(double share);
    void end();
    /// One of the job's frames is done, or needed nothing.
    void frameDone(bool wasDrawn);

private:
    using Clock = std::chrono::steady_clock;
    void tell();
    void tellFarm();
    std::string bar() const;
    double done() const;  ///< of the run, 0 to 1

    const ProgressForm form_;
    const std::chrono::duration<double> limit_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::string what_;  ///< empty: nothing goes on
    double share_ = -1;
    std::size_t job_ = 0, jobs_ = 1, frames_ = 0, framesDone_ = 0, framesDrawn_ = 0;
    Clock::time_point begun_, next_, lastDrawn_, jobBegun_ = Clock::now();
    int toldPercent_ = -1;
    bool isFrame_ = false, isOver_ = false;
    std::thread thread_;
};

}  // namespace limn
