#include "base/memory.h"

#include "base/text.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <mutex>

namespace limn {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// The number in a file; unlimited where there is none ("max").
std::uint64_t numberIn(const std::string& path) {
    std::ifstream file(path);
    std::uint64_t number = 0;
    return file >> number ? number : kUnlimited;
}

/// The least limit of the control groups that this process belongs to (versions 2 and 1).
std::uint64_t groupLimit() {
    std::uint64_t least = kUnlimited;
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        if (!controllers.empty() && controllers != "memory") continue;
        const std::string root = controllers.empty() ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory",
                          file = controllers.empty() ? "/memory.max" : "/memory.limit_in_bytes";
        // Groups lie in each other.
        for (std::string group = line.substr(second + 1);; group.resize(group.rfind('/'))) {
            least = std::min(least, numberIn(fmt::format("{}{}{}", root, group == "/" ? "" : group, file)));
            if (group.find('/') == std::string::npos) break;
        }
    }
    return least;
}

std::uint64_t machineLimit() {
    const auto pages = static_cast<std::uint64_t>(std::max(::sysconf(_SC_PHYS_PAGES), 1L)),
               size = static_cast<std::uint64_t>(std::max(::sysconf(_SC_PAGESIZE), 1L));
    return pages * size / 10 * 8;
}

std::uint64_t usedMemory() {
    std::ifstream file("/proc/self/statm");
    std::uint64_t size = 0, resident = 0;
    file >> size >> resident;
    return resident * static_cast<std::uint64_t>(std::max(::sysconf(_SC_PAGESIZE), 1L));
}

std::mutex& mutex() {
    static std::mutex instance;
    return instance;
}
std::uint64_t askedLimit = 0, claimed = 0, usedBefore = 0;

}  // namespace

std::uint64_t memoryLimit() {
    static const std::uint64_t found = std::min(groupLimit(), machineLimit());
    const std::lock_guard lock(mutex());
    return askedLimit > 0 ? askedLimit : found;
}

void setMemoryLimit(std::uint64_t bytes) {
    const std::lock_guard lock(mutex());
    askedLimit = bytes;
}

std::optional<std::uint64_t> parseMemory(std::string_view text) {
    double unit = 1;
    constexpr std::string_view units = "kmgt";
    if (const auto at = text.empty() ? std::string_view::npos : units.find(lowerCase(text.substr(text.size() - 1)));
        at != std::string_view::npos) {
        unit = std::exp2(10.0 * static_cast<double>(at + 1));
        text.remove_suffix(1);
    }
    const auto number = parseNumber(text);
    if (!number || !(*number * unit >= 1) || *number * unit > 1e18) return std::nullopt;
    return static_cast<std::uint64_t>(*number * unit);
}

MemoryClaim::MemoryClaim(std::uint64_t bytes, const Location& where, const std::string& what, const std::string& remedy)
    : bytes_(bytes) {
    const std::uint64_t limit = memoryLimit();
    const std::lock_guard lock(mutex());
    // What claims have taken already must not count twice.
    if (claimed == 0) usedBefore = usedMemory();
    if (bytes > limit || usedBefore + claimed > limit - bytes)
        throw Error(ExitCode::outOfMemory, where,
            fmt::format("{} and would need about {}, with {} in use and {} allowed", what, bytesText(bytes),
                bytesText(usedBefore + claimed), bytesText(limit)),
            remedy);
    claimed += bytes;
}

MemoryClaim::~MemoryClaim() {
    const std::lock_guard lock(mutex());
    claimed -= bytes_;
}

}  // namespace limn
