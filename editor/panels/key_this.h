// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Key this: the menu of a setting of hair or look that can be keyed on the time line, and its mark.

#include <functional>

#include "editor/fields/field_keys.h"
#include "editor/simulation/keying.h"

namespace hairloom::editor {

class KeyThis : public FieldKeys {
    Q_OBJECT

  public:
    /// `section` of the settings: "simulation" or "material".
    KeyThis(Keying& keying, const char* section, QObject* parent = nullptr);
    /// `nameOf`: what a setting is called on the time line; empty where it cannot be keyed.
    KeyThis(Keying& keying, std::function<std::string(const char* setting)> nameOf,
            QObject* parent = nullptr);

    void offer(const char* setting, std::initializer_list<QWidget*> places) override;
    QString mark(const char* setting) const override;
    QString tip(const char* setting) const override;

  private:
    KeyTrack trackOf(const char* setting) const;

    Keying& keying_;
    std::function<std::string(const char*)> nameOf_;
};

}  // namespace hairloom::editor
