#include "job/progress.h"

#include "base/log.h"

namespace limn {
namespace {

constexpr std::chrono::seconds kFirst{2}, kThen{10};

}  // namespace

Progress::Progress() : thread_([this] { tell(); }) {}

Progress::~Progress() {
    {
        const std::lock_guard lock(mutex_);
        isOver_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void Progress::begin(const std::string& what) {
    {
        const std::lock_guard lock(mutex_);
        what_ = what;
        share_ = -1;
        next_ = Clock::now() + kFirst;
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
}

void Progress::tell() {
    std::unique_lock lock(mutex_);
    while (!isOver_) {
        if (what_.empty()) {
            changed_.wait(lock);
        } else if (Clock::now() < next_) {
            changed_.wait_until(lock, next_);
        } else {
            if (share_ >= 0)
                log::info("{}: {:.0f} %", what_, 100 * share_);
            else
                log::info("{} ...", what_);
            next_ = Clock::now() + kThen;
        }
    }
}

}  // namespace limn
