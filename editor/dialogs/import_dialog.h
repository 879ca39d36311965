// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Shows the strands of a file on the head before they are taken: in which unit, which axis up, and how the
// ribbons of Cinema 4D are cut.

#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>

#include "editor/document/qt_document.h"
#include "editor/document/tasks.h"
#include "importers/strands.h"

namespace hairloom::editor {

class StrandPreview;

class ImportDialog : public QDialog {
    Q_OBJECT

  public:
    ImportDialog(QtDocument& document, Tasks& tasks, const QString& path, QWidget* parent = nullptr);

    StrandImportOptions options() const;
    /// What the file holds with these options; empty before it was read or where it cannot be.
    const Groom& preview() const { return preview_; }

  private:
    void read();

    QtDocument& document_;
    Tasks& tasks_;
    QString path_;
    QComboBox* unit_;
    QComboBox* up_;
    QSpinBox* segments_;
    QLabel* summary_;
    StrandPreview* view_;
    QPushButton* take_;
    Groom preview_;
};

}  // namespace hairloom::editor
