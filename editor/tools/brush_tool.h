// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Any brush of core/editing in the hand of a person: picks where it goes down, spaces dabs along the drag,
// shows its ring, changes size and strength by keys.

#include "core/editing/brush_list.h"
#include "editor/fields/option_form.h"
#include "editor/tools/brush_hand.h"
#include "editor/tools/surface_pick.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {

class BrushTool : public Tool {
    Q_OBJECT

  public:
    /// `brush` is one of editing::brushNames().
    BrushTool(const ToolParts& parts, std::string_view brush, std::shared_ptr<BrushHand> hand);

    const ToolInfo& info() const override { return info_; }
    QString hint() const override;
    void activate() override;
    void hover(const Pointer& pointer) override;
    void press(const Pointer& pointer) override;
    void drag(const Pointer& pointer) override;
    void release(const Pointer& pointer) override;
    void leave() override;
    void cancel() override;
    bool key(int key, Qt::KeyboardModifiers modifiers) override;
    void draw(Marks& marks) const override;
    QWidget* makeOptions() override;

    const editing::BrushSettings& settings() const { return settings_; }
    // The options show what these do. What is out of its range becomes the nearest that is in it.
    void setRadius(float metres);
    void setStrength(float strength);
    /// `name` is one of the brush's own parameters.
    void setParameter(const std::string& name, float value);

  Q_SIGNALS:
    /// Other than by the options.
    void settingsChanged();

  private:
    enum class Resizing { None, Radius, Strength };

    bool begin(const Pointer& pointer);
    BrushPlace underPointer(const Pointer& pointer) const;
    bool putDown(const BrushPlace& place, double pressure);
    void resize(const QPointF& to_px);
    void changed();
    /// Where the size is the view's: the radius that it is there.
    void fitRadius(const BrushPlace& place);
    /// Metres before and behind its place that a brush at `place` reaches.
    float depthAt(const BrushPlace& place) const;
    void handChanged();
    OptionForm* makeBasicOptions();
    void addMask(OptionForm& form, const editing::BrushParameter& parameter);

    QtDocument& document_;
    const Preferences& preferences_;
    Messages& messages_;
    Player& player_;
    Viewport& viewport_;
    const editing::BrushInfo& brush_;
    ToolInfo info_;
    std::shared_ptr<BrushHand> hand_;
    editing::BrushSettings settings_;
    float radius_px_ = 0;  ///< where the size is the view's; 0: that of the radius
    std::string falloff_ = "smooth";
    std::optional<BrushPlace> place_;  ///< under the pointer
    std::optional<BrushPlace> last_;   ///< of the last dab; none outside a stroke
    Resizing resizing_ = Resizing::None;
    QPointF resizeFrom_px_;
    float resizeFrom_ = 0;
    QPointF pointer_px_;
};

}  // namespace hairloom::editor
