// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/tasks.h"

#include <QMetaObject>
#include <utility>

#include "core/base/stop_scope.h"

namespace hairloom::editor {

Tasks::Tasks(QObject* parent) : QObject(parent) {}

Tasks::~Tasks() {
    if (control_) control_->cancel();
    if (thread_.joinable()) thread_.join();
}

bool Tasks::start(const QString& name, std::function<Finish(TaskControl&)> work) {
    if (isBusy()) {
        Q_EMIT failed(QString("%1 is still running").arg(name_));
        return false;
    }
    control_ = std::make_shared<TaskControl>();
    name_ = name;
    ready_ = isUsersWish_ = false;
    thread_ = std::thread([this, work = std::move(work), control = control_] {
        const StopScope scope(*control->cancelFlag());
        finish_ = work(*control);
        ready_ = true;
        QMetaObject::invokeMethod(this, &Tasks::end, Qt::QueuedConnection);
    });
    Q_EMIT started(name);
    return true;
}

void Tasks::cancel() {
    isUsersWish_ = true;
    drop();
}

void Tasks::drop() {
    if (control_) control_->cancel();
}

void Tasks::finish() {
    if (!thread_.joinable()) return;
    thread_.join();
    thread_ = std::thread();
    const Finish finish = std::exchange(finish_, nullptr);
    const bool dropped = control_->isCancelled(), isCancelled = dropped && isUsersWish_;
    const QString name = name_;
    const std::optional<ProcessorWatch> watch = std::exchange(watch_, std::nullopt);
    const double others = watch ? watch->othersShare().value_or(0) : 0;
    control_.reset();
    ready_ = false;
    Q_EMIT stopped();
    if (isCancelled) Q_EMIT cancelled(name);
    if (!finish || dropped) return;
    finish(*this);
    if (others > kBusyShare)
        Q_EMIT disturbed(
            QString("Other programs used %1 % of the processors meanwhile: the times may be too high")
                .arg(100 * others, 0, 'f', 0));
}

void Tasks::end() {
    // finish() may have been called before the message arrived.
    if (ready_) finish();
}

}  // namespace hairloom::editor
