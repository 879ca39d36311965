// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A slider and a spin box for one number. Tells when a drag begins, so that one drag is one undo.

#include <QSlider>
#include <QWidget>

#include "editor/fields/number_spin.h"

namespace hairloom::editor {

class NumberBox : public QWidget {
    Q_OBJECT

  public:
    /// `whole` allows no fractions. The slider is logarithmic where the range spans more than a thousandfold.
    NumberBox(double min, double max, bool whole, QWidget* parent = nullptr);

    /// In the unit of the value; shown times `factor`.
    void setShown(double factor, const QString& unit, int decimals);
    double value() const { return value_; }
    /// Without telling anyone.
    void setValue(double value);
    QDoubleSpinBox& spinBox() { return *spin_; }
    QSlider& slider() { return *slider_; }

  Q_SIGNALS:
    /// Someone begins to change the value, by slider, keys or typing.
    void begun();
    void edited(double value);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    double fromSlider(int position) const;
    int toSlider(double value) const;
    void showValue();

    double min_, max_;
    bool whole_;
    double factor_ = 1;
    double value_ = 0;
    QSlider* slider_;
    NumberSpin* spin_;
};

}  // namespace hairloom::editor
