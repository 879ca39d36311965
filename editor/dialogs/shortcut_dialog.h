// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Shows and changes the keyboard shortcuts of all actions.

#include <QDialog>
#include <QLabel>
#include <QLineEdit>
#include <QTreeWidget>

#include "editor/style/actions.h"

namespace hairloom::editor {

class ShortcutDialog : public QDialog {
    Q_OBJECT

  public:
    explicit ShortcutDialog(Actions& actions, QWidget* parent = nullptr);

  private:
    void fill();
    void filter(const QString& text);

    Actions& actions_;
    QTreeWidget* list_;
    QLabel* message_;
};

}  // namespace hairloom::editor
