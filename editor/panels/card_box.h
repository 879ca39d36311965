// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One card of a level, shaped by hand: width, bend, pinned, deleted. What it says is a step of the document.

#include <QLabel>
#include <QPushButton>
#include <functional>
#include <optional>
#include <vector>

#include "editor/document/messages.h"
#include "editor/document/qt_document.h"
#include "editor/fields/number_box.h"
#include "editor/panels/made_levels.h"
#include "editor/tools/card_tool.h"
#include "editor/tools/tool_box.h"

namespace hairloom::editor {

class CardBox : public QWidget {
    Q_OBJECT

  public:
    CardBox(QtDocument& document, Messages& messages, ToolBox& tools);
    /// The level whose cards can be picked, with the roots of all its hairs; null: none. Gives it the shape
    /// that the document says. Both live until the next call.
    void setLevel(MadeLevel* level, const std::vector<Vec3f>* roots_ws);
    std::optional<std::uint32_t> picked() const { return picked_; }

  Q_SIGNALS:
    /// Another card is picked, or cards have another shape.
    void changed();

  private:
    void pick(std::optional<std::uint32_t> card);
    void shape();
    void refresh();
    cards::Cards* cards() const;
    std::uint32_t levelNumber() const;
    /// Of the card that is picked; one that does nothing yet where there is none.
    CardEdit edit() const;
    std::optional<std::size_t> editIndex() const;
    void change(quint64 key, const QString& name, const std::function<void(CardEdit&)>& change);
    void forget(bool all);
    void perform(quint64 key, const QString& name, const std::vector<CardEdit>& edits);

    QtDocument& document_;
    Messages& messages_;
    CardTool* tool_;
    QLabel* words_;
    NumberBox *width_, *bend_;
    QPushButton *pick_, *pin_, *delete_, *forget_, *forgetAll_;
    MadeLevel* level_ = nullptr;
    const std::vector<Vec3f>* roots_ws_ = nullptr;
    std::optional<std::uint32_t> picked_;
    quint64 drag_ = 0;
};

}  // namespace hairloom::editor
