// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far the settings are from where the simulation would explode, with what would help a click away.

#include <QLabel>
#include <QProgressBar>
#include <QTimer>
#include <QVBoxLayout>
#include <QWidget>

#include "hairloom/stable.h"

namespace hairloom::editor {

class Session;

class StabilityGauge : public QWidget {
    Q_OBJECT

  public:
    explicit StabilityGauge(Session& session, QWidget* parent = nullptr);
    const runtime::StableAdvice& advice() const { return advice_; }

  protected:
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;

  private:
    /// Looks at the settings anew soon, or when the panel is shown.
    void outdate();
    void update();

    Session& session_;
    QProgressBar* bar_;
    QLabel* words_;
    QVBoxLayout* offers_;
    QTimer soon_;
    bool isOutdated_ = false;
    runtime::StableAdvice advice_;
};

}  // namespace hairloom::editor
