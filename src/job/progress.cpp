#include "job/progress.h"

#include "base/file.h"
#include "base/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace limn {
namespace {

constexpr std::chrono::seconds kFirst{2}, kThen{10};
constexpr std::chrono::milliseconds kLook{200};  ///< how often a bar and a farm's percent are looked at

/// A frame that does not stop by itself at its limit gets as long again, and at least this.
constexpr std::chrono::duration<double> kGrace{10};

/// "1:02:03" or "2:03".
std::string clockText(double seconds) {
    const auto all = static_cast<long>(std::llround(std::min(seconds, 1e7)));
    return all >= 3600 ? fmt::format("{}:{:02}:{:02}", all / 3600, all / 60 % 60, all % 60)
                       : fmt::format("{}:{:02}", all / 60, all % 60);
}

}  // namespace

Progress::Progress(ProgressForm form, std::chrono::duration<double> limit)
    : form_(form), limit_(limit), thread_([this] { tell(); }) {}

Progress::~Progress() {
    {
        const std::lock_guard lock(mutex_);
        isOver_ = true;
    }
    changed_.notify_one();
    thread_.join();
    log::status("");
}

void Progress::beginJob(std::size_t job, std::size_t jobs, std::size_t frames) {
    const std::lock_guard lock(mutex_);
    job_ = job;
    jobs_ = std::max<std::size_t>(jobs, 1);
    frames_ = frames;
    framesDone_ = framesDrawn_ = 0;
    jobBegun_ = Clock::now();
}

void Progress::begin(const std::string& what, bool isFrame) {
    {
        const std::lock_guard lock(mutex_);
        what_ = what;
        isFrame_ = isFrame;
        share_ = -1;
        begun_ = Clock::now();
        next_ = begun_ + kFirst;
    }
    changed_.notify_one();
}

void Progress::reach(double share) {
    const std::lock_guard lock(mutex_);
    share_ = share;
}

void Progress::end() {
    const std::lock_guard lock(mutex_);
    what_.clear();
    share_ = -1;
}

void Progress::frameDone(bool wasDrawn) {
    const std::lock_guard lock(mutex_);
    ++framesDone_;
    framesDrawn_ += wasDrawn ? 1 : 0;
    if (wasDrawn) lastDrawn_ = Clock::now();
    tellFarm();
}

double Progress::done() const {
    if (frames_ == 0) return static_cast<double>(job_) / static_cast<double>(jobs_);
    const double ofJob =
        (static_cast<double>(framesDone_) + std::clamp(share_, 0.0, 1.0)) / static_cast<double>(frames_);
    return (static_cast<double>(job_) + std::min(ofJob, 1.0)) / static_cast<double>(jobs_);
}

void Progress::tellFarm() {
    if (form_ == ProgressForm::plain) return;
    const int percent = static_cast<int>(100 * done());
    if (percent <= toldPercent_) return;
    toldPercent_ = percent;
    std::puts(form_ == ProgressForm::alf ? fmt::format("ALF_PROGRESS {}%", percent).c_str()
                                         : fmt::format("openjd_progress: {}", percent).c_str());
    std::fflush(stdout);
}

std::string Progress::bar() const {
    constexpr std::size_t kWidth = 24;
    const auto filled = static_cast<std::size_t>(kWidth * done());
    std::string text = "[" + std::string(filled, '=') + std::string(kWidth - filled, ' ') + "] ";
    if (frames_ > 1) text += fmt::format("{}/{} frames, ", std::min(framesDone_ + 1, frames_), frames_);
    text += what_;
    if (share_ >= 0) text += fmt::format(" {:.0f} %", 100 * share_);
    if (framesDrawn_ > 0) {
        const double each =
            std::chrono::duration<double>(lastDrawn_ - jobBegun_).count() / static_cast<double>(framesDrawn_);
        text +=
            fmt::format(", {:.2f} s each, {} left", each, clockText(each * static_cast<double>(frames_ - framesDone_)));
    } else if (share_ > 0.02) {
        const double gone = std::chrono::duration<double>(Clock::now() - begun_).count();
        text += fmt::format(", {} left", clockText(gone * (1 - share_) / share_));
    }
    return text;
}

void Progress::tell() {
    std::unique_lock lock(mutex_);
    const bool hasBar = form_ == ProgressForm::plain && log::showsStatus();
    const bool looksOften = hasBar || form_ != ProgressForm::plain;
    while (!isOver_) {
        if (what_.empty()) {
            changed_.wait(lock);
            continue;
        }
        const auto now = Clock::now();
        if (isFrame_ && limit_.count() > 0 && now - begun_ > limit_ + std::max(limit_, kGrace)) {
            log::error("{} took longer than {} s and did not stop", what_, limit_.count());
            abandonPendingFiles();
            std::_Exit(static_cast<int>(ExitCode::transient));
        }
        if (hasBar && now - begun_ > kLook) log::status(bar());
        tellFarm();
        if (now >= next_) {
            next_ = now + kThen;
            if (!hasBar && share_ >= 0)
                log::info("{}: {:.0f} %", what_, 100 * share_);
            else if (!hasBar)
                log::info("{} ...", what_);
        }
        changed_.wait_until(lock, looksOften || limit_.count() > 0 ? std::min(next_, now + kLook) : next_);
    }
}

}  // namespace limn
