// SPDX-License-Identifier: GPL-3.0-or-later
// Collision spheres by hand: a click on the head places one, a drag of its middle moves it, of its rim
// resizes it.
#include "core/animation/bone_near.h"
#include "core/editing/document.h"
#include "core/editing/sphere_commands.h"
#include "editor/fields/option_form.h"
#include "editor/overlays/overlay_mode.h"
#include "editor/tools/surface_pick.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {
namespace {

class SphereTool : public Tool {
  public:
    SphereTool(QtDocument& document, const Preferences& preferences, Messages& messages, Player& player,
               Viewport& viewport)
        : document_(document),
          preferences_(preferences),
          messages_(messages),
          player_(player),
          viewport_(viewport) {}

    const ToolInfo& info() const override { return info_; }

    void activate() override {
        if (player_.hasFrame() && !player_.isPlaying()) player_.reset();
    }

    void press(const Pointer& pointer) override {
        editing::Document& document = document_.editing();
        from_px_ = pointer.at_px;
        held_ = editing::pickSphere(document.groom().spheres, viewOf(viewport_), toPixels(pointer.at_px));
        if (held_) {
            start_ = document.groom().spheres[*held_];
            resizing_ = onRim(start_, pointer.at_px);
            moved_ = start_;
            return;
        }
        const BrushPlace place = placeUnder(document_, viewport_, pointer.at_px);
        if (!place.skin) return;
        const auto& actor = player_.actor();
        const std::string bone = actor ? boneNear(actor->skeleton(), place.position_ss) : std::string();
        document.perform(editing::placeSphere(document.model(), *place.skin, radius_, bone));
        messages_.say("Sphere added. Drag its centre to move it, its edge to resize it");
    }

    void drag(const Pointer& pointer) override {
        if (!held_) return;
        const OrbitCamera& camera = viewport_.camera();
        const float metres = camera.metresPerPixel(start_.centre, viewport_.viewSize_px());
        const QPointF by = pointer.at_px - from_px_;
        moved_ = start_;
        if (resizing_) {
            const auto centre = camera.project(start_.centre, viewport_.viewSize_px());
            if (!centre) return;
            const QPointF out = pointer.at_px - *centre;
            moved_.radius = std::clamp(metres * static_cast<float>(std::hypot(out.x(), out.y())),
                                       editing::kSmallestSphere, editing::kLargestSphere);
        } else {
            moved_.centre += metres * (static_cast<float>(by.x()) * camera.right_ws() -
                                       static_cast<float>(by.y()) * camera.up_ws());
        }
        Q_EMIT updated();
    }

    void release(const Pointer&) override {
        if (!held_) return;
        editing::Document& document = document_.editing();
        document.perform(resizing_ ? editing::resizeSphere(document.model(), *held_, moved_.radius)
                                   : editing::moveSphere(document.model(), *held_, moved_.centre));
        held_.reset();
        Q_EMIT updated();
    }

    void cancel() override { held_.reset(); }

    bool key(int key, Qt::KeyboardModifiers) override {
        if (key != Qt::Key_Delete || !held_) return false;
        editing::Document& document = document_.editing();
        document.perform(editing::removeSphere(document.model(), *held_));
        held_.reset();
        return true;
    }

    void draw(Marks& marks) const override {
        drawSpheres({document_.groom(), viewport_, player_}, marks);
        if (!held_) return;
        marks.circle(moved_.centre, -viewport_.camera().forward_ws(), moved_.radius, QColor(255, 200, 80),
                     2.5f, Marks::Depth::OnTop);
    }

    QWidget* makeOptions() override {
        auto* form = new OptionForm(preferences_);
        form->addNumber(
            "sphereRadius", "Radius", "Radius of new spheres", "m", 0.005, 0.2, false,
            [this] { return static_cast<double>(radius_); },
            [this](double value) { radius_ = static_cast<float>(value); });
        return form;
    }

  private:
    bool onRim(const CollisionSphere& sphere, const QPointF& at_px) const {
        const QSizeF view = viewport_.viewSize_px();
        const auto centre = viewport_.camera().project(sphere.centre, view);
        if (!centre) return false;
        const float rim = sphere.radius / viewport_.camera().metresPerPixel(sphere.centre, view);
        return std::hypot(at_px.x() - centre->x(), at_px.y() - centre->y()) > 0.75 * static_cast<double>(rim);
    }

    QtDocument& document_;
    const Preferences& preferences_;
    Messages& messages_;
    Player& player_;
    Viewport& viewport_;
    ToolInfo info_{
        "sphere",
        QString("Spheres"),
        "sphere",
        QString("Click the head to add a sphere. Drag its centre to move it, its edge to resize it"),
        QKeySequence("O"),
        400};
    float radius_ = 0.05f;
    std::optional<std::size_t> held_;
    bool resizing_ = false;
    CollisionSphere start_, moved_;
    QPointF from_px_;
};

}  // namespace

ToolMaker sphereTool() {
    return [](const ToolParts& parts) {
        return oneTool<SphereTool>(parts.document, parts.preferences, parts.messages, parts.player,
                                   parts.viewport);
    };
}

}  // namespace hairloom::editor
