// SPDX-License-Identifier: GPL-3.0-or-later
// Drags the head about, to see how the hair follows. Changes no document.
#include "editor/session.h"
#include "editor/tools/registry.h"

namespace hairloom::editor {
namespace {

constexpr float kTurnPerPixel = 0.01f;  // radians

class HeadTool : public Tool {
  public:
    explicit HeadTool(Session& session) : session_(session) {
        connect(&session_.player, &Player::stateChanged, this, [this] {
            if (!session_.player.hasFrame() && !session_.player.isPlaying()) offset_.setIdentity();
        });
    }
    const ToolInfo& info() const override { return info_; }
    QString hint() const override { return tr("%1. Shift turns it instead").arg(info_.tip); }

    void press(const Pointer& pointer) override {
        held_ = true;
        from_px_ = pointer.at_px;
        start_ = offset_;
        if (!session_.player.isPlaying()) session_.player.play();
    }

    void drag(const Pointer& pointer) override {
        if (!held_) return;
        const OrbitCamera& camera = session_.viewport->camera();
        const QPointF by = pointer.at_px - from_px_;
        const auto x = static_cast<float>(by.x()), y = static_cast<float>(by.y());
        const Vec3f pivot = camera.target_ws();
        if (pointer.modifiers & Qt::ShiftModifier) {
            const Eigen::Isometry3f turn =
                Eigen::Translation3f(pivot) * Eigen::AngleAxisf(kTurnPerPixel * x, Vec3f::UnitY()) *
                Eigen::AngleAxisf(kTurnPerPixel * y, camera.right_ws()) * Eigen::Translation3f(-pivot);
            offset_ = turn * start_;
        } else {
            const float metres = camera.metresPerPixel(pivot, session_.viewport->viewSize_px());
            offset_ = Eigen::Translation3f(metres * (x * camera.right_ws() - y * camera.up_ws())) * start_;
        }
        session_.player.setHeadOffset(offset_);
    }

    void release(const Pointer&) override { held_ = false; }

    void cancel() override {
        if (!held_) return;
        held_ = false;
        offset_ = start_;
        session_.player.setHeadOffset(offset_);
    }

  private:
    Session& session_;
    ToolInfo info_{"head", tr("Drag the head"), "drag-head",
                   tr("Drag to move the head and watch the hair follow"), QKeySequence("H")};
    Eigen::Isometry3f offset_ = Eigen::Isometry3f::Identity();
    Eigen::Isometry3f start_ = Eigen::Isometry3f::Identity();
    QPointF from_px_;
    bool held_ = false;
};

}  // namespace

ToolMaker headTool() {
    return [](Session& session) -> std::unique_ptr<Tool> { return std::make_unique<HeadTool>(session); };
}

}  // namespace hairloom::editor
