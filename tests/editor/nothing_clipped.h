// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What can be checked of a picture without eyes.

#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QComboBox>
#include <QDockWidget>
#include <QLabel>
#include <QLineEdit>
#include <QScrollArea>
#include <QToolButton>

namespace hairloom::editor {

/// Whether it lies in a panel that is behind another one, where nothing has been laid out yet.
inline bool isBehind(const QWidget& child, const QWidget& widget) {
    for (const QWidget* parent = &child; parent && parent != &widget; parent = parent->parentWidget()) {
        if (qobject_cast<const QDockWidget*>(parent) && parent->visibleRegion().isEmpty()) return true;
    }
    return false;
}

/// Labels that do not wrap, words on buttons and in boxes, and what scrolls have room.
inline void expectNothingClipped(QWidget& widget, const QString& name) {
    const auto expectRoom = [&](int room, int needed, const QString& what) {
        EXPECT_GE(room, needed) << name.toStdString() << ": " << what.toStdString();
    };
    const auto forAll = [&]<class Widget>(auto look) {
        for (auto* child : widget.findChildren<Widget*>()) {
            if (child->isVisibleTo(&widget) && !isBehind(*child, widget)) look(*child);
        }
    };
    forAll.operator()<QLabel>([&](const QLabel& label) {
        if (label.wordWrap() || label.text().isEmpty()) return;
        if (label.objectName() == "message") return;  // elides: the tooltip has it all
        expectRoom(label.width(), label.sizeHint().width(), label.text());
    });
    forAll.operator()<QAbstractButton>([&](const QAbstractButton& button) {
        const auto* tool = qobject_cast<const QToolButton*>(&button);
        if (button.text().isEmpty() || (tool && tool->toolButtonStyle() == Qt::ToolButtonIconOnly)) return;
        expectRoom(button.width(), button.fontMetrics().horizontalAdvance(button.text()), button.text());
    });
    forAll.operator()<QComboBox>([&](const QComboBox& box) {
        constexpr int kArrow = 20;
        expectRoom(box.width() - kArrow, box.fontMetrics().horizontalAdvance(box.currentText()),
                   box.currentText());
    });
    forAll.operator()<QLineEdit>([&](const QLineEdit& edit) {
        expectRoom(edit.width(), edit.fontMetrics().horizontalAdvance(edit.text()), edit.text());
    });
    forAll.operator()<QScrollArea>([&](const QScrollArea& area) {
        if (!area.widgetResizable()) return;
        expectRoom(area.viewport()->width(), area.widget()->width(), "what scrolls");
    });
}

}  // namespace hairloom::editor
