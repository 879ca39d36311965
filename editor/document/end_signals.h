// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The system's word that the program is to end, where the window can act on it.

#include <QObject>
#include <chrono>
#include <functional>
#include <memory>

namespace hairloom::editor {

/// SIGTERM, SIGINT and SIGHUP; Windows says so by QGuiApplication::commitDataRequest() alone. The second of a
/// kind ends the process at once. One lives at a time.
///
/// A thread of its own waits for them, so that the process ends in time whatever the interface thread does:
/// that thread has `patience` to take the word, and `writing` to call endProcess() then.
class EndSignals : public QObject {
    Q_OBJECT

  public:
    struct Times {
        std::chrono::milliseconds patience{5'000};
        std::chrono::milliseconds writing{20'000};
    };
    /// `lastResort` is called on another thread where the interface thread does not take the word; then the
    /// process ends.
    explicit EndSignals(std::function<void()> lastResort = {}, QObject* parent = nullptr)
        : EndSignals(std::move(lastResort), Times(), parent) {}
    EndSignals(std::function<void()> lastResort, Times times, QObject* parent = nullptr);
    /// Leaves the signals to whom they were before.
    ~EndSignals() override;

    /// The number of the one that came, 0 for none.
    int last() const { return last_; }
    /// Ends the process as the signal that came would have; returns where none came.
    void endProcess() const;

  Q_SIGNALS:
    void received(int signal);

  private:
    int last_ = 0;
    struct Watch;
    std::unique_ptr<Watch> watch_;
};

}  // namespace hairloom::editor
