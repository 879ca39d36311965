// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Building blocks that panels and dialogs share.

#include <QDialog>
#include <QFormLayout>
#include <QLayout>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QTreeWidget>
#include <QWidget>
#include <functional>
#include <initializer_list>

namespace hairloom::editor {

QWidget* heading(const QString& text);
/// Words that rows of `list` are looked for by: Return and Down go on to it, and end no dialog.
QLineEdit* searchBox(const char* name, const QString& words, const QString& tip, QTreeWidget& list);
/// Does `act` when it is clicked, as long as it lives.
QPushButton* pushButton(const char* name, const QString& text, const QString& tip, std::function<void()> act);
/// At the end of `layout`: Cancel, and the dialog's default button, which accepts and which the caller
/// enables once there is something to take. Returns that one.
QPushButton* acceptOrCancel(QDialog& dialog, QLayout& layout, const QString& text, const QString& tip);
/// The layout of a dialog that asks for what it exports, and the spacing of its rows, which the caller adds.
QVBoxLayout* exportLayout(QDialog& dialog, QFormLayout& rows);
/// `content` in a scroll area with the margins of a panel.
QWidget* scrolled(QWidget* content);
/// A widget with a vertical layout, margins and spacing of a panel.
QWidget* column(std::initializer_list<QWidget*> rows);
/// One below the other without margins, as a row of a column.
QWidget* stacked(std::initializer_list<QWidget*> rows);
/// Rows become as high as their words need in columns as wide as they are now, and follow when those change.
void wrapRows(QTreeWidget& table);
/// Does `act` five times a second at most, the last call in any case: for numbers that change with each
/// frame, which nobody reads faster. To be called while `owner` lives.
std::function<void()> paced(QObject& owner, std::function<void()> act);
/// A caption above the actions of `menu` that are added next. The style draws no words on separators.
void addCaption(QMenu& menu, const QString& text);
/// Folds away under its heading; `open` at first.
QWidget* collapsible(const QString& title, QWidget* content, bool open = true);

}  // namespace hairloom::editor
