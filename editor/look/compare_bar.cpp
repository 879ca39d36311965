// SPDX-License-Identifier: GPL-3.0-or-later
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "editor/look/parts.h"

namespace hairloom::editor {
namespace {

class CompareBar : public QWidget {
  public:
    CompareBar(QtDocument& document, Viewport& viewport)
        : document_(document), viewport_(viewport), note_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(6);
        auto* row = new QHBoxLayout;
        row->setSpacing(6);
        layout->addLayout(row);
        const auto add = [&](const char* name, const QString& text, const QString& tip) {
            auto* button = new QPushButton(text);
            button->setObjectName(name);
            button->setToolTip(tip);
            row->addWidget(button, 1);
            return button;
        };
        keep_ = add("compareKeep", "Set as A", "Stores the current look as A, to compare others with it");
        show_ =
            add("compareShow", "A | B",
                "Split view: A on the left, the current look on the right. Drag the line to move the split");
        swap_ = add("compareSwap", "Swap", "Swaps the current look with A. You can undo this");
        show_->setCheckable(true);
        note_->setProperty("role", "dim");
        note_->setWordWrap(true);
        layout->addWidget(note_);
        connect(keep_, &QPushButton::clicked, this, [this] {
            kept_ = now();
            viewport_.setComparison(show_->isChecked() ? kept_ : std::nullopt);
            refresh();
        });
        connect(show_, &QPushButton::toggled, this, [this](bool on) {
            if (on && !kept_) kept_ = now();
            viewport_.setComparison(on ? kept_ : std::nullopt);
            refresh();
        });
        connect(swap_, &QPushButton::clicked, this, &CompareBar::swapLooks);
        connect(&document_, &QtDocument::replaced, this, [this] {
            kept_.reset();
            show_->setChecked(false);
            refresh();
        });
        refresh();
    }

  private:
    Viewport::Comparison now() const {
        const Groom& groom = document_.groom();
        return {groom.material, groom.interpolation, groom.shadows, viewport_.quality()};
    }

    void swapLooks() {
        if (!kept_) return;
        const Viewport::Comparison before = now();
        Groom groom = document_.groom();
        groom.material = kept_->material;
        groom.interpolation = kept_->interpolation;
        groom.shadows = kept_->shadows;
        const PictureQuality quality = kept_->quality;
        kept_ = before;
        document_.perform(editing::setSettings(document_.editing().model(), groom, "Swap looks"));
        viewport_.setQuality(quality);
        if (show_->isChecked()) viewport_.setComparison(kept_);
    }

    void refresh() {
        swap_->setEnabled(kept_.has_value());
        note_->setText(!kept_               ? QString("Store a look, change it, and compare.")
                       : show_->isChecked() ? QString("Drag the line in the viewport.")
                                            : QString("A is stored."));
    }

    QtDocument& document_;
    Viewport& viewport_;
    QPushButton *keep_, *show_, *swap_;
    QLabel* note_;
    std::optional<Viewport::Comparison> kept_;
};

}  // namespace

QWidget* makeCompareBar(QtDocument& document, Viewport& viewport) {
    return new CompareBar(document, viewport);
}

}  // namespace hairloom::editor
