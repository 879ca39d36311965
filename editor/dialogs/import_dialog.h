// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Shows the strands of a file on the head before they are taken, their roots and tips marked: in which unit,
// which axis up, how the ribbons of Cinema 4D are cut, and how a run of points is.

#include <QComboBox>
#include <QDialog>
#include <QFormLayout>
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

    /// Also stops reading, which the user has cancelled then.
    void done(int result) override;

  private:
    /// What was read, on its way from the task.
    struct Preview {
        Groom groom;
        QString text;
        bool hasRibbons = false, hasRuns = false;
    };
    void read();
    void showPreview(Preview preview);

    QtDocument& document_;
    Tasks& tasks_;
    QString path_;
    QComboBox* unit_;
    QComboBox* up_;
    QSpinBox* segments_;
    QComboBox* order_;
    QComboBox* particle_;
    QSpinBox* points_;
    QFormLayout* form_;
    QLabel* summary_;
    StrandPreview* view_;
    QPushButton* take_;
    bool reading_ = false;
    Groom preview_;
};

}  // namespace hairloom::editor
