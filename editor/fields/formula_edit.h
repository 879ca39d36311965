// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The formula of an operator's mask.

#include <QLabel>
#include <QLineEdit>
#include <QWidget>
#include <string>

#include "editor/document/qt_document.h"

namespace hairloom::editor {

class FormulaEdit : public QWidget {
    Q_OBJECT

  public:
    /// Of the operator at `index`, as long as that is the same operation.
    FormulaEdit(QtDocument& document, std::size_t index, QWidget* parent = nullptr);

  private:
    const Operator* shown() const;
    void refresh();
    /// Gives the operator what is typed; where that does not work it says why, and the last that did stays.
    void store();

    QtDocument& document_;
    std::size_t index_;
    std::string op_;
    QLineEdit* edit_;
    QLabel* problem_;
};

}  // namespace hairloom::editor
