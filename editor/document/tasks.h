// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Long work off the interface thread, one at a time, with its name, how far it is, and a way to stop it.

#include <QObject>
#include <QString>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "core/base/processor_watch.h"
#include "core/base/result.h"
#include "editor/document/words.h"

namespace hairloom::editor {

/// What work tells and is told while it runs; safe from any thread.
class TaskControl {
  public:
    /// 0 … 1; nothing said is an unknown share.
    void setProgress(float share) { progress_ = share; }
    float progress() const { return progress_; }
    /// Work that can stop early looks here; what it then returns is dropped.
    bool isCancelled() const { return cancelled_; }
    /// The same, for work that takes a flag.
    const std::atomic<bool>* cancelFlag() const { return &cancelled_; }
    void cancel() { cancelled_ = true; }

  private:
    std::atomic<float> progress_{-1};
    std::atomic<bool> cancelled_{false};
};

class Tasks : public QObject {
    Q_OBJECT

  public:
    explicit Tasks(QObject* parent = nullptr);
    /// Cancels and waits.
    ~Tasks() override;

    bool isBusy() const { return thread_.joinable(); }
    QString name() const { return name_; }
    /// 0 … 1, below 0 while unknown.
    float progress() const { return control_ ? control_->progress() : -1.0f; }

    /// Runs `work` on a thread of its own, then `done` with its result here, unless it was cancelled. False,
    /// with a word in failed(), while other work runs.
    template <class T>
    bool run(const QString& name, std::function<Result<T>(TaskControl&)> work, std::function<void(T)> done) {
        return start(name, [work = std::move(work), done = std::move(done)](TaskControl& control) {
            auto result = std::make_shared<Result<T>>(work(control));
            return Finish([result, done](Tasks& tasks) {
                if (*result) {
                    done(std::move(**result));
                } else {
                    Q_EMIT tasks.failed(errorText(result->error()));
                }
            });
        });
    }

    /// The same for work that measures times: where other programs took the processors meanwhile,
    /// disturbed() says so after `done`.
    template <class T>
    bool measure(const QString& name, std::function<Result<T>(TaskControl&)> work,
                 std::function<void(T)> done) {
        if (!run<T>(name, std::move(work), std::move(done))) return false;
        watch_.emplace();
        return true;
    }

    /// The user wants the work no more: it is asked to stop, what it finds is dropped in any case, and
    /// cancelled() tells once it has ended. Foreign files that it reads are read no further
    /// (core/base/stop_scope.h).
    void cancel();
    /// The same of work that other work takes the place of, or that nobody can see any more: without a word.
    void drop();
    /// Waits for the work and its `done`; for tests and for leaving the program.
    void finish();

  Q_SIGNALS:
    void started(const QString& name);
    void stopped();
    void failed(const QString& message);
    void cancelled(const QString& name);
    void disturbed(const QString& warning);

  private:
    using Finish = std::function<void(Tasks&)>;
    bool start(const QString& name, std::function<Finish(TaskControl&)> work);
    void end();

    std::thread thread_;
    std::shared_ptr<TaskControl> control_;
    QString name_;
    Finish finish_;
    std::atomic<bool> ready_{false};
    bool isUsersWish_ = false;             ///< that the work stops
    std::optional<ProcessorWatch> watch_;  ///< of work that measures
};

}  // namespace hairloom::editor
