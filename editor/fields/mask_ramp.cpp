// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/mask_ramp.h"

#include "core/editing/stack_commands.h"
#include "core/operations/stack.h"
#include "editor/document/words.h"

namespace hairloom::editor {

MaskRamp::MaskRamp(QtDocument& document, std::size_t index, SayError failed, QWidget* parent)
    : RampEdit(parent),
      document_(document),
      index_(index),
      op_(document.groom().operators[index].op),
      failed_(std::move(failed)) {
    setObjectName("maskRamp");
    setToolTip(
        "<p><b>Strength from root to tip</b></p><p>Drag a key to change the operator's strength there, "
        "from 0 (off) to 1 (full). Click the line to add a key. Right-click or press Delete to remove "
        "one. Arrow keys move the last key you touched.</p>");
    connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
        if (contains(parts, editing::Part::Operators)) refresh();
    });
    connect(this, &RampEdit::begun, this, [this] { interaction_ = QtDocument::nextMergeKey(); });
    connect(this, &RampEdit::edited, this, &MaskRamp::store);
    refresh();
}

const Operator* MaskRamp::shown() const {
    const auto& operators = document_.groom().operators;
    return index_ < operators.size() && operators[index_].op == op_ ? &operators[index_] : nullptr;
}

void MaskRamp::refresh() {
    if (const Operator* one = shown()) setRamp(maskOf(*one).ramp);
}

void MaskRamp::store(const runtime::Ramp& ramp) {
    const Operator* one = shown();
    if (!one) return;
    Operator changed = *one;
    Mask mask = maskOf(changed);
    mask.ramp = ramp;
    setMaskOf(changed, mask);
    const std::string name =
        QString("%1: ramp").arg(labelOf(QString::fromStdString(op_)).replace('_', ' ')).toStdString();
    document_.performMerged(interaction_,
                            [&](const editing::Model& model) -> std::unique_ptr<editing::Command> {
                                auto made = editing::setOperator(model, index_, changed, name);
                                if (made) return std::move(*made);
                                failed_(errorText(made.error()));
                                return nullptr;
                            });
}

}  // namespace hairloom::editor
