// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Renders what the viewport shows to a picture, a turntable or a film of the simulation.

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QElapsedTimer>
#include <QFormLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>
#include <QTimer>

#include "editor/document/messages.h"
#include "editor/document/tasks.h"
#include "editor/simulation/player.h"
#include "editor/viewport/film.h"
#include "editor/viewport/viewport.h"

namespace hairloom::editor {

class RenderDialog : public QDialog {
    Q_OBJECT

  public:
    RenderDialog(Viewport& viewport, Player& player, Tasks& tasks, Messages& messages, const QString& title,
                 QWidget* parent = nullptr);
    ~RenderDialog() override;

    /// Draws to this file with what is set; nothing remains where it is cancelled.
    void renderTo(const QString& path);
    /// While it draws, cancels that instead of closing.
    void reject() override;

  private:
    Film filmAsked() const;
    bool isWorking() const { return work_ != Work::None; }
    void showRows();
    void showWork();
    void end(const QString& words, bool isWarning);
    void choosePath();
    /// Whether files of this sequence that are there may be replaced.
    bool mayReplace(const QString& path, const Film& film);

    enum class Work { None, Runs, Cancels };

    Viewport& viewport_;
    Player& player_;
    Tasks& tasks_;
    Messages& messages_;
    const QString title_;
    QFormLayout* form_;
    QWidget* rows_;
    QComboBox* of_;
    QSpinBox *width_, *height_, *images_, *passes_;
    QComboBox *rate_, *files_;
    QCheckBox* transparent_;
    QLabel* note_;
    QProgressBar* progress_;
    QPushButton *render_, *close_;
    QTimer poll_;
    QElapsedTimer clock_;
    Work work_ = Work::None;
    QString path_;
    std::uint32_t count_ = 1;  ///< of the film that is drawn
};

}  // namespace hairloom::editor
