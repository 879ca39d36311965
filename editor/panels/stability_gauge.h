// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far the settings are from where the simulation would explode, each integrator's failing step, and what
// would help a click away.

#include <QLabel>
#include <QProgressBar>
#include <QTimer>
#include <QVBoxLayout>
#include <QWidget>

#include "editor/document/preferences.h"
#include "editor/document/qt_document.h"
#include "editor/panels/step_map.h"
#include "hairloom/stable.h"

namespace hairloom::editor {

class StabilityGauge : public QWidget {
    Q_OBJECT

  public:
    StabilityGauge(QtDocument& document, const Preferences& preferences, QWidget* parent = nullptr);
    const runtime::StableAdvice& advice() const { return advice_; }

  protected:
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;

  private:
    /// Looks at the settings anew soon, or when the panel is shown.
    void outdate();
    void update();

    QtDocument& document_;
    const Preferences& preferences_;
    QProgressBar* bar_;
    StepMap* map_;
    QLabel* words_;
    QVBoxLayout* offers_;
    QTimer soon_;
    bool isOutdated_ = false;
    runtime::StableAdvice advice_;
};

}  // namespace hairloom::editor
