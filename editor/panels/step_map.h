// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which steps each integrator of this hair can take: a row each, from stable to failing, with the document's
// setting as a dot.

#include <QWidget>
#include <vector>

#include "core/stability/stable_steps.h"
#include "editor/document/preferences.h"

namespace hairloom::editor {

class StepMap : public QWidget {
    Q_OBJECT

  public:
    explicit StepMap(const Preferences& preferences, QWidget* parent = nullptr);
    void setGroom(const Groom& groom);
    /// "rods fails at no step, verlet fails beyond a substep of 3.1 ms, …; now rods at 8.3 ms".
    QString words() const;

    QSize sizeHint() const override;
    QSize minimumSizeHint() const override { return {180, sizeHint().height()}; }

  protected:
    void paintEvent(QPaintEvent*) override;
    bool event(QEvent* event) override;

  private:
    int rowHeight() const;

    const Preferences& preferences_;
    std::vector<StableStep> rows_;
    double step_ = 0;  ///< of the document, seconds
};

}  // namespace hairloom::editor
