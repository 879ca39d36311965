// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Draws the curve of an operator: a parting, the middle of a braid, what hair is drawn to.

#include "core/groom/operator_stack.h"
#include "editor/tools/surface_pick.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {

class CurveTool : public Tool {
    Q_OBJECT

  public:
    explicit CurveTool(const ToolParts& parts);

    const ToolInfo& info() const override { return info_; }
    QString hint() const override;
    void activate() override;
    void press(const Pointer& pointer) override;
    void drag(const Pointer& pointer) override;
    void release(const Pointer& pointer) override;
    void cancel() override;
    void draw(Marks& marks) const override;

    /// Whose curve is drawn; where that has none, the last that has one.
    void setOperator(std::size_t index);

  private:
    /// Null where no operator has a curve.
    const Operator* shown() const;
    std::size_t shownIndex() const;
    void take(const Pointer& pointer);
    void store(const std::vector<Vec3f>& points);

    QtDocument& document_;
    Messages& messages_;
    Player& player_;
    Viewport& viewport_;
    ToolInfo info_;
    std::size_t index_ = 0;
    QPointF begin_px_;
    std::vector<Vec3f> path_ss_;  ///< while it is drawn
};

}  // namespace hairloom::editor
