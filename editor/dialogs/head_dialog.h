// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A look at the head of a file before it is opened: its size, unit, axis and groups.

#include <QButtonGroup>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>

#include "core/scene/head_import.h"
#include "editor/document/preferences.h"
#include "editor/document/tasks.h"

namespace hairloom::editor {

class StrandPreview;

class HeadDialog : public QDialog {
    Q_OBJECT

  public:
    HeadDialog(Tasks& tasks, const Preferences& preferences, const QString& path, QWidget* parent = nullptr);

    /// As chosen; at first as guessed.
    HeadImportOptions options() const;

  private:
    void read();
    void take(ImportedScene scene);
    void fillGroups();
    void search(const QString& words);
    /// Size and picture of what the options leave.
    void refresh();
    double metresPerUnit() const;

    Tasks& tasks_;
    const Preferences& preferences_;
    QString path_;
    std::optional<ImportedScene> scene_;  ///< as read without options
    HeadGuess guess_;
    QButtonGroup* unit_;
    QButtonGroup* up_;
    QLineEdit* search_;
    QListWidget* groups_;
    QLabel* summary_;
    StrandPreview* view_;
    QPushButton* open_;
};

}  // namespace hairloom::editor
