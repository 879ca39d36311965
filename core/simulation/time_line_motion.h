// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A time line as the motion of a head, with what it keys beside that.

#include <memory>
#include <optional>

#include "core/animation/actor.h"
#include "core/groom/time_line.h"
#include "core/simulation/motion.h"

namespace hairloom {

/// Times are seconds behind the start of the line. Clips move the head, keys move it on top of them and may
/// turn and jump as they like. Spheres and body follow their bones. `actor` may be null where the line has no
/// clips. Errors: what problemsOf() finds; a clip that the character lacks, or one shorter than what plays of
/// it; a character whose mesh is not the groom's scalp.
Result<std::unique_ptr<HeadMotion>> makeTimeLineMotion(TimeLine line, std::shared_ptr<const Actor> actor,
                                                       const Groom& groom);

/// How frames become steps of the engine, which are at most a tenth of a second.
struct FramePace {
    float framesPerSecond = 60;
    std::uint64_t preRoll = 0;  ///< frames on the first pose

    std::uint32_t steps() const;  ///< of a frame
    float dt() const { return 1.0f / framesPerSecond / static_cast<float>(steps()); }
    /// Seconds behind the start, at the end of a step 1 … steps() of that frame. Frame 0 has only its end.
    float timeOf(float frame, std::uint32_t step) const;
};
/// Of the groom's time line.
FramePace paceOf(const TimeLine& line);

/// Gives hair the settings that a motion keys, whenever they change.
class KeyedSettings {
  public:
    /// `authored`: where nothing is keyed. The motion outlives it. `begin`: seconds of the motion.
    KeyedSettings(const HeadMotion& motion, const runtime::SimulationSettings& authored, float begin = 0)
        : motion_(motion), authored_(authored), given_(motion.settingsAt(begin, authored)) {}

    /// What hair begins with.
    const runtime::SimulationSettings& first() const { return given_ ? *given_ : authored_; }
    /// Before the step that ends at `time` seconds. Errors: those of the hair's setSettings().
    template <class Hair>
    Status give(Hair& hair, float time) {
        auto now = motion_.settingsAt(time, authored_);
        if (!now || now == given_) return {};
        given_ = *now;
        return hair.setSettings(*now);
    }

  private:
    const HeadMotion& motion_;
    runtime::SimulationSettings authored_;
    std::optional<runtime::SimulationSettings> given_;
};

}  // namespace hairloom
