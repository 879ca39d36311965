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
#include "editor/document/qt_document.h"
#include "editor/document/tasks.h"
#include "editor/simulation/player.h"
#include "editor/viewport/film.h"
#include "editor/viewport/viewport.h"

namespace hairloom::editor {

class RenderDialog : public QDialog {
    Q_OBJECT

  public:
    RenderDialog(Viewport& viewport, Player& player, Tasks& tasks, Messages& messages,
                 const QtDocument& document, QWidget* parent = nullptr);
    ~RenderDialog() override;

    /// Draws to this file with what is set; nothing remains where it is cancelled.
    void renderTo(const QString& path);
    /// While it draws, cancels that instead of closing.
    void reject() override;

  private:
    Film filmAsked() const;
    /// What *Burn in* says of all images.
    std::vector<std::string> linesAsked(const Film& film, const Groom& groom) const;
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
    const QtDocument& document_;
    QFormLayout* form_;
    QWidget* rows_;
    QComboBox* of_;
    QSpinBox *width_, *height_, *images_, *passes_;
    QComboBox *rate_, *files_;
    QCheckBox *transparent_, *frame_, *take_, *settings_, *manifest_;
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
