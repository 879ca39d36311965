// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the export of hair that moves asks: frame rate, run-up, handles, the number of the first frame, and
// the shutter.

#include <QComboBox>
#include <QFormLayout>
#include <QSpinBox>
#include <QWidget>

#include "core/documents/hair_export.h"
#include "core/simulation/time_line_motion.h"
#include "editor/fields/number_spin.h"

namespace hairloom::editor {

class MotionRows : public QObject {
    Q_OBJECT

  public:
    /// Rate and run-up are at first those of the motion that plays.
    MotionRows(const FramePace& pace, QObject* parent);
    /// The form owns the widgets.
    void addTo(QFormLayout& form);
    void show(QFormLayout& form, bool visible);
    bool isVisibleIn(const QFormLayout& form) const { return form.isRowVisible(settling_); }

    /// Of so many frames, with those of the handles.
    std::uint32_t samplesOf(int frames) const;
    /// Frames at each end.
    std::uint32_t handles() const { return static_cast<std::uint32_t>(handles_->value()); }
    float framesPerSecond() const { return static_cast<float>(rate_->value()); }
    std::uint32_t preRoll() const { return static_cast<std::uint32_t>(preRoll_->value()); }
    /// True where there is a shutter: the last of the frames is behind those of the file then.
    bool apply(HairToExport& wanted) const;

  Q_SIGNALS:
    void changed();

  private:
    NumberSpin* rate_;
    QSpinBox *preRoll_, *start_, *handles_, *samples_;
    QComboBox* shutter_;
    QWidget *settling_, *range_, *exposure_;  ///< a row each
};

}  // namespace hairloom::editor
