// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Messages for people. Nothing here is a result: what a caller must act on is returned, not logged.

#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>

namespace hairloom::log {

enum class Level { Debug, Info, Warning, Error };

/// Receives every message at or above the threshold; called from any thread, one call at a time.
using Sink = std::function<void(Level, std::string_view)>;

/// Replaces standard error as the destination; an empty sink restores it.
void setSink(Sink sink);
void setThreshold(Level level);
void write(Level level, std::string_view message);

template <class... Args>
void debug(fmt::format_string<Args...> format, Args&&... args) {
    write(Level::Debug, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void info(fmt::format_string<Args...> format, Args&&... args) {
    write(Level::Info, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void warning(fmt::format_string<Args...> format, Args&&... args) {
    write(Level::Warning, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void error(fmt::format_string<Args...> format, Args&&... args) {
    write(Level::Error, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace hairloom::log
