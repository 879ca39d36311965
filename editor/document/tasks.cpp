// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/tasks.h"

#include <QMetaObject>

namespace hairloom::editor {

Tasks::Tasks(QObject* parent) : QObject(parent) {}

Tasks::~Tasks() {
    if (control_) control_->cancel();
    if (thread_.joinable()) thread_.join();
}

bool Tasks::start(const QString& name, std::function<Finish(TaskControl&)> work) {
    if (isBusy()) {
        Q_EMIT failed(tr("%1 is still running").arg(name_));
        return false;
    }
    control_ = std::make_shared<TaskControl>();
    name_ = name;
    ready_ = false;
    thread_ = std::thread([this, work = std::move(work), control = control_] {
        finish_ = work(*control);
        ready_ = true;
        QMetaObject::invokeMethod(this, &Tasks::end, Qt::QueuedConnection);
    });
    Q_EMIT started(name);
    return true;
}

void Tasks::cancel() {
    if (control_) control_->cancel();
}

void Tasks::finish() {
    if (!thread_.joinable()) return;
    thread_.join();
    thread_ = std::thread();
    const Finish finish = std::exchange(finish_, nullptr);
    const bool dropped = control_->isCancelled();
    control_.reset();
    ready_ = false;
    Q_EMIT stopped();
    if (finish && !dropped) finish(*this);
}

void Tasks::end() {
    // finish() may have been called before the message arrived.
    if (ready_) finish();
}

}  // namespace hairloom::editor
