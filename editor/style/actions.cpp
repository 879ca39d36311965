// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/style/actions.h"

#include <QSettings>
#include <cassert>

#include "editor/style/icons.h"

namespace hairloom::editor {
namespace {

QString keyOf(const QString& id) {
    return "shortcuts/" + id;
}

}  // namespace

Actions::Actions(QWidget& window) : QObject(&window), window_(window) {}

QAction& Actions::add(const ActionInfo& info, std::function<void()> run) {
    auto* action = new QAction(info.text, this);
    action->setObjectName(info.id);
    action->setCheckable(info.checkable);
    if (!info.icon.isEmpty()) action->setIcon(icon(info.icon));
    connect(action, &QAction::triggered, this, [run = std::move(run)] { run(); });
    window_.addAction(action);
    infos_.push_back(info);
    actions_.insert(info.id, action);
    apply(info, QKeySequence(QSettings().value(keyOf(info.id), info.shortcut.toString()).toString()));
    return *action;
}

QAction& Actions::get(const QString& id) const {
    QAction* const action = actions_.value(id);
    assert(action);
    return *action;
}

QString Actions::setShortcut(const QString& id, const QKeySequence& shortcut) {
    QString robbed;
    for (const ActionInfo& info : infos_) {
        if (info.id == id) {
            apply(info, shortcut);
            QSettings().setValue(keyOf(id), shortcut.toString());
        } else if (!shortcut.isEmpty() && get(info.id).shortcut() == shortcut) {
            robbed = info.id;
            apply(info, {});
            QSettings().setValue(keyOf(info.id), QString());
        }
    }
    return robbed;
}

void Actions::resetShortcuts() {
    for (const ActionInfo& info : infos_) {
        QSettings().remove(keyOf(info.id));
        apply(info, info.shortcut);
    }
}

void Actions::apply(const ActionInfo& info, const QKeySequence& shortcut) {
    QAction& action = get(info.id);
    action.setShortcut(shortcut);
    const QString keys = shortcut.toString(QKeySequence::NativeText);
    QString name = info.text;
    name.remove(QChar(0x2026)).remove('&');
    action.setToolTip(
        QStringLiteral("<p><b>%1</b>%2</p><p>%3</p>")
            .arg(name, keys.isEmpty() ? QString() : QStringLiteral("  (%1)").arg(keys), info.tip));
    action.setStatusTip(info.tip);
}

}  // namespace hairloom::editor
