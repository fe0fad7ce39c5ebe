#include "job/behind.h"

#include <utility>

namespace limn {
namespace {

/// Besides the one that runs. Bands of a few rows come in bursts.
constexpr std::size_t kMostWaiting = 8;

}  // namespace

Behind::Behind() : thread_([this] { work(); }) {}

Behind::~Behind() {
    {
        const std::lock_guard lock(mutex_);
        isOver_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Behind::throwIfFailed() {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Behind::post(std::function<void()> task) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return tasks_.size() < kMostWaiting || failure_; });
    throwIfFailed();
    tasks_.push_back(std::move(task));
    changed_.notify_all();
}

void Behind::wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return (tasks_.empty() && !isBusy_) || failure_; });
    throwIfFailed();
}

void Behind::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [&] { return !tasks_.empty() || isOver_; });
        if (tasks_.empty()) return;
        const auto task = std::move(tasks_.front());
        tasks_.pop_front();
        isBusy_ = true;
        changed_.notify_all();
        lock.unlock();
        std::exception_ptr failure;
        try {
            task();
        } catch (...) { failure = std::current_exception(); }
        lock.lock();
        isBusy_ = false;
        if (failure) {
            failure_ = failure;
            tasks_.clear();
        }
        changed_.notify_all();
    }
}

}  // namespace limn
