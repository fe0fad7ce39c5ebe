#include "base/log.h"

#include <spdlog/sinks/ansicolor_sink.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
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

/// What is said at a time, and the line that stays below it.
struct Voice {
    std::mutex mutex;
    std::string status;
};
Voice& voice() {
    static auto* const instance = new Voice;  // outlives every thread
    return *instance;
}

void show(const std::string& text) {
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
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
    const std::lock_guard lock(voice().mutex);
    const bool shown = !voice().status.empty();
    if (shown) show("\r\033[K");
    // Information is the normal voice and needs no prefix.
    logger().set_pattern(level == Level::info ? "%v" : "%^%l%$: %v");
    logger().log(toSpdlog(level), message);
    if (shown) show(voice().status);
}

bool showsStatus() {
    static const bool shows = [] {
        const char* const terminal = std::getenv("TERM");
        return isatty(STDERR_FILENO) != 0 && terminal && std::string_view(terminal) != "dumb";
    }();
    return shows && logger().should_log(spdlog::level::info);
}

void status(const std::string& line) {
    const std::lock_guard lock(voice().mutex);
    if (line.empty() && voice().status.empty()) return;
    // A line that the terminal breaks could not be taken back.
    struct winsize size {};
    const bool isKnown = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    voice().status = line.substr(0, isKnown ? size.ws_col - 1u : 79u);
    show("\r\033[K" + voice().status);
}

}  // namespace limn::log
