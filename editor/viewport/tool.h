// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the pointer does in the viewport. Tools
// change the document through its commands only.

#include <QKeySequence>
#include <QObject>
#include <QPointF>
#include <QString>

#include "editor/viewport/marks.h"

namespace hairloom::editor {

struct Pointer {
    QPointF at_px;
    Qt::MouseButton button = Qt::NoButton;  ///< that was pressed or released; none while moving
    Qt::KeyboardModifiers modifiers;
    double pressure = 1;  ///< 0 … 1, after the curve of the preferences; 1 for a mouse
};

struct ToolInfo {
    QString id;    ///< "comb"
    QString name;  ///< "Comb"
    QString icon;
    QString tip;  ///< one sentence: what dragging does
    QKeySequence shortcut;
    int order = 300;  ///< in the tool bar, with those of brushes (editing::BrushInfo)
};

class Tool : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;
    virtual const ToolInfo& info() const = 0;
    /// One line for the status bar while the tool is active.
    virtual QString hint() const { return info().tip; }

    virtual void activate() {}
    virtual void deactivate() { cancel(); }
    virtual void hover(const Pointer&) {}
    virtual void press(const Pointer&) {}
    virtual void drag(const Pointer&) {}
    virtual void release(const Pointer&) {}
    /// The pointer has left the view.
    virtual void leave() {}
    /// Puts back what the stroke under way has done.
    virtual void cancel() {}
    /// False for keys that mean nothing to the tool.
    virtual bool key(int, Qt::KeyboardModifiers) { return false; }
    virtual void draw(Marks&) const {}
    /// Its settings, for the tool panel; may be null. The caller owns it.
    virtual QWidget* makeOptions() { return nullptr; }

  Q_SIGNALS:
    /// draw() or hint() would differ now.
    void updated();
};

}  // namespace hairloom::editor
