// SPDX-License-Identifier: GPL-3.0-or-later
// Drags the head about, to see how the hair follows. Changes no document.
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {
namespace {

constexpr float kTurnPerPixel = 0.01f;  // radians

class HeadTool : public Tool {
  public:
    HeadTool(Player& player, Viewport& viewport) : player_(player), viewport_(viewport) {
        connect(&player_, &Player::headOffsetChanged, this, [this] { offset_ = player_.headOffset(); });
    }
    const ToolInfo& info() const override { return info_; }
    QString hint() const override { return QString("%1. Hold Shift to rotate it").arg(info_.tip); }

    void press(const Pointer& pointer) override {
        held_ = true;
        from_px_ = pointer.at_px;
        start_ = offset_;
        // At the play head it is posed, for a key.
        if (!player_.isPlaying() && !player_.isScrubbed()) player_.play();
    }

    void drag(const Pointer& pointer) override {
        if (!held_) return;
        const OrbitCamera& camera = viewport_.camera();
        const QPointF by = pointer.at_px - from_px_;
        const auto x = static_cast<float>(by.x()), y = static_cast<float>(by.y());
        const Vec3f pivot = camera.target_ws();
        if (pointer.modifiers & Qt::ShiftModifier) {
            const Eigen::Isometry3f turn =
                Eigen::Translation3f(pivot) * Eigen::AngleAxisf(kTurnPerPixel * x, Vec3f::UnitY()) *
                Eigen::AngleAxisf(kTurnPerPixel * y, camera.right_ws()) * Eigen::Translation3f(-pivot);
            offset_ = turn * start_;
        } else {
            const float metres = camera.metresPerPixel(pivot, viewport_.viewSize_px());
            offset_ = Eigen::Translation3f(metres * (x * camera.right_ws() - y * camera.up_ws())) * start_;
        }
        player_.setHeadOffset(offset_);
    }

    void release(const Pointer&) override { held_ = false; }

    void cancel() override {
        if (!held_) return;
        held_ = false;
        offset_ = start_;
        player_.setHeadOffset(offset_);
    }

  private:
    Player& player_;
    Viewport& viewport_;
    ToolInfo info_{"head",
                   QString("Drag the head"),
                   "drag-head",
                   QString("Drag to move the head and watch the hair follow"),
                   QKeySequence("H"),
                   420};
    Eigen::Isometry3f offset_ = Eigen::Isometry3f::Identity();
    Eigen::Isometry3f start_ = Eigen::Isometry3f::Identity();
    QPointF from_px_;
    bool held_ = false;
};

}  // namespace

ToolMaker headTool() {
    return [](const ToolParts& parts) { return oneTool<HeadTool>(parts.player, parts.viewport); };
}

}  // namespace hairloom::editor
