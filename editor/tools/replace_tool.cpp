// SPDX-License-Identifier: GPL-3.0-or-later
// Places hair anew only where somebody paints: with the settings of the scalp panel, when the brush is
// lifted.
#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "core/editing/document.h"
#include "core/editing/place.h"
#include "core/editing/surface_disc.h"
#include "editor/document/words.h"
#include "editor/fields/option_form.h"
#include "editor/tools/surface_pick.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {
namespace {

constexpr float kSmallest = 0.002f, kLargest = 0.2f;  // metres

class ReplaceTool : public Tool {
  public:
    ReplaceTool(QtDocument& document, const Preferences& preferences, Messages& messages, Player& player,
                Viewport& viewport)
        : document_(document),
          preferences_(preferences),
          messages_(messages),
          player_(player),
          viewport_(viewport) {}
    const ToolInfo& info() const override { return info_; }
    QString hint() const override { return QString("%1. [ ] set the size, Esc cancels").arg(info_.tip); }

    void activate() override {
        if (player_.hasFrame()) player_.reset();
    }
    void hover(const Pointer& pointer) override {
        place_ = skinUnder(document_, viewport_, pointer.at_px);
        Q_EMIT updated();
    }
    void leave() override {
        place_.reset();
        Q_EMIT updated();
    }
    void press(const Pointer& pointer) override {
        painting_ = true;
        drag(pointer);
    }
    void drag(const Pointer& pointer) override {
        place_ = skinUnder(document_, viewport_, pointer.at_px);
        editing::Document& document = document_.editing();
        if (!painting_ || !place_->skin || !document.surface()) return;
        const Groom& groom = document.groom();
        FaceSet here = editing::faceDisc(*groom.scalp, *document.surface(), place_->position_ss, radius_);
        // Hair grows on the scalp only.
        std::erase_if(here, [&](std::uint32_t face) {
            return !std::ranges::binary_search(groom.scalpSelection, face);
        });
        FaceSet both;
        std::ranges::set_union(region_, here, std::back_inserter(both));
        region_ = std::move(both);
        Q_EMIT updated();
    }
    void release(const Pointer&) override {
        if (!painting_) return;
        painting_ = false;
        const FaceSet region = std::exchange(region_, {});
        if (!region.empty()) replaceHair(region);
        Q_EMIT updated();
    }
    void cancel() override {
        painting_ = false;
        region_.clear();
        Q_EMIT updated();
    }
    bool key(int key, Qt::KeyboardModifiers) override {
        if (key != Qt::Key_BracketLeft && key != Qt::Key_BracketRight) return false;
        radius_ = std::clamp(radius_ * (key == Qt::Key_BracketLeft ? 1 / 1.15f : 1.15f), kSmallest, kLargest);
        if (form_) form_->refresh();
        Q_EMIT updated();
        return true;
    }

    void draw(Marks& marks) const override {
        const Groom& groom = document_.groom();
        if (!groom.scalp) return;
        for (const std::uint32_t face : region_) {
            marks.triangle(
                {groom.scalp->pointAt(face, Vec3f::UnitX()), groom.scalp->pointAt(face, Vec3f::UnitY()),
                 groom.scalp->pointAt(face, Vec3f::UnitZ())},
                QColor(90, 230, 140, 120));
        }
        if (!place_ || !place_->skin) return;
        marks.circle(place_->position_ss, place_->normal_ss, radius_, QColor(0, 0, 0, 120), 3.5f,
                     Marks::Depth::OnTop);
        marks.circle(place_->position_ss, place_->normal_ss, radius_, QColor(255, 255, 255, 230), 1.5f,
                     Marks::Depth::OnTop);
    }

    QWidget* makeOptions() override {
        form_ = new OptionForm(preferences_);
        form_->addNumber(
            "replaceRadius", "Radius", "Brush radius on the skin. Press [ and ]", "m",
            static_cast<double>(kSmallest), static_cast<double>(kLargest), false,
            [this] { return static_cast<double>(radius_); },
            [this](double value) {
                radius_ = static_cast<float>(value);
                Q_EMIT updated();
            });
        form_->addNumber(
            "replaceReach", "Copy shape",
            "New hair copies the shape of hair within this distance. 0 grows straight hair", "m", 0, 0.2,
            false, [this] { return static_cast<double>(reach_); },
            [this](double value) { reach_ = static_cast<float>(value); });
        return form_;
    }

  private:
    void replaceHair(const FaceSet& region) {
        editing::Document& document = document_.editing();
        auto command = editing::place(document.groom(), {region, reach_}, {document.skinField(), 0.001f});
        if (!command) {
            messages_.warn(errorText(command.error()));
            return;
        }
        document_.perform(std::move(*command));
        messages_.say(QString("%L1 strands now").arg(document.groom().strandCount()));
    }

    QtDocument& document_;
    const Preferences& preferences_;
    Messages& messages_;
    Player& player_;
    Viewport& viewport_;
    ToolInfo info_{"replace",
                   QString("Replant"),
                   "place",
                   QString("Paint over the scalp to regrow hair with the settings of the Scalp panel"),
                   QKeySequence("N"),
                   60};
    float radius_ = 0.02f;
    float reach_ = 0.03f;
    bool painting_ = false;
    FaceSet region_;
    std::optional<BrushPlace> place_;
    OptionForm* form_ = nullptr;  ///< the panel owns it
};

}  // namespace

ToolMaker replaceTool() {
    return [](const ToolParts& parts) {
        return oneTool<ReplaceTool>(parts.document, parts.preferences, parts.messages, parts.player,
                                    parts.viewport);
    };
}

}  // namespace hairloom::editor
