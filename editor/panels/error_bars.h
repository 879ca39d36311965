// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the error of a setting is made of, as four bars that never become one number.

#include <QWidget>
#include <array>

#include "core/accuracy/work_precision.h"
#include "editor/document/preferences.h"

namespace hairloom::editor {

class ErrorBars : public QWidget {
    Q_OBJECT

  public:
    explicit ErrorBars(const Preferences& preferences, QWidget* parent = nullptr);

    /// `doubtMm` is the reference's own. Shown in pixels.
    void setParts(const ErrorParts& parts, double doubtMm, double pixelsPerMm);
    /// "Steps 0.2 px, points 1.1 px, model 0 px, the reference's own doubt 0.01 px".
    QString words() const;

    QSize sizeHint() const override;
    QSize minimumSizeHint() const override { return {180, sizeHint().height()}; }

  protected:
    void paintEvent(QPaintEvent*) override;
    bool event(QEvent* event) override;

  private:
    static constexpr int kBars = 4;
    struct Bar {
        QString name, meaning;
        double px = 0, mm = 0;
    };
    int rowHeight() const;

    const Preferences& preferences_;
    std::array<Bar, kBars> bars_;
};

}  // namespace hairloom::editor
