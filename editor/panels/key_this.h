// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Key this: the menu of a setting of the simulation that can be keyed on the time line, and its mark.

#include "editor/fields/field_keys.h"
#include "editor/simulation/keying.h"

namespace hairloom::editor {

class KeyThis : public FieldKeys {
    Q_OBJECT

  public:
    explicit KeyThis(Keying& keying, QObject* parent = nullptr);

    void offer(const char* setting, std::initializer_list<QWidget*> places) override;
    QString mark(const char* setting) const override;
    QString tip(const char* setting) const override;

  private:
    Keying& keying_;
};

}  // namespace hairloom::editor
