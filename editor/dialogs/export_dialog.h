// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Writes the hair for another program and says what came back when the file was read again.

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTreeWidget>

#include "editor/dialogs/motion_rows.h"
#include "editor/document/messages.h"
#include "editor/document/preferences.h"
#include "editor/document/qt_document.h"
#include "editor/document/tasks.h"
#include "editor/simulation/player.h"
#include "exporters/report.h"
#include "exporters/strands.h"

namespace hairloom::editor {

class ExportDialog : public QDialog {
    Q_OBJECT

  public:
    ExportDialog(QtDocument& document, const Preferences& preferences, Tasks& tasks, Messages& messages,
                 const Player& player, QWidget* parent = nullptr);

    /// Writes to this file with the options that are set; the report follows when it is done.
    void exportTo(const QString& path);
    /// What exec() gives where fewer guides are wanted first.
    static constexpr int kWantsClustering = 2;
    /// Of the last export; format is empty before it, and where something else would be written now.
    const ExportReport& report() const { return report_; }

  private:
    void takeProgram(int index);
    void takeTarget();
    bool canWrite() const;
    /// Names of those that are chosen; none for all.
    std::vector<std::string> layersToWrite() const;
    StrandExportOptions optionsAsked() const;
    void showWhatWillBeWritten();
    void showReport();
    QString summary() const;
    void choosePath();

    QtDocument& document_;
    const Preferences& preferences_;
    Tasks& tasks_;
    Messages& messages_;
    const Player& player_;
    QFormLayout* form_;
    QComboBox* target_;  ///< the program
    QComboBox* format_;  ///< of those that the program reads
    QComboBox* what_;
    QComboBox* layers_;
    QSpinBox* frames_;
    MotionRows* motion_;
    QLabel* note_;
    QLabel* problem_;  ///< why the target cannot work here
    QLabel* many_;     ///< more guides than a game moves
    QPushButton* cluster_;
    QComboBox* unit_;
    QComboBox* up_;
    QSpinBox* points_;
    QSpinBox *cards_, *textures_;
    QCheckBox *certify_, *physics_, *manifest_;
    QPushButton* write_;
    QLabel* summary_;
    QTreeWidget* findings_;
    ExportReport report_;
};

}  // namespace hairloom::editor
