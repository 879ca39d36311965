// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What wheel, keys and screen readers may expect of every control of the window, however it was made.

#include <QObject>
#include <QWidget>

namespace hairloom::editor {

/// While it lives, for all of the application:
/// - the wheel over a number, a slider or a choice that has no focus scrolls what it lies in, and gives no
///   focus;
/// - Space and Return press the button that has the focus, in dialogs, too, whatever their default button is;
///   Space, Delete, Home and End are a list's own, rather than shortcuts of the window;
/// - a control that can have the focus, and a bar of progress, has a name for screen readers: that of its
///   label, else what its tooltip begins with.
class InputRules : public QObject {
    Q_OBJECT

  public:
    explicit InputRules(QObject* parent);

  protected:
    bool eventFilter(QObject* object, QEvent* event) override;
};

/// The name that screen readers are told: its own, that of its label or of the control that it is part of,
/// else the first words of its tooltip.
QString spokenName(const QWidget& control);

}  // namespace hairloom::editor
