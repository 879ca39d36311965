// SPDX-License-Identifier: GPL-3.0-or-later
// The key light as a lamp in the view: drag it around the head. Changes no document.
#include <cmath>
#include <optional>

#include "core/render/light.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {
namespace {

constexpr double kDistance_px = 150;  // of the lamp from the middle of the view, at least
constexpr float kWholeTurn = 360;

class LightTool : public Tool {
  public:
    explicit LightTool(Viewport& viewport) : viewport_(viewport) {
        connect(&viewport_, &Viewport::lightTurned, this, &Tool::updated);
    }
    const ToolInfo& info() const override { return info_; }
    QString hint() const override {
        return QString("%1. Now %2°")
            .arg(info_.tip)
            .arg(static_cast<double>(viewport_.lightTurn()), 0, 'f', 0);
    }

    void press(const Pointer& pointer) override {
        before_ = viewport_.lightTurn();
        last_px_ = pointer.at_px;
    }

    /// As far as the lamp moves across the view, before or behind the head.
    void drag(const Pointer& pointer) override {
        if (!before_) return;
        const auto across_px = static_cast<float>(pointer.at_px.x() - last_px_.x());
        last_px_ = pointer.at_px;
        const bool isBehind = toLamp_ws().dot(viewport_.camera().forward_ws()) > 0;
        const float degrees = across_px / static_cast<float>(distance_px()) * 180 / kPi;
        const float turn = viewport_.lightTurn() + (isBehind ? -degrees : degrees);
        viewport_.setLightTurn(std::remainder(turn, kWholeTurn));
    }

    void release(const Pointer&) override { before_.reset(); }

    void cancel() override {
        if (before_) viewport_.setLightTurn(*before_);
        before_.reset();
    }

    void draw(Marks& marks) const override {
        const OrbitCamera& camera = viewport_.camera();
        const Vec3f middle = camera.target_ws(), to = toLamp_ws();
        const float radius =
            camera.metresPerPixel(middle, viewport_.viewSize_px()) * static_cast<float>(distance_px());
        const Vec3f lamp = middle + radius * to;
        const Vec3f above = middle + Vec3f(0, radius * to.y(), 0);
        const QColor colour(255, 214, 110), way(255, 214, 110, 110);
        marks.circle(above, Vec3f::UnitY(), (lamp - above).norm(), way, 1.5f, Marks::Depth::OnTop);
        marks.line(lamp, middle + 0.55f * radius * to, colour, 2, Marks::Depth::OnTop);
        marks.point(lamp, before_ ? Qt::white : colour, 15, Marks::Depth::OnTop);
    }

  private:
    /// Unit length.
    Vec3f toLamp_ws() const {
        const Eigen::AngleAxisf turn(radians(viewport_.lightTurn()), Vec3f::UnitY());
        return turn * render::studioLights(viewport_.camera().camera()).front().toLight_ws;
    }
    double distance_px() const {
        const QSizeF view = viewport_.viewSize_px();
        return std::max(kDistance_px, 0.38 * std::min(view.width(), view.height()));
    }

    Viewport& viewport_;
    ToolInfo info_{
        "light", QString("Light"), "light", QString("Drag the lamp around the head"), QKeySequence("Shift+V"),
        430};
    std::optional<float> before_;  ///< degrees, as the drag found it
    QPointF last_px_;
};

}  // namespace

ToolMaker lightTool() {
    return [](const ToolParts& parts) { return oneTool<LightTool>(parts.viewport); };
}

}  // namespace hairloom::editor
