// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far the settings are from where the simulation would explode, with what would help a click away.

#include <QLabel>
#include <QProgressBar>
#include <QTimer>
#include <QVBoxLayout>
#include <QWidget>

#include "runtime/stable.h"

namespace hairloom::editor {

class Session;

class StabilityGauge : public QWidget {
    Q_OBJECT

  public:
    explicit StabilityGauge(Session& session, QWidget* parent = nullptr);
    const runtime::StableAdvice& advice() const { return advice_; }

  private:
    void update();

    Session& session_;
    QProgressBar* bar_;
    QLabel* words_;
    QVBoxLayout* offers_;
    QTimer soon_;
    runtime::StableAdvice advice_;
};

}  // namespace hairloom::editor
