// SPDX-License-Identifier: GPL-3.0-or-later
// The wind as an arrow in the view: drag to turn it, away from the head for more of it.
#include <cmath>

#include "editor/overlays/overlay_mode.h"
#include "editor/session.h"
#include "editor/tools/registry.h"

namespace hairloom::editor {
namespace {

constexpr float kFastest = 25;  // m/s that a drag reaches

class WindTool : public Tool {
  public:
    explicit WindTool(Session& session) : session_(session) {
        connect(&session_.document, &Document::changed, this, [this](Changes changes) {
            if (changes & Change::Simulation) Q_EMIT updated();
        });
    }
    const ToolInfo& info() const override { return info_; }

    QString hint() const override {
        return tr("%1. Now %2 m/s")
            .arg(info_.tip)
            .arg(session_.document.groom().simulation.windSpeed, 0, 'f', 1);
    }

    void press(const Pointer& pointer) override {
        before_ = session_.document.groom().simulation;
        drag(pointer);
    }

    /// The arrow lies in the plane of the view and blows from the middle to the pointer.
    void drag(const Pointer& pointer) override {
        if (!before_) return;
        const OrbitCamera& camera = session_.viewport->camera();
        const auto middle = camera.project(middle_ws(), session_.viewport->viewSize_px());
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
        Groom groom = session_.document.groom();
        groom.simulation = settings;
        session_.document.change(tr("Wind"), Change::Simulation, std::move(groom), mergeKey());
    }

    void release(const Pointer&) override {
        before_.reset();
        ++strokes_;
    }

    void cancel() override {
        if (!before_) return;
        Groom groom = session_.document.groom();
        groom.simulation = *before_;
        session_.document.change(tr("Wind"), Change::Simulation, std::move(groom), mergeKey());
        release({});
    }

    void draw(Marks& marks) const override { drawWind(session_, marks); }

  private:
    Vec3f middle_ws() const { return session_.viewport->camera().target_ws(); }
    /// One drag is one step of the history.
    quint64 mergeKey() const { return (quint64{0x77696e64} << 32u) + strokes_; }

    Session& session_;
    ToolInfo info_{"wind", tr("Wind"), "wind",
                   tr("Drag from the middle of the view to where the wind blows; farther is stronger"),
                   QKeySequence("W")};
    std::optional<runtime::SimulationSettings> before_;
    quint64 strokes_ = 0;
};

}  // namespace

ToolMaker windTool() {
    return [](Session& session) -> std::unique_ptr<Tool> { return std::make_unique<WindTool>(session); };
}

}  // namespace hairloom::editor
