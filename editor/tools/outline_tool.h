// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What tools share that choose by an outline on the screen: a box or a lasso, adding with Shift, taking away
// with Ctrl.

#include "core/editing/region_select.h"
#include "core/editing/selection_commands.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {

class OutlineTool : public Tool {
    Q_OBJECT

  public:
    enum class Shape { Box, Lasso };
    OutlineTool(const ToolParts& parts, Shape shape, ToolInfo info);

    const ToolInfo& info() const override { return info_; }
    void activate() override;
    void press(const Pointer& pointer) override;
    void drag(const Pointer& pointer) override;
    void release(const Pointer& pointer) override;
    void cancel() override;
    void draw(Marks& marks) const override;

  protected:
    /// Chooses what is inside.
    virtual void choose(const editing::ScreenRegion& region, editing::Choice choice) = 0;
    /// The pointer did not move.
    virtual void click(const QPointF&, editing::Choice) {}
    void setShape(Shape shape) { shape_ = shape; }
    Shape shape() const { return shape_; }
    QtDocument& document() const { return document_; }
    const Preferences& preferences() const { return preferences_; }
    const Viewport& viewport() const { return viewport_; }

  private:
    std::vector<QPointF> corners_px() const;

    QtDocument& document_;
    const Preferences& preferences_;
    Player& player_;
    Viewport& viewport_;
    Shape shape_;
    ToolInfo info_;
    std::vector<QPointF> path_px_;
};

}  // namespace hairloom::editor
