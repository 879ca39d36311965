// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Asks for a take that is made of another: one that loops, or one that is simulated anew from a frame on.

#include <QDialog>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <functional>

#include "core/documents/take_edit.h"
#include "editor/document/qt_document.h"

namespace hairloom::editor {

/// The rows that both have: a name and words on what is made, and the button that makes it.
class NewTakeDialog : public QDialog {
    Q_OBJECT

  public:
    QString name() const { return name_->text(); }

  protected:
    NewTakeDialog(const QString& title, const QString& name, QWidget* parent);

    /// A row of one number of frames.
    QSpinBox* addFrames(const char* objectName, const QString& label, const QString& tip, int least, int most,
                        int value);
    /// At the end, once all rows are there. `words` says what is made. An error, why nothing can be.
    void finishRows(const QString& button, const QString& tip, std::function<Result<QString>()> words);

  private:
    void showWords();

    QFormLayout* form_;
    QLineEdit* name_;
    QLabel* words_;
    QPushButton* make_ = nullptr;
    std::function<Result<QString>()> wordsOf_;
};

/// First and last frame of a take that repeat, and the frames of the blend.
class LoopDialog : public NewTakeDialog {
    Q_OBJECT

  public:
    LoopDialog(const QString& name, const TakeInfo& info, const Groom& groom, QWidget* parent = nullptr);
    LoopToMake wanted() const;

  private:
    QSpinBox *first_, *last_, *blend_;
};

/// The frame of a take that is kept last, and how many to simulate.
class ResimulateDialog : public NewTakeDialog {
    Q_OBJECT

  public:
    ResimulateDialog(const QString& name, const TakeInfo& info, std::uint64_t shown,
                     QWidget* parent = nullptr);
    TakeToResume wanted() const;

  private:
    QSpinBox *at_, *frames_;
};

}  // namespace hairloom::editor
