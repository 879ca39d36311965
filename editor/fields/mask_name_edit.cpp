// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/mask_name_edit.h"

#include <QFormLayout>

#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/groom/mask_names.h"
#include "editor/document/words.h"

namespace hairloom::editor {

QStringList maskLabels(const Groom& groom) {
    QStringList labels;
    for (std::uint32_t number = 1; number <= kPaintedMasks; ++number) {
        const QString name = QString::fromStdString(maskName(groom, number));
        const bool isNamed = number <= groom.maskNames.size() && !groom.maskNames[number - 1].empty();
        labels += isNamed ? QString("%1 (%2)").arg(name).arg(number) : name;
    }
    return labels;
}

MaskNameEdit::MaskNameEdit(QtDocument& document, std::function<std::uint32_t()> number, QWidget* parent)
    : QWidget(parent),
      document_(document),
      number_(std::move(number)),
      edit_(new QLineEdit),
      problem_(new QLabel) {
    auto* layout = new QFormLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setHorizontalSpacing(10);
    edit_->setObjectName("maskName");
    edit_->setMaxLength(static_cast<int>(kLongestMaskName));
    edit_->setToolTip(
        "Name of this painted mask, for every operator and brush that uses it. Formulas have its "
        "number: mask1 to mask4");
    problem_->setObjectName("maskNameProblem");
    problem_->setProperty("role", "problem");
    problem_->setWordWrap(true);
    problem_->hide();
    layout->addRow("Mask name", edit_);
    layout->addRow(problem_);
    connect(edit_, &QLineEdit::editingFinished, this, &MaskNameEdit::store);
    connect(edit_, &QLineEdit::returnPressed, this, [this] {
        store();
        // The keys of tools are theirs again, unless there is something to mend.
        if (problem_->isHidden()) edit_->clearFocus();
    });
    connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
        if (contains(parts, editing::Part::MaskNames | editing::Part::Operators)) refresh();
    });
    refresh();
}

void MaskNameEdit::refresh() {
    const std::uint32_t number = number_();
    setVisible(number > 0);
    // What somebody types stays, as long as it is of the mask that is shown.
    if (edit_->isModified() && edit_->hasFocus() && number == shown_) return;
    shown_ = number;
    problem_->hide();
    const auto& names = document_.groom().maskNames;
    edit_->setText(number > 0 && number <= names.size() ? QString::fromStdString(names[number - 1])
                                                        : QString());
    edit_->setPlaceholderText(QString("Mask %1").arg(number));
}

void MaskNameEdit::store() {
    if (!edit_->isModified() || shown_ == 0) return;
    auto names = maskNamesWith(document_.groom().maskNames, shown_, edit_->text().toStdString());
    auto step = names ? editing::setMaskNames(document_.editing().model(), std::move(*names))
                      : tl::unexpected(names.error());
    problem_->setVisible(!step);
    if (!step) return problem_->setText(errorText(step.error()));
    edit_->setModified(false);
    if (*step)
        document_.perform(std::move(*step));
    else
        refresh();
}

}  // namespace hairloom::editor
