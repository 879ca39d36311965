// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Exports a take: as hair that moves for other programs, as a clip for games, or as a record of frames.

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <filesystem>
#include <string>
#include <vector>

#include "core/documents/take_export.h"
#include "editor/document/messages.h"
#include "editor/document/qt_document.h"
#include "editor/document/tasks.h"
#include "editor/fields/save_file.h"

namespace hairloom::editor {

class TakeExportDialog : public QDialog {
    Q_OBJECT

  public:
    /// `info` is of the take's file and has frames.
    TakeExportDialog(const QString& name, std::filesystem::path take, const TakeInfo& info,
                     const QtDocument& document, Tasks& tasks, Messages& messages, QWidget* parent = nullptr);

    /// Writes to this file with what is set, in the background, and closes.
    void exportTo(const QString& path);

  private:
    void choosePath();
    void showRows();
    TakeToExport wanted() const;
    /// Whether follow hairs are there and may be written.
    bool canChooseHair(const std::string& format) const;

    QString name_;
    std::filesystem::path take_;
    TakeInfo info_;
    const QtDocument& document_;
    Tasks& tasks_;
    Messages& messages_;
    std::vector<std::string> formats_ = takeExportFormats();
    std::vector<SaveFormat> files_;  ///< of each format
    QFormLayout* form_;
    QComboBox *format_, *what_;
    QSpinBox *first_, *last_;
    QCheckBox* loops_;
    QLabel *note_, *summary_;
    QPushButton* export_;
};

}  // namespace hairloom::editor
