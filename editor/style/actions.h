// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Every command of the window by name, with its icon, tooltip and keyboard shortcut; shortcuts can be changed
// and are kept.

#include <QAction>
#include <QKeySequence>
#include <QObject>
#include <QWidget>
#include <functional>
#include <vector>

namespace hairloom::editor {

struct ActionInfo {
    QString id;    ///< "file.open"; shortcuts are kept under it
    QString text;  ///< "Open…"
    QString icon;  ///< of icons.h, or empty
    QString tip;   ///< what it does, one sentence
    QKeySequence shortcut;
    bool checkable = false;
};

class Actions : public QObject {
    Q_OBJECT

  public:
    /// Shortcuts work in `window`.
    explicit Actions(QWidget& window);

    QAction& add(const ActionInfo& info, std::function<void()> run);
    /// The action of that id, which must have been added.
    QAction& get(const QString& id) const;
    /// In the order in which they were added.
    const std::vector<ActionInfo>& all() const { return infos_; }

    /// An empty sequence takes the shortcut away. Another action that has it loses it; its id is returned.
    QString setShortcut(const QString& id, const QKeySequence& shortcut);
    void resetShortcuts();

  private:
    void apply(const ActionInfo& info, const QKeySequence& shortcut);

    QWidget& window_;
    std::vector<ActionInfo> infos_;
    QHash<QString, QAction*> actions_;
};

}  // namespace hairloom::editor
