// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The tools there are, and which one has the pointer.

#include <QObject>
#include <memory>
#include <vector>

#include "editor/tools/tool_maker.h"

namespace hairloom::editor {

class ToolBox : public QObject {
    Q_OBJECT

  public:
    explicit ToolBox(QObject* parent = nullptr);
    ~ToolBox() override;

    /// Makes all tools there are; once.
    void fill(const ToolParts& parts);
    /// In the order of the tool bar.
    const std::vector<std::unique_ptr<Tool>>& all() const { return tools_; }
    Tool* find(const QString& id) const;
    Tool* active() const { return active_; }
    /// Null: the pointer moves the view.
    void activate(Tool* tool);

  Q_SIGNALS:
    void activeChanged(hairloom::editor::Tool* tool);

  private:
    std::vector<std::unique_ptr<Tool>> tools_;
    Tool* active_ = nullptr;
};

}  // namespace hairloom::editor
