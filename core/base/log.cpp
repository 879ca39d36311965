// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <mutex>

#include "core/base/utf8.h"

namespace hairloom::log {
namespace {

struct State {
    std::mutex mutex;
    Sink sink;
    std::shared_ptr<spdlog::logger> standardError = makeStandardError();

    static std::shared_ptr<spdlog::logger> makeStandardError() {
        auto logger = std::make_shared<spdlog::logger>(
            "hairloom", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
        logger->set_pattern("%^%l%$: %v");
        logger->set_level(spdlog::level::debug);
        return logger;
    }
};

State& state() {
    static State instance;
    return instance;
}

std::atomic<Level> threshold{Level::Info};

spdlog::level::level_enum toSpdlog(Level level) {
    switch (level) {
        case Level::Debug:
            return spdlog::level::debug;
        case Level::Info:
            return spdlog::level::info;
        case Level::Warning:
            return spdlog::level::warn;
        case Level::Error:
            return spdlog::level::err;
    }
    return spdlog::level::info;
}

}  // namespace

void setSink(Sink sink) {
    std::lock_guard lock(state().mutex);
    state().sink = std::move(sink);
}

void setThreshold(Level level) {
    threshold = level;
}

void write(Level level, std::string_view message) {
    if (level < threshold.load(std::memory_order_relaxed)) return;
    std::lock_guard lock(state().mutex);
    if (state().sink) {
        state().sink(level, message);
    } else {
        state().standardError->log(toSpdlog(level), "{}", cleanUtf8(message));
    }
}

}  // namespace hairloom::log
