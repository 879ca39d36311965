// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/card_box.h"

#include <QFormLayout>
#include <QGridLayout>
#include <QVBoxLayout>
#include <algorithm>

#include "core/editing/command.h"
#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/levels/held_cards.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"

namespace hairloom::editor {

CardBox::CardBox(QtDocument& document, Messages& messages, ToolBox& tools)
    : document_(document),
      messages_(messages),
      tool_(dynamic_cast<CardTool*>(tools.find("card"))),
      words_(new QLabel),
      width_(new NumberBox(static_cast<double>(kLeastCardWidth), static_cast<double>(kMostCardWidth), false)),
      bend_(new NumberBox(-1, 1, false)) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(6);
    words_->setObjectName("cardWords");
    words_->setWordWrap(true);
    layout->addWidget(words_);
    auto* form = new QFormLayout;
    form->setVerticalSpacing(6);
    width_->setObjectName("cardWidth");
    width_->setToolTip("Width of the card relative to the width of its hair");
    bend_->setObjectName("cardBend");
    bend_->setToolTip(
        "How far the edges of the card bend outwards relative to half its width. Below 0 they bend "
        "inwards, around the head");
    form->addRow("Width", width_);
    form->addRow("Bend", bend_);
    layout->addLayout(form);
    pick_ = pushButton("cardPick", "Pick", "Activate the tool that picks cards in the view (Shift+K)",
                       [this, &tools] { tools.activate(tool_); });
    pin_ = pushButton(
        "cardPin", "Pin", "Keeps the card in place when levels are created again, whatever its hair does",
        [this] {
            change(QtDocument::nextMergeKey(),
                   pin_->isChecked() ? QString("Pin card") : QString("Unpin card"), [this](CardEdit& edit) {
                       edit.strip.clear();
                       if (pin_->isChecked()) edit.strip = stationsOf(cards()->cards[*picked_].strip);
                   });
        });
    pin_->setCheckable(true);
    delete_ = pushButton("cardDelete", "Delete", "Remove the card and leave its hair without one", [this] {
        change(QtDocument::nextMergeKey(), "Delete card", [](CardEdit& edit) { edit.deleted = true; });
    });
    forget_ = pushButton("cardForget", "Reset", "Resets the card to the shape of its hair",
                         [this] { forget(false); });
    forgetAll_ =
        pushButton("cardForgetAll", "Reset all",
                   "Resets all cards of this level to the shape of their hair and restores deleted cards",
                   [this] { forget(true); });
    // In pairs they fit into a narrow panel.
    auto* buttons = new QGridLayout;
    int place = 0;
    for (QPushButton* button : {pick_, pin_, delete_, forget_, forgetAll_}) {
        buttons->addWidget(button, place / 2, place % 2);
        ++place;
    }
    layout->addLayout(buttons);
    connect(tool_, &CardTool::picked, this, &CardBox::pick);
    connect(tool_, &CardTool::deleteAsked, delete_, &QPushButton::click);
    for (NumberBox* box : {width_, bend_})
        connect(box, &NumberBox::begun, this, [this] { drag_ = QtDocument::nextMergeKey(); });
    connect(width_, &NumberBox::edited, this, [this](double value) {
        change(drag_, "Width of card", [value](CardEdit& edit) { edit.width = static_cast<float>(value); });
    });
    connect(bend_, &NumberBox::edited, this, [this](double value) {
        change(drag_, "Bend of card", [value](CardEdit& edit) { edit.bend = static_cast<float>(value); });
    });
    connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
        if (!contains(changed, editing::Part::Cards)) return;
        shape();
        refresh();
        Q_EMIT this->changed();
    });
    refresh();
}

cards::Cards* CardBox::cards() const {
    return level_ == nullptr ? nullptr : std::get_if<cards::Cards>(&level_->level.content);
}

std::uint32_t CardBox::levelNumber() const {
    return static_cast<std::uint32_t>(level_->level.spec.amount);
}

