// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The formula of an operator's mask or of one of its settings.

#include <QLabel>
#include <QLineEdit>
#include <QWidget>
#include <string>

#include "editor/document/qt_document.h"

namespace hairloom::editor {

class FormulaEdit : public QWidget {
    Q_OBJECT

  public:
    /// Of the operator at `index`, as long as that is the same operation: of the setting of this name, or of
    /// the mask where it is empty. Objects are named after it: "amplitudeFormula", "maskFormula".
    FormulaEdit(QtDocument& document, std::size_t index, const QString& field = {},
                QWidget* parent = nullptr);

    bool isSet() const { return !kept().empty(); }
    /// Takes the formula away, as one step.
    void clear();
    void begin() { edit_->setFocus(); }

  private:
    const Operator* shown() const;
    std::string kept() const;
    void refresh();
    /// Gives the operator what is typed; where that does not work it says why, and the last that did stays.
    void store();
    Status put(Operator& one, const std::string& formula) const;
    void say(const Error& error);

    QtDocument& document_;
    std::size_t index_;
    std::string op_;
    std::string field_;
    QLineEdit* edit_;
    QLabel* problem_;
};

}  // namespace hairloom::editor
