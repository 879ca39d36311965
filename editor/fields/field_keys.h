// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a form shows of settings that are keyed over time.

#include <QObject>
#include <QString>
#include <QWidget>
#include <initializer_list>

namespace hairloom::editor {

class FieldKeys : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;

    /// A right-click on these, or on what is in them, or the menu key, offers to key the setting "windSpeed".
    /// Nothing where it cannot be keyed.
    virtual void offer(const char* setting, std::initializer_list<QWidget*> places) = 0;
    /// Before the name of a setting: a diamond where it is keyed, filled where a key is at the play head.
    virtual QString mark(const char* setting) const = 0;
    /// What its keys say at the play head, for a tooltip; empty where it is not keyed.
    virtual QString tip(const char* setting) const = 0;

  Q_SIGNALS:
    /// Marks and tips are others.
    void changed();
};

}  // namespace hairloom::editor
