// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How strongly an operator acts from root to tip: the ramp of its mask.

#include "editor/document/qt_document.h"
#include "editor/fields/field.h"
#include "editor/fields/ramp_edit.h"

namespace hairloom::editor {

class MaskRamp : public RampEdit {
    Q_OBJECT

  public:
    MaskRamp(QtDocument& document, std::size_t index, SayError failed, QWidget* parent = nullptr);

  private:
    /// Null where the stack has changed under it.
    const Operator* shown() const;
    void refresh();
    void store(const runtime::Ramp& ramp);

    QtDocument& document_;
    std::size_t index_;
    std::string op_;
    SayError failed_;
    quint64 interaction_ = 0;  ///< one drag is one step of the history
};

}  // namespace hairloom::editor
