// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/end_signals.h"

#ifndef _WIN32
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <thread>
#endif

namespace hairloom::editor {

#ifdef _WIN32

struct EndSignals::Watch {};
EndSignals::EndSignals(std::function<void()>, Times, QObject* parent) : QObject(parent) {}
EndSignals::~EndSignals() = default;
void EndSignals::endProcess() const {}

#else

namespace {

constexpr std::array kSignals{SIGTERM, SIGINT, SIGHUP};

/// What the handler may touch.
std::array<int, 2> ends{-1, -1};                           // NOLINT(readability-identifier-naming)
std::array<struct sigaction, kSignals.size()> previous{};  // NOLINT(readability-identifier-naming)

/// To whom the signal was before.
void giveBack(int signal) {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        if (kSignals[i] == signal) sigaction(signal, &previous[i], nullptr);
    }
}

extern "C" void tellWindow(int signal) {
    const int code = errno;
    // Whoever sends it again does not want to wait.
    giveBack(signal);
    const auto number = static_cast<unsigned char>(signal);
    if (write(ends[1], &number, 1) != 1) raise(signal);
    errno = code;
}

}  // namespace

struct EndSignals::Watch {
    enum class State : std::uint8_t { Waiting, Taken, GivenUp };

    std::thread thread;
    std::mutex mutex;
    std::condition_variable turned;
    State state = State::Waiting;
    bool isOver = false;

    /// False where the window goes first.
    template <class Reached>
    bool runsOut(std::chrono::milliseconds time, Reached reached) {
        std::unique_lock lock(mutex);
        return !turned.wait_for(lock, time, [&] { return isOver || reached(); });
    }
    /// Whether the interface thread has taken the word in time; then it is not given up any more.
    bool give(std::chrono::milliseconds patience) {
        if (!runsOut(patience, [&] { return state == State::Taken; })) return true;
        const std::lock_guard lock(mutex);
        if (state == State::Taken) return true;
        state = State::GivenUp;
        return false;
    }
    /// False where the process is already being ended.
    bool take() {
        const std::lock_guard lock(mutex);
        if (state == State::GivenUp) return false;
        state = State::Taken;
        turned.notify_all();
        return true;
    }
};

EndSignals::EndSignals(std::function<void()> lastResort, Times times, QObject* parent)
    : QObject(parent), watch_(std::make_unique<Watch>()) {
    if (pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) return;
    watch_->thread = std::thread([this, lastResort = std::move(lastResort), times] {
        unsigned char number = 0;
        pollfd waiting{ends[0], POLLIN, 0};
        while (poll(&waiting, 1, -1) < 0 && errno == EINTR) {
        }
        if (read(ends[0], &number, 1) != 1) return;  // the object goes
        QMetaObject::invokeMethod(
            this,
            [this, number] {
                // Nothing may change what the last resort writes.
                while (!watch_->take()) std::this_thread::sleep_for(std::chrono::seconds(1));
                last_ = number;
                Q_EMIT received(last_);
            },
            Qt::QueuedConnection);
        if (!watch_->give(times.patience)) {
            if (lastResort) lastResort();
        } else if (!watch_->runsOut(times.writing, [] { return false; })) {
            return;
        }
        giveBack(number);
        raise(number);
    });
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        // What the parent had ignored (nohup) stays ignored.
        if (sigaction(kSignals[i], nullptr, &previous[i]) != 0 || previous[i].sa_handler == SIG_IGN) continue;
        struct sigaction action {};
        action.sa_handler = tellWindow;
        sigfillset(&action.sa_mask);
        sigaction(kSignals[i], &action, nullptr);
    }
}

EndSignals::~EndSignals() {
    if (ends[0] < 0) return;
    for (const int signal : kSignals) giveBack(signal);
    {
        const std::lock_guard lock(watch_->mutex);
        watch_->isOver = true;
        watch_->turned.notify_all();
    }
    close(ends[1]);
    watch_->thread.join();
    close(ends[0]);
    ends = {-1, -1};
}

void EndSignals::endProcess() const {
    if (last_ == 0) return;
    giveBack(last_);
    raise(last_);
}

#endif

}  // namespace hairloom::editor