void CardBox::setLevel(MadeLevel* level, const std::vector<Vec3f>* roots_ws) {
    if (level != level_) picked_.reset();
    level_ = level;
    roots_ws_ = roots_ws;
    shape();
    refresh();
}

void CardBox::shape() {
    cards::Cards* const made = cards();
    if (made == nullptr) return tool_->setMesh(nullptr);
    const auto& edits = document_.groom().cardEdits;
    for (cards::Card& card : made->cards) {
        const auto found = findEdit(edits, card, levelNumber(), *roots_ws_);
        const CardEdit edit = found ? edits[*found] : CardEdit();
        card.width = edit.width, card.bend = edit.bend, card.deleted = edit.deleted;
    }
    cards::buildMesh(*made);
    if (picked_ && made->cards[*picked_].deleted) picked_.reset();
    tool_->setMesh(std::make_shared<const cards::CardMesh>(made->mesh));
}

void CardBox::pick(std::optional<std::uint32_t> card) {
    picked_ = card;
    refresh();
    Q_EMIT changed();
}

std::optional<std::size_t> CardBox::editIndex() const {
    if (!picked_) return std::nullopt;
    return findEdit(document_.groom().cardEdits, cards()->cards[*picked_], levelNumber(), *roots_ws_);
}

CardEdit CardBox::edit() const {
    if (const auto index = editIndex()) return document_.groom().cardEdits[*index];
    return editOf(cards()->cards[*picked_], levelNumber(), *roots_ws_);
}

void CardBox::change(quint64 key, const QString& name, const std::function<void(CardEdit&)>& change) {
    if (!picked_) return;
    CardEdit edited = edit();
    change(edited);
    std::vector<CardEdit> edits = document_.groom().cardEdits;
    if (const auto index = editIndex()) {
        edits[*index] = std::move(edited);
    } else {
        edits.push_back(std::move(edited));
    }
    perform(key, name, edits);
}

void CardBox::forget(bool all) {
    std::vector<CardEdit> edits = document_.groom().cardEdits;
    if (all) {
        std::erase_if(edits, [this](const CardEdit& edit) { return edit.level == levelNumber(); });
    } else if (const auto index = editIndex()) {
        edits.erase(edits.begin() + static_cast<std::ptrdiff_t>(*index));
    }
    perform(QtDocument::nextMergeKey(), all ? QString("Reset cards") : QString("Reset card"), edits);
}

void CardBox::perform(quint64 key, const QString& name, const std::vector<CardEdit>& edits) {
    document_.performMerged(key, [&](const editing::Model& model) -> std::unique_ptr<editing::Command> {
        auto command = editing::setCardEdits(model, edits, name.toStdString());
        if (command) return std::move(*command);
        messages_.warn(errorText(command.error()));
        return nullptr;
    });
}

void CardBox::refresh() {
    setVisible(cards() != nullptr);
    const bool any = picked_.has_value();
    for (QWidget* part : {static_cast<QWidget*>(width_), static_cast<QWidget*>(bend_),
                          static_cast<QWidget*>(pin_), static_cast<QWidget*>(delete_)})
        part->setEnabled(any);
    forget_->setEnabled(editIndex().has_value());
    forgetAll_->setEnabled(cards() != nullptr &&
                           std::ranges::any_of(document_.groom().cardEdits, [this](const CardEdit& edit) {
                               return edit.level == levelNumber();
                           }));
    const CardEdit shown = any ? edit() : CardEdit();
    width_->setValue(static_cast<double>(shown.width));
    bend_->setValue(static_cast<double>(shown.bend));
    pin_->setChecked(!shown.strip.empty());
    if (any) {
        words_->setText(
            QString("Card %1, of %L2 hairs.").arg(*picked_ + 1).arg(cards()->cards[*picked_].strands.size()));
    } else {
        words_->setText(
            "Pick a card in the view to edit it. Your edits survive when levels are created again.");
    }
}

}  // namespace hairloom::editor
