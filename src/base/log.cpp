#include "base/log.h"

#include <spdlog/sinks/ansicolor_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <mutex>

namespace limn::log {
namespace {

spdlog::logger& logger() {
    static const auto instance = [] {
        const bool colour = isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
        auto sink = std::make_shared<spdlog::sinks::ansicolor_stderr_sink_mt>(
            colour ? spdlog::color_mode::always : spdlog::color_mode::never);
        auto made = std::make_shared<spdlog::logger>("limn", sink);
        made->set_level(spdlog::level::info);
        made->flush_on(spdlog::level::trace);
        return made;
    }();
    return *instance;
}

spdlog::level::level_enum toSpdlog(Level level) {
    switch (level) {
        case Level::debug: return spdlog::level::debug;
        case Level::info: return spdlog::level::info;
        case Level::warning: return spdlog::level::warn;
        case Level::error: return spdlog::level::err;
    }
    return spdlog::level::err;
}

}  // namespace

void configure(Level lowest) { logger().set_level(toSpdlog(lowest)); }

void write(Level level, std::string_view message) {
    // Pattern and message belong together, whichever thread speaks.
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    // Information is the normal voice and needs no prefix.
    logger().set_pattern(level == Level::info ? "%v" : "%^%l%$: %v");
    logger().log(toSpdlog(level), message);
}

}  // namespace limn::log
