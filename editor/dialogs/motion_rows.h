// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the export of hair that moves asks: the run-up, the handles, the number of the first frame, and the
// shutter.

#include <QComboBox>
#include <QFormLayout>
#include <QSpinBox>
#include <QWidget>

#include "core/documents/hair_export.h"

namespace hairloom::editor {

class MotionRows : public QObject {
    Q_OBJECT

  public:
    explicit MotionRows(QObject* parent);
    /// The form owns the widgets.
    void addTo(QFormLayout& form);
    void show(QFormLayout& form, bool visible);
    bool isVisibleIn(const QFormLayout& form) const { return form.isRowVisible(settling_); }

    /// Of so many frames, with those of the handles.
    std::uint32_t samplesOf(int frames) const;
    /// Frames at each end.
    std::uint32_t handles() const { return static_cast<std::uint32_t>(handles_->value()); }
    std::uint32_t preRoll() const { return static_cast<std::uint32_t>(preRoll_->value()); }
    /// True where there is a shutter: the last of the frames is behind those of the file then.
    bool apply(HairToExport& wanted) const;

  Q_SIGNALS:
    void changed();

  private:
    QSpinBox *preRoll_, *start_, *handles_, *samples_;
    QComboBox* shutter_;
    QWidget *settling_, *range_, *exposure_;  ///< a row each
};

}  // namespace hairloom::editor
