// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A dockable panel. Each is a file of its own with one function that makes it; panels/registry.cpp lists
// them.

#include <QString>
#include <QTreeWidget>
#include <QWidget>
#include <functional>
#include <vector>

namespace hairloom::editor {

class Session;

struct PanelInfo {
    QString id;  ///< layouts are saved under it
    QString title;
    QString icon;
    Qt::DockWidgetArea area = Qt::RightDockWidgetArea;
    bool open = true;  ///< in the first layout
    std::function<QWidget*(Session&)> make;
};

/// In the order in which they stand in their areas.
const std::vector<PanelInfo>& panels();

// Building blocks that panels share.
QWidget* heading(const QString& text);
/// `content` in a scroll area with the margins of a panel.
QWidget* scrolled(QWidget* content);
/// A widget with a vertical layout, margins and spacing of a panel.
QWidget* column(std::initializer_list<QWidget*> rows);
/// Rows become as high as their words need in columns as wide as they are now, and follow when those change.
void wrapRows(QTreeWidget& table);
/// Folds away under its heading; `open` at first.
QWidget* collapsible(const QString& title, QWidget* content, bool open = true);

}  // namespace hairloom::editor
