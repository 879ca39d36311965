// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The bending stiffness along the strand as a curve. Its keys show the stiffness itself: angularStiffness is
// the greatest of them, angularCurve their shares of it.

#include "editor/document/qt_document.h"
#include "editor/fields/ramp_edit.h"

namespace hairloom::editor {

class StiffnessCurve : public RampEdit {
    Q_OBJECT

  public:
    explicit StiffnessCurve(QtDocument& document, QWidget* parent = nullptr);

  private:
    void refresh();
    void store(const runtime::Ramp& levels);

    QtDocument& document_;
    quint64 interaction_ = 0;  ///< one drag is one step of the history
};

}  // namespace hairloom::editor
