// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/formula_edit.h"

#include <QVBoxLayout>

#include "core/editing/document.h"
#include "core/editing/stack_commands.h"
#include "core/operations/formula.h"
#include "core/operations/stack.h"
#include "editor/document/words.h"

namespace hairloom::editor {

FormulaEdit::FormulaEdit(QtDocument& document, std::size_t index, QWidget* parent)
    : QWidget(parent),
      document_(document),
      index_(index),
      op_(document.groom().operators[index].op),
      edit_(new QLineEdit),
      problem_(new QLabel) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    edit_->setObjectName("maskFormula");
    edit_->setMaxLength(static_cast<int>(Formula::kMostCharacters));
    edit_->setPlaceholderText(tr("Formula, as 0.5 + 0.5*noise(u*20, v*20)"));
    edit_->setAccessibleName(tr("Formula of the mask"));
    edit_->setToolTip(tr(
        "<p><b>Formula</b></p><p>Multiplies the mask; 0 to 1, empty is 1. Names: u, v (UV of the root), t (0 "
        "root, 1 "
        "tip), length (m), random (of the strand), x, y, z (of the root, m), density, dye, mask1 to mask4, "
        "pi. "
        "+ - * / % ^, comparisons, abs, floor, fract, sqrt, sin, cos, min, max, pow, clamp, mix, smoothstep, "
        "noise, if(a, b, c).</p>"));
    problem_->setObjectName("maskFormulaProblem");
    problem_->setWordWrap(true);
    problem_->setProperty("role", "problem");
    problem_->hide();
    layout->addWidget(edit_);
    layout->addWidget(problem_);
    connect(edit_, &QLineEdit::editingFinished, this, &FormulaEdit::store);
    connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
        if (contains(parts, editing::Part::Operators)) refresh();
    });
    refresh();
}

const Operator* FormulaEdit::shown() const {
    const auto& operators = document_.groom().operators;
    return index_ < operators.size() && operators[index_].op == op_ ? &operators[index_] : nullptr;
}

void FormulaEdit::refresh() {
    const Operator* one = shown();
    if (!one || edit_->hasFocus()) return;
    edit_->setText(QString::fromStdString(maskOf(*one).formula));
    problem_->hide();
}

void FormulaEdit::store() {
    const Operator* one = shown();
    if (!one) return;
    Mask mask = maskOf(*one);
    const std::string typed = edit_->text().trimmed().toStdString();
    problem_->hide();
    if (typed == mask.formula) return;
    const auto say = [this](const Error& error) {
        problem_->setText(errorText(error));
        problem_->show();
    };
    if (const auto read = Formula::read(typed); !typed.empty() && !read) return say(read.error());
    mask.formula = typed;
    Operator changed = *one;
    setMaskOf(changed, mask);
    auto made =
        editing::setOperator(document_.editing().model(), index_, changed,
                             tr("%1: formula").arg(labelOf(QString::fromStdString(op_))).toStdString());
    if (!made) return say(made.error());
    document_.perform(std::move(*made));
}

}  // namespace hairloom::editor
