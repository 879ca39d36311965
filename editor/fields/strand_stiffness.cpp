// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/strand_stiffness.h"

#include <QFormLayout>
#include <QHBoxLayout>

#include "core/editing/document.h"
#include "core/editing/selection_commands.h"
#include "editor/document/words.h"
#include "editor/fields/image_button.h"
#include "editor/fields/mask_name_edit.h"
#include "hairloom/strands.h"

namespace hairloom::editor {

StrandStiffness::StrandStiffness(QtDocument& document, Messages& messages, QWidget* parent)
    : QWidget(parent),
      document_(document),
      messages_(messages),
      black_(factor("stiffnessBlack", "Times the stiffness above where the mask is black. 0 is limp", 1)),
      white_(factor("stiffnessWhite",
                    "Times the stiffness above where the mask is white. Gelled hair has 4 or more", 4)),
      mask_(new QComboBox),
      even_(new QPushButton("Even stiffness")) {
    auto* layout = new QFormLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addRow("Black", black_);
    layout->addRow("White", white_);
    mask_->setObjectName("stiffnessMask");
    mask_->setToolTip("Painted mask of the strands. The brush Paint mask paints it");
    auto* take = new QPushButton("Take mask");
    take->setObjectName("stiffnessFromMask");
    take->setToolTip("Gives each strand its stiffness by the mask. Take it again after you paint");
    connect(take, &QPushButton::clicked, this, &StrandStiffness::takeMask);
    auto* row = new QHBoxLayout;
    row->addWidget(mask_, 1);
    row->addWidget(take);
    layout->addRow("Mask", row);
    layout->addRow(imageButton(
        "stiffnessImage", "Stiffness from image…",
        "Gives each strand its stiffness by a PNG at the root UVs, in place of a mask",
        [this](const MaskImage& image) -> Status {
            const auto shares = valuesAtRoots(image, document_.groom());
            if (!shares) return tl::unexpected(shares.error());
            setShares(*shares);
            return {};
        },
        [this](const QString& problem) { messages_.warn(problem); }));
    even_->setObjectName("evenStiffness");
    even_->setToolTip("Removes the strands' own stiffness, so that all have that above");
    connect(even_, &QPushButton::clicked, this,
            [this] { document_.perform(editing::setStiffness(document_.editing().model(), {})); });
    layout->addRow(even_);
    connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
        if (contains(parts, editing::Part::Strands | editing::Part::MaskNames)) refresh();
    });
    refresh();
}

NumberSpin* StrandStiffness::factor(const char* name, const QString& tip, double value) {
    auto* spin = new NumberSpin;
    spin->setObjectName(name);
    spin->setToolTip(tip);
    spin->setDecimals(3);
    spin->setRange(0, static_cast<double>(runtime::kMostStiffness));
    spin->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    spin->setValue(value);
    return spin;
}

StiffnessRange StrandStiffness::range() const {
    return {static_cast<float>(black_->value()), static_cast<float>(white_->value())};
}

void StrandStiffness::takeMask() {
    const auto number = static_cast<std::uint32_t>(mask_->currentIndex()) + 1;
    Groom groom = document_.groom();
    if (auto taken = stiffnessFromMask(std::to_string(number), range(), groom); !taken)
        return messages_.warn(errorText(taken.error()));
    document_.perform(editing::setStiffness(document_.editing().model(),
                                            groom.strandAttributes.view<float>(attribute::kStiffness)));
}

void StrandStiffness::setShares(std::span<const float> shares) {
    document_.perform(editing::setStiffness(document_.editing().model(), stiffnessOfShares(shares, range())));
}

void StrandStiffness::refresh() {
    const int chosen = std::max(mask_->currentIndex(), 0);
    mask_->clear();
    mask_->addItems(maskLabels(document_.groom()));
    mask_->setCurrentIndex(chosen);
    even_->setVisible(document_.groom().strandAttributes.has(attribute::kStiffness));
}

}  // namespace hairloom::editor
