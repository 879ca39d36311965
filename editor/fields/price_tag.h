// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a setting costs, beside it: a column for each value that was measured, time above the line and error
// below it, that of now lit, and its numbers. Not to be seen while nothing is measured.

#include <QWidget>

#include "editor/document/preferences.h"
#include "editor/document/prices.h"

namespace hairloom::editor {

class PriceTag : public QWidget {
    Q_OBJECT

  public:
    PriceTag(const Prices& prices, const Preferences& preferences, const QString& setting,
             QWidget* parent = nullptr);
    /// "1.2 ms, 0.3 px. 8 adds 0.8 ms and takes 0.1 px off."
    QString words() const;

  protected:
    void paintEvent(QPaintEvent*) override;
    QSize sizeHint() const override { return {160, 22}; }
    QSize minimumSizeHint() const override { return {120, 22}; }

  private:
    void refresh();

    const Prices& prices_;
    const Preferences& preferences_;
    QString setting_;
};

}  // namespace hairloom::editor
