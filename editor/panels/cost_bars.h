// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Milliseconds in the cells of a table, each with a bar behind it and the frame's budget as a line through
// all of them.

#include <QStyledItemDelegate>

#include "editor/document/preferences.h"

namespace hairloom::editor {

class CostBars : public QStyledItemDelegate {
    Q_OBJECT

  public:
    /// Of an item, the milliseconds that its bar stands for; without it there is no bar.
    static constexpr int kMilliseconds = Qt::UserRole + 1;

    CostBars(const Preferences& preferences, QObject* parent)
        : QStyledItemDelegate(parent), preferences_(preferences) {}
    /// Both in milliseconds: where the line is, and the longest bar.
    void setScale(double budget, double longest);
    /// Share 0 … 1 of the cell's width.
    double shareOf(double milliseconds) const;

    void paint(QPainter* painter, const QStyleOptionViewItem& option,
               const QModelIndex& index) const override;

  private:
    const Preferences& preferences_;
    double budget_ = 0, whole_ = 1;
};

}  // namespace hairloom::editor
