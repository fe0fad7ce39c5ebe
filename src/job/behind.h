// Work that goes on behind the one that gives it out: pictures are encoded while the next is drawn.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace limn {

/// Runs tasks one after another on a thread of its own. Few wait at a time: what they hold is bounded.
class Behind {
public:
    Behind();
    /// Finishes what was given.
    ~Behind();
    Behind(const Behind&) = delete;
    Behind& operator=(const Behind&) = delete;

    /// Adds a task; waits while too many wait already. Throws what an earlier task threw; those after it were left out.
    void post(std::function<void()> task);
    /// Waits for all tasks. Throws what one of them threw.
    void wait();

private:
    void work();
    void throwIfFailed();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_;
    bool isBusy_ = false, isOver_ = false;
    std::exception_ptr failure_;
    std::thread thread_;
};

}  // namespace limn
