// SPDX-License-Identifier: GPL-3.0-or-later
// The wind as an arrow in the view: drag to turn it, away from the head for more of it.
#include <cmath>

#include "core/editing/settings_commands.h"
#include "editor/overlays/overlay_mode.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {
namespace {

constexpr float kFastest = 25;  // m/s that a drag reaches

class WindTool : public Tool {
  public:
    WindTool(QtDocument& document, Player& player, Viewport& viewport)
        : document_(document), player_(player), viewport_(viewport) {
        connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
            if (contains(parts, editing::Part::Physics)) Q_EMIT updated();
        });
    }
    const ToolInfo& info() const override { return info_; }

    QString hint() const override {
        return QString("%1. Now %2 m/s")
            .arg(info_.tip)
            .arg(document_.groom().simulation.windSpeed, 0, 'f', 1);
    }

    void press(const Pointer& pointer) override {
        before_ = document_.groom().simulation;
        drag_ = QtDocument::nextMergeKey();
        drag(pointer);
    }

    /// The arrow lies in the plane of the view and blows from the middle to the pointer.
    void drag(const Pointer& pointer) override {
        if (!before_) return;
        const OrbitCamera& camera = viewport_.camera();
        const auto middle = camera.project(middle_ws(), viewport_.viewSize_px());
        if (!middle) return;
        const QPointF out = pointer.at_px - *middle;
        const auto x = static_cast<float>(out.x()), y = static_cast<float>(-out.y());
        const float length = std::hypot(x, y);
        runtime::SimulationSettings settings = *before_;
        settings.windSpeed = length < 12 ? 0.0f : std::min(length / kWindPixels, kFastest);
        if (length >= 12) {
            const Vec3f direction = (x * camera.right_ws() + y * camera.up_ws()).normalized();
            settings.windDirection = {direction.x(), direction.y(), direction.z()};
        }
        store(settings);
    }

    void release(const Pointer&) override { before_.reset(); }

    void cancel() override {
        if (!before_) return;
        store(*before_);
        release({});
    }

    void draw(Marks& marks) const override { drawWind({document_.groom(), viewport_, player_}, marks); }

  private:
    Vec3f middle_ws() const { return viewport_.camera().target_ws(); }
    void store(const runtime::SimulationSettings& settings) {
        document_.performMerged(
            drag_, [&](const editing::Model& model) { return editing::setPhysics(model, settings, "Wind"); });
    }

    QtDocument& document_;
    Player& player_;
    Viewport& viewport_;
    ToolInfo info_{
        "wind",
        QString("Wind"),
        "wind",
        QString(
            "Drag from the middle of the view in the direction of the wind. A longer drag is stronger wind"),
        QKeySequence("W"),
        410};
    std::optional<runtime::SimulationSettings> before_;
    quint64 drag_ = 0;  ///< merge key: one drag is one step of the history
};

}  // namespace

ToolMaker windTool() {
    return [](const ToolParts& parts) {
        return oneTool<WindTool>(parts.document, parts.player, parts.viewport);
    };
}

}  // namespace hairloom::editor
