// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The points, planes and directions of an operator as handles in the view: crowns, partings, cutting planes,
// mirrors. Dragged, or picked on the head.

#include <optional>

#include "core/groom/file/fields.h"
#include "core/operations/stack.h"
#include "editor/tools/surface_pick.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {

class HandleTool : public Tool {
    Q_OBJECT

  public:
    explicit HandleTool(const ToolParts& parts);

    /// A setting of three numbers that has a place in the view.
    struct Handle {
        FieldInfo field;
        SettingsPart part;
        bool isPoint;                       ///< a place; else a direction from `anchor`
        std::optional<std::size_t> anchor;  ///< the point before it among the handles
    };

    const ToolInfo& info() const override { return info_; }
    QString hint() const override;
    void activate() override;
    void press(const Pointer& pointer) override;
    void drag(const Pointer& pointer) override;
    void release(const Pointer& pointer) override;
    void cancel() override;
    void draw(Marks& marks) const override;

    /// Whose handles are shown; where that has none, nothing is.
    void setOperator(std::size_t index);
    /// The next press puts this point of the operator onto the head.
    void pickOnHead(std::size_t index, const FieldInfo& field, SettingsPart part);

    std::vector<Handle> handles() const;
    /// Where a point is, or where a direction ends as it is drawn; in the scalp's rest space.
    Vec3f place_ss(const Handle& handle) const;

  private:
    const Operator* shown() const;
    Vec3f value(const Handle& handle) const;
    Vec3f anchor_ss(const Handle& handle) const;
    void store(const Handle& handle, const Vec3f& value);
    std::optional<std::size_t> handleAt(const QPointF& at_px) const;
    /// Metres of an arrow whose direction has length 1.
    float arrow() const;
    QString name(const Handle& handle) const;

    QtDocument& document_;
    Messages& messages_;
    Player& player_;
    Viewport& viewport_;
    ToolInfo info_;
    std::size_t index_ = 0;
    std::optional<std::size_t> held_;
    std::optional<Handle> picking_;
    std::optional<Operator> before_;  ///< as the drag found it
    quint64 step_ = 0;                ///< one drag is one step of the history
};

}  // namespace hairloom::editor
