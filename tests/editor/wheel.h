// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A mouse's wheel.

#include <QtTest/qtestspontaneevent.h>
#include <QApplication>
#include <QWheelEvent>
#include <QWidget>

namespace hairloom::editor {

/// Notches of a wheel over the middle of a control, as the window system tells of them.
inline void turnWheel(QWidget& over, int notches) {
    const QPointF at(over.rect().center());
    QWheelEvent event(at, over.mapToGlobal(at), {}, {0, -120 * notches}, Qt::NoButton, Qt::NoModifier,
                      Qt::NoScrollPhase, false);
    // As from a mouse: what a program sends goes no further than where it is sent.
    QSpontaneKeyEvent::setSpontaneous(&event);
    qApp->notify(&over, &event);
}

}  // namespace hairloom::editor
