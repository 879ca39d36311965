// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Picks cards of the level that the Levels panel shows.

#include <memory>
#include <optional>

#include "core/cards/cards.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {

class CardTool : public Tool {
    Q_OBJECT

  public:
    CardTool(QtDocument& document, Viewport& viewport) : document_(document), viewport_(viewport) {}

    const ToolInfo& info() const override { return info_; }
    QString hint() const override;
    void press(const Pointer& pointer) override;
    bool key(int key, Qt::KeyboardModifiers modifiers) override;

    /// What can be picked; null: nothing.
    void setMesh(std::shared_ptr<const cards::CardMesh> mesh) { mesh_ = std::move(mesh); }
    /// The card that is nearest under this place of the view and not behind the head.
    std::optional<std::uint32_t> cardAt(const QPointF& at_px) const;

  Q_SIGNALS:
    void picked(std::optional<std::uint32_t> card);
    void deleteAsked();

  private:
    QtDocument& document_;
    Viewport& viewport_;
    std::shared_ptr<const cards::CardMesh> mesh_;
    ToolInfo info_{"card",
                   QString("Pick cards"),
                   "card",
                   QString("Click a card of the level shown in the Levels panel to edit it"),
                   QKeySequence("Shift+K"),
                   410};
};

}  // namespace hairloom::editor
