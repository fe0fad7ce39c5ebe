#include "base/heap.h"

#include <tbb/parallel_for.h>

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

namespace limn {

constexpr std::size_t kLargestOfHeap = std::size_t{32} << 20;  // glibc's own limit for its threshold

void keepFreedMemory() {
    mallopt(M_MMAP_THRESHOLD, static_cast<int>(kLargestOfHeap));
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    mallopt(M_TOP_PAD, 4 << 20);
}

void bringInPages(std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
    constexpr std::size_t kBlock = 8 << 20;
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    // These blocks lie side by side in the heap, and merge again when freed.
    std::vector<std::unique_ptr<void, decltype(&std::free)>> blocks;
    for (std::size_t done = 0; done < bytes; done += kBlock) blocks.emplace_back(std::malloc(kBlock), &std::free);
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
        if (!blocks[i]) return;
        const auto begin = (reinterpret_cast<std::uintptr_t>(blocks[i].get()) + page - 1) / page * page,
                   end = (reinterpret_cast<std::uintptr_t>(blocks[i].get()) + kBlock) / page * page;
        madvise(reinterpret_cast<void*>(begin), end - begin, MADV_POPULATE_WRITE);
    });
#else
    static_cast<void>(bytes);
#endif
}

}  // namespace limn
