// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an empty window shows: what to do first, the samples, recent files, and work that a crash left.

#include <QVBoxLayout>
#include <QWidget>

#include "core/base/output_file.h"
#include "core/documents/recovery.h"
#include "editor/document/preferences.h"
#include "editor/shell/files.h"

namespace hairloom::editor {

class StartPage : public QWidget {
    Q_OBJECT

  public:
    StartPage(DocumentFiles& files, const Preferences& preferences, QWidget* parent = nullptr);

  Q_SIGNALS:
    void openRequested();

  protected:
    void showEvent(QShowEvent* event) override;

  private:
    void fillRecent();
    void fillRecoveries();
    /// Files that killed runs left beside recent ones and recovery copies.
    void fillLeftOvers();
    void addLeftOver(const LeftOver& leftOver);

    DocumentFiles& files_;
    const Preferences& preferences_;
    QVBoxLayout* recent_;
    QVBoxLayout* recoveries_;
};

}  // namespace hairloom::editor
