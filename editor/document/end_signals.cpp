// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/end_signals.h"

#ifndef _WIN32
#include <fcntl.h>
#include <unistd.h>

#include <QSocketNotifier>
#include <array>
#include <cerrno>
#include <csignal>
#endif

namespace hairloom::editor {

#ifdef _WIN32

EndSignals::EndSignals(QObject* parent) : QObject(parent) {}
EndSignals::~EndSignals() = default;
void EndSignals::endProcess() const {}

#else

namespace {

constexpr std::array kSignals{SIGTERM, SIGINT, SIGHUP};

/// What the handler may touch.
std::array<int, 2> ends{-1, -1};                           // NOLINT(readability-identifier-naming)
std::array<struct sigaction, kSignals.size()> previous{};  // NOLINT(readability-identifier-naming)

extern "C" void tellWindow(int signal) {
    const int code = errno;
    // Whoever sends it again does not want to wait.
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        if (kSignals[i] == signal) sigaction(signal, &previous[i], nullptr);
    }
    const auto number = static_cast<unsigned char>(signal);
    if (write(ends[1], &number, 1) != 1) raise(signal);
    errno = code;
}

}  // namespace

EndSignals::EndSignals(QObject* parent) : QObject(parent) {
    if (pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) return;
    auto* notifier = new QSocketNotifier(ends[0], QSocketNotifier::Read, this);
    connect(notifier, &QSocketNotifier::activated, this, [this] {
        unsigned char number = 0;
        if (read(ends[0], &number, 1) != 1) return;
        last_ = number;
        Q_EMIT received(last_);
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
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &previous[i], nullptr);
    for (int& end : ends) {
        close(end);
        end = -1;
    }
}

void EndSignals::endProcess() const {
    if (last_ != 0) raise(last_);
}

#endif

}  // namespace hairloom::editor
