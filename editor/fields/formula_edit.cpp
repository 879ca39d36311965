// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/formula_edit.h"

#include <QVBoxLayout>

#include "core/editing/document.h"
#include "core/editing/stack_commands.h"
#include "core/operations/formula.h"
#include "core/operations/stack.h"
#include "editor/document/words.h"

namespace hairloom::editor {

FormulaEdit::FormulaEdit(QtDocument& document, std::size_t index, const QString& field, QWidget* parent)
    : QWidget(parent),
      document_(document),
      index_(index),
      op_(document.groom().operators[index].op),
      field_(field.toStdString()),
      edit_(new QLineEdit),
      problem_(new QLabel) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    const QString name = (field.isEmpty() ? QStringLiteral("mask") : field) + "Formula";
    edit_->setObjectName(name);
    edit_->setMaxLength(static_cast<int>(Formula::kMostCharacters));
    edit_->setPlaceholderText(field.isEmpty() ? QString("Formula, as 0.5 + 0.5*noise(u*20, v*20)")
                                              : QString("Formula, as 0.02*random + 0.1*length"));
    edit_->setAccessibleName(field.isEmpty() ? QString("Formula of the mask")
                                             : QString("Formula of %1").arg(labelOf(field)));
    const QString names = QString(
        "u, v (UV of the root), length (m), random (of the strand), x, y, z (of the root, m), density, "
        "dye, mask1 to mask4, pi. + - * / % ^, comparisons, abs, floor, fract, sqrt, sin, cos, min, max, "
        "pow, clamp, mix, smoothstep, noise, if(a, b, c).");
    edit_->setToolTip(
        field.isEmpty()
            ? QString("<p><b>Formula</b></p><p>Multiplies the mask; 0 to 1, empty is 1. Names: t (0 root, 1 "
                      "tip), "
                      "%1</p>")
                  .arg(names)
            : QString("<p><b>Formula</b></p><p>Replaces the number, one value for each strand; lengths in "
                      "metres. Names: %1</p>")
                  .arg(names));
    problem_->setObjectName(name + "Problem");
    problem_->setWordWrap(true);
    problem_->setProperty("role", "problem");
    problem_->hide();
    layout->addWidget(edit_);
    layout->addWidget(problem_);
    connect(edit_, &QLineEdit::editingFinished, this, &FormulaEdit::store);
    connect(edit_, &QLineEdit::returnPressed, this, [this] {
        store();
        // The keys of tools are theirs again, unless there is something to mend.
        if (problem_->isHidden()) edit_->clearFocus();
    });
    connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
        if (contains(parts, editing::Part::Operators)) refresh();
    });
    refresh();
}

const Operator* FormulaEdit::shown() const {
    const auto& operators = document_.groom().operators;
    return index_ < operators.size() && operators[index_].op == op_ ? &operators[index_] : nullptr;
}

std::string FormulaEdit::kept() const {
    const Operator* one = shown();
    if (!one) return {};
    return field_.empty() ? maskOf(*one).formula : formulaOf(*one, field_);
}

void FormulaEdit::refresh() {
    if (!shown() || edit_->hasFocus()) return;
    edit_->setText(QString::fromStdString(kept()));
    problem_->hide();
}

void FormulaEdit::clear() {
    edit_->clear();
    store();
}

Status FormulaEdit::put(Operator& one, const std::string& formula) const {
    if (!field_.empty()) return setFormulaOf(one, field_, formula);
    if (const auto read = Formula::read(formula); !formula.empty() && !read)
        return tl::unexpected(read.error());
    Mask mask = maskOf(one);
    mask.formula = formula;
    setMaskOf(one, mask);
    return {};
}

void FormulaEdit::say(const Error& error) {
    problem_->setText(errorText(error));
    problem_->show();
}

void FormulaEdit::store() {
    const Operator* one = shown();
    if (!one) return;
    const std::string typed = edit_->text().trimmed().toStdString();
    problem_->hide();
    if (typed == kept()) return;
    Operator changed = *one;
    if (const Status status = put(changed, typed); !status) return say(status.error());
    const QString of =
        field_.empty() ? QString("formula") : QString("formula of %1").arg(QString::fromStdString(field_));
    auto made = editing::setOperator(
        document_.editing().model(), index_, changed,
        QStringLiteral("%1: %2").arg(labelOf(QString::fromStdString(op_)), of).toStdString());
    if (!made) return say(made.error());
    document_.perform(std::move(*made));
}

}  // namespace hairloom::editor
