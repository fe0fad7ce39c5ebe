// Messages for people, on standard error. What a command was asked for goes to standard output instead.
#pragma once

#include "base/text.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace limn::log {

enum class Level { debug, info, warning, error };

/// Lowest level that is shown; colour only on a terminal, and never when NO_COLOR is set.
void configure(Level lowest);
void write(Level level, std::string_view message);

/// Can a line be shown that is replaced again and again: is standard error a terminal that takes it?
bool showsStatus();
/// Replaces the line below all messages; an empty text removes it. Only where showsStatus().
void status(const std::string& line);

template <class... Args>
void debug(fmt::format_string<Args...> text, Args&&... args) {
    write(Level::debug, fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
void info(fmt::format_string<Args...> text, Args&&... args) {
    write(Level::info, fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
void warning(fmt::format_string<Args...> text, Args&&... args) {
    write(Level::warning, presentable(fmt::format(text, std::forward<Args>(args)...)));
}
/// Only for what ends the run: some farms fail a task as soon as they read the word "error".
template <class... Args>
void error(fmt::format_string<Args...> text, Args&&... args) {
    write(Level::error, fmt::format(text, std::forward<Args>(args)...));
}

}  // namespace limn::log
