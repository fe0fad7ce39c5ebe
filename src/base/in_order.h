// Work in two steps. The first runs on all cores. The second runs on the calling thread alone, in order, each as soon
// as its first step is done.
#pragma once

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <cstddef>
#include <exception>
#include <vector>

namespace limn {

/// Runs make(i) for i in [0, count) in parallel, and take(i) in order on the calling thread. That thread makes some
/// itself instead of waiting. What either throws comes out once everything under way has ended.
template <class Make, class Take>
void inOrder(std::size_t count, const Make& make, const Take& take) {
    struct State {
        std::atomic<bool> done = false;
        std::exception_ptr error;
    };
    std::vector<State> states(count);
    std::atomic<std::size_t> next = 0;
    const auto makeOne = [&] {
        const std::size_t i = next++;
        if (i >= count) return false;
        try {
            make(i);
        } catch (...) { states[i].error = std::current_exception(); }
        states[i].done = true;
        states[i].done.notify_one();
        return true;
    };
    tbb::task_group helpers;
    // A task group must be empty when it is destroyed, whatever happens here.
    struct Ending {
        tbb::task_group& group;
        std::atomic<std::size_t>& next;
        std::size_t count;
        ~Ending() { next = count, group.wait(); }
    } ending{helpers, next, count};
    for (int i = 1; i < tbb::this_task_arena::max_concurrency(); ++i)
        helpers.run([&] {
            while (makeOne()) {}
        });
    for (std::size_t i = 0; i < count; ++i) {
        while (!states[i].done)
            if (!makeOne()) states[i].done.wait(false);
        if (states[i].error) std::rethrow_exception(states[i].error);
        take(i);
    }
}

}  // namespace limn
